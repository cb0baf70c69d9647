"""How long robots take to decide, apart from what they ask a language model: every team, every policy.

Episodes of the shipped houses, one process, one core. A decision is all that a robot does in a step: it
perceives, listens, confers, plans, renders prompts and reads replies, acts, and answers others. The time of
the model is left out.

    python benchmarks/decisions.py [SCENARIOS]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
from hydra import compose, initialize_config_dir
from rich.console import Console
from rich.table import Table

from adhoc import Message, Observation, OfflineReasoner, Policy, Turn, placement_table, run_episode
from adhoc.cli.contestants import Components
from adhoc.cli.schema import register_schema
from adhoc.core.resources import data_dir
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper

TEAMS = ("heuristic", "learned", "llm", "explore_only", "nearest_first", "room_by_room")
POLICIES = ("random", "heuristic", "plastic", "naive", "cot", "gpl", "irot")
MEDIAN_MS, LATE_MS = 10.0, 50.0
"""What is asked of the median and of the 99th percentile."""


class Stopwatch(Wrapper):
    """A language model that notes how long it has been asked."""

    def __init__(self, inner: LanguageModel) -> None:
        super().__init__(inner)
        self.seconds = 0.0

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`."""
        started = time.perf_counter()
        try:
            return super().complete(request)
        finally:
            self.seconds += time.perf_counter() - started


class Timed(Policy):
    """A policy whose steps are timed. Its robots act one after the other."""

    def __init__(self, inner: Policy, model: Stopwatch, steps: list[float]) -> None:
        self._inner, self._model, self._steps = inner, model, steps
        self._spent = 0.0

    def reset(self, *arguments: object) -> None:  # type: ignore[override]
        """See `Policy`."""
        self._inner.reset(*arguments)  # type: ignore[arg-type]

    def confer(self, observation: Observation, inbox: Sequence[Message]) -> None:
        """See `Policy`."""
        with self._timed():
            self._inner.confer(observation, inbox)

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`."""
        with self._timed():
            turn = self._inner.act(observation, inbox)
        self._steps.append(self._spent)
        self._spent = 0.0
        return turn

    def respond(self, message: Message) -> Message | None:
        """See `Policy`. Counts for the next decision."""
        with self._timed():
            return self._inner.respond(message)

    @contextmanager
    def _timed(self) -> Iterator[None]:
        started, asked = time.perf_counter(), self._model.seconds
        yield
        self._spent += time.perf_counter() - started - (self._model.seconds - asked)


def main() -> None:
    """Run episodes and print one table."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 8
    table = Table(title=f"Decision time apart from model calls, {count} scenarios of `demo`")
    for column in ("who", "decisions", "median ms", "99% ms", "slowest ms", "in bounds"):
        table.add_column(column, justify="left" if column == "who" else "right")
    for team in TEAMS:
        steps, _ = measure([f"team={team}", "policy=none"], count)
        table.add_row(*row(f"team={team}", steps))
    for policy in POLICIES:
        _, steps = measure(["team=heuristic", f"policy={policy}"], count)
        table.add_row(*row(f"policy={policy}", steps))
    Console(width=100).print(table)


def measure(overrides: list[str], count: int) -> tuple[list[float], list[float]]:
    """Seconds of every decision of the teammates and of the newcomer, after one scenario to warm up."""
    register_schema()
    with initialize_config_dir(str(data_dir("configs")), version_base="1.3"):
        config = compose("run", ["benchmark=demo", *overrides])
    model = Stopwatch(OfflineReasoner(placement_table()))
    made = Components(config, model)
    team: list[float] = []
    newcomer: list[float] = []
    conditions, ad_hoc = made.conditions, made.newcomer
    scenarios = made.benchmark.scenarios(made.world, 0, count)
    for number, scenario in enumerate([scenarios[0], *scenarios]):
        if number == 1:
            team.clear()
            newcomer.clear()
        run_episode(
            made.world,
            scenario,
            conditions.task,
            [Timed(conditions.team.make(seat), model, team) for seat in range(len(scenario.team))],
            None if ad_hoc is None else Timed(ad_hoc.make(len(scenario.team)), model, newcomer),
        )
    made.world.close()
    return team, newcomer


def row(who: str, seconds: Sequence[float]) -> list[str]:
    """One line of the table."""
    milliseconds = 1000.0 * np.asarray(seconds)
    median, late = np.quantile(milliseconds, [0.5, 0.99])
    fits = "yes" if median < MEDIAN_MS and late < LATE_MS else "NO"
    return [who, str(len(seconds)), f"{median:.2f}", f"{late:.1f}", f"{milliseconds.max():.1f}", fits]


if __name__ == "__main__":
    main()
