"""How far a run is: episodes a second, time left, money spent, and success so far."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable

from adhoc.evaluation.records import Record
from adhoc.experiments.plan import Plan


class Tally:
    """Counts what is finished of a plan.

    Args:
        plan: What is to be done.
        clock: Seconds, from any beginning.
    """

    def __init__(self, plan: Plan, clock: Callable[[], float] = time.monotonic) -> None:
        self._plan, self._clock = plan, clock
        self._begun = clock()
        self.run = self.failed = 0
        self.spent = 0.0
        """US dollars, by what this run's episodes asked."""
        self._episodes: Counter[str] = Counter()
        self._successes: Counter[str] = Counter()

    @property
    def done(self) -> int:
        """Episodes that need no more work, also those recorded before."""
        return self._plan.done + self.run + self.failed

    @property
    def total(self) -> int:
        """All episodes of the plan."""
        return self._plan.done + self._plan.to_run

    def add(self, record: Record) -> None:
        """An episode was finished."""
        self.run += 1
        self.spent += float(record["llm"].get("cost_usd", 0.0))
        self._episodes[record["policy_label"]] += 1
        self._successes[record["policy_label"]] += bool(record["success"])

    def add_failed(self) -> None:
        """An episode failed."""
        self.failed += 1

    def is_at_part(self, parts: int) -> bool:
        """Whether one of so many equal parts of this run has just ended, but not the last; a part has so many
        episodes at least."""
        ended = self.run + self.failed
        size = max(parts, -(-self._plan.to_run // parts))
        return self.run > 0 and ended % size == 0 and ended < self._plan.to_run

    @property
    def rate(self) -> float | None:
        """Episodes a second; None before the first."""
        ended, elapsed = self.run + self.failed, self._clock() - self._begun
        return ended / elapsed if ended and elapsed > 0 else None

    @property
    def seconds_left(self) -> float | None:
        """If it goes on like this; None before the first episode."""
        return None if self.rate is None else (self.total - self.done) / self.rate

    def success(self) -> list[str]:
        """Of each policy, by its label: success so far, and of how many episodes of this run."""
        return [
            f"{label} {100 * self._successes[label] / count:.0f}% of {count}"
            for label, count in self._episodes.items()
        ]

    def __str__(self) -> str:
        parts = [f"{self.done}/{self.total}"]
        if self.rate is not None and self.seconds_left is not None:
            parts += [f"{self.rate:.2g} episodes/s", f"{clock_time(self.seconds_left)} left"]
        if self.spent:
            parts.append(f"${self.spent:.2f}")
        if self.failed:
            parts.append(f"{self.failed} failed")
        return ", ".join(parts)


def clock_time(seconds: float) -> str:
    """Hours, minutes and seconds, as in `1:02:03` or `2:03`."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
