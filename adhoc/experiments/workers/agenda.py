"""Which units of a plan are still to be run, and by whom; no processes here."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence

from adhoc.core.errors import WorkerError
from adhoc.experiments.plan import Unit

BEFORE_THE_FIRST_EPISODE = "(before the first episode)"


class Agenda:
    """Hands out units in order. What a worker had when it died is handed out again, first of all.

    Args:
        units: All there are.
        deaths: So many workers that die in one episode are too many.
    """

    def __init__(self, units: Sequence[Unit], deaths: int) -> None:
        self._most_deaths = deaths
        self._deaths: Counter[str] = Counter()
        self._open = deque(units)
        self._held: dict[int, Unit] = {}
        self._episodes: dict[int, str] = {}
        self._dismissed: set[int] = set()
        self._given_up: dict[str, str] = {}

    @property
    def open_units(self) -> int:
        """How many units nobody does yet."""
        return len(self._open)

    @property
    def is_finished(self) -> bool:
        """Whether everything is done."""
        return not self._open and not self._held

    def next(self, worker: int) -> Unit | None:
        """The next unit, for a worker that is done with the one before; None if there is none."""
        self._held.pop(worker, None)
        self._episodes.pop(worker, None)
        if not self._open:
            self._dismissed.add(worker)
            return None
        self._held[worker] = self._open.popleft()
        return self._held[worker]

    def is_dismissed(self, worker: int) -> bool:
        """Whether the worker was told that there is nothing left to do."""
        return worker in self._dismissed

    def note_episode(self, worker: int, episode: str) -> None:
        """The worker began this episode of its unit."""
        self._episodes[worker] = episode
        del self._deaths[BEFORE_THE_FIRST_EPISODE]

    def has_begun(self, worker: int) -> bool:
        """Whether the worker is in an episode."""
        return worker in self._episodes

    def episode(self, worker: int) -> str:
        """The episode that the worker began last, for error texts."""
        return self._episodes.get(worker, BEFORE_THE_FIRST_EPISODE)

    def lose(self, worker: int, how: str) -> None:
        """The worker was killed. An episode in which too many were is given up (see `given_up`).

        Args:
            worker: Which.
            how: What is known about its death, for error texts.

        Raises:
            WorkerError: Too many were killed one after the other before they had begun any episode.
        """
        if self.is_dismissed(worker):
            return
        episode = self.episode(worker)
        unit = self._held.pop(worker, None)
        self._episodes.pop(worker, None)
        if unit is not None:
            self._open.appendleft(unit)
        self._deaths[episode] += 1
        if self._deaths[episode] < self._most_deaths:
            return
        why = f"{self._deaths[episode]} worker processes died in it (last: {how})"
        if episode == BEFORE_THE_FIRST_EPISODE:
            raise WorkerError(
                f"episode {episode!r}: {why}; if memory is short, use fewer workers; the same command goes "
                "on where it stopped"
            )
        self._given_up[episode] = why

    def given_up(self, episode: str) -> str | None:
        """Why an episode is not begun again; None if it may be."""
        return self._given_up.get(episode)
