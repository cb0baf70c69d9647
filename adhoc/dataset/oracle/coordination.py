"""Routes for all robots at once: those with errands go round each other, the others step aside."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.oracle.lattice import Lattice
from adhoc.dataset.oracle.legs import Leg
from adhoc.dataset.oracle.routes import (
    Reservations,
    battery_of,
    route_aside,
    route_to_deed,
    stances_along,
)
from adhoc.dataset.oracle.stances import AIMS, Deed

MOST_DELAY = 60
"""Steps that a robot lets others delay one leg."""
MOST_NODES = 250_000
"""Size of the search for one leg."""
MOST_ATTEMPTS = 8
"""Orders of precedence that are tried until one works."""
MOST_IMPROVEMENTS = 4
"""Attempts altogether to find a faster one, once one has worked."""
_HEAD_STARTS = (0, 0, 0, 6, 0, 12, 0, 24)
"""Steps that those without errands get to clear the way, one for each attempt."""
_STANDING = 2
"""For so many steps robots keep clear of those that have not been given a route yet."""


@dataclass(frozen=True)
class Mover:
    """A robot as far as routes are concerned; without legs it has nothing to do but to step aside."""

    name: str
    stance: int
    steps_left: int
    can_move: bool
    legs: tuple[Leg, ...] = ()


@dataclass
class Route:
    """What one robot does, step by step: its deeds, and where it stands before each and after the last."""

    stances: list[int]
    deeds: list[int] = field(default_factory=list)

    @property
    def acts(self) -> list[tuple[int, int]]:
        """The step and the stance of each act, in order."""
        return [(step, self.stances[step]) for step, deed in enumerate(self.deeds) if deed == Deed.ACT]

    def extend(self, deeds: Sequence[int], stances: Sequence[int]) -> None:
        """Append deeds and the stances after them."""
        self.deeds.extend(deeds)
        self.stances.extend(stances)

    def cells(self) -> NDArray[np.int64]:
        """Where the robot is at every time."""
        return np.array(self.stances, np.int64) // AIMS


@dataclass(frozen=True)
class Conflict:
    """No attempt succeeded; `name` is the robot that found no way in the last one."""

    name: str


def coordinate(lattice: Lattice, movers: Sequence[Mover], limit: int) -> dict[str, Route] | Conflict:
    """Routes of all robots, of equal length, on which no two meet; or who was left without one.

    Prioritised planning: the robot with the longest tour first; one that finds no way, or is done last, goes
    first in the next attempt; one that cannot get out of the way keeps its place in the next. Robots without
    errands, and those that are done, are planned last and move only where they must. What one robot picks
    up is in the way of the others until it does.

    Args:
        lattice: the cells.
        movers: all robots.
        limit: the steps within which everything has to be done.
    """
    first: list[str] = []
    parked: list[str] = []
    best: dict[str, Route] | None = None
    failed = ""
    tried: set[tuple[str, ...]] = set()
    least = max((_cost(mover) for mover in movers if mover.legs), default=0)
    for number, head_start in enumerate(_HEAD_STARTS[:MOST_ATTEMPTS]):
        if best is not None and number >= MOST_IMPROVEMENTS:
            break
        attempt = _Attempt(lattice, movers, limit, min(head_start, limit))
        failed = attempt.run(first, parked)
        if not failed:
            if best is None or _length(attempt.routes) < _length(best):
                best = attempt.routes
            if _length(best) <= least:
                break
            late = attempt.last
            if (late, *parked) in tried:
                break
            tried.add((late, *parked))
            first = [late, *(name for name in first if name != late)]
        elif failed not in first:
            first.insert(0, failed)
        elif failed not in parked:
            parked.append(failed)
        else:
            first.remove(failed)
            first.insert(0, failed)
    return Conflict(failed) if best is None else best


def _cost(mover: Mover) -> int:
    cell, aim = divmod(mover.stance, AIMS)
    return int(mover.legs[0].value[cell, aim])


def _length(routes: dict[str, Route]) -> int:
    return max((len(route.deeds) for route in routes.values()), default=0)


class _Attempt:
    """One order of precedence."""

    def __init__(self, lattice: Lattice, movers: Sequence[Mover], limit: int, head_start: int) -> None:
        self._lattice = lattice
        self._movers = {mover.name: mover for mover in movers}
        self._limit = limit
        self._head_start = head_start
        self.routes = {mover.name: Route([mover.stance]) for mover in movers}
        self.last = ""
        self._reserved = Reservations(lattice.near, limit)
        self._standing: set[str] = set()
        self._gone_at = {
            leg.object_id: (mover.name, limit + 1)
            for mover in movers
            for leg in mover.legs
            if leg.picks_up and leg.object_id in lattice.obstacles
        }
        """For every obstacle that is to be picked up: by whom, and when, as far as that is settled."""

    def run(self, first: Sequence[str], parked: Sequence[str]) -> str:
        """Plan for everybody; returns the name of the robot that found no way, or nothing."""
        stay = [name for name, mover in self._movers.items() if not mover.can_move or name in parked]
        busy = [name for name, mover in self._movers.items() if mover.legs]
        for name in self._movers:
            if name in stay and name not in busy:
                self._wait(name, self._limit)
                self._reserve(name)
            else:
                self._stand(name)
        rank = {name: place for place, name in enumerate(first)}
        busy.sort(key=lambda name: (rank.get(name, len(rank)), -_cost(self._movers[name])))
        end = 0
        for name in busy:
            self._leave(name)
            with self._obstacles_of_others(name):
                if not self._work(name):
                    return name
            if len(self.routes[name].deeds) > end:
                end, self.last = len(self.routes[name].deeds), name
            if name in parked:
                self._wait(name, self._limit)
            self._reserve(name)
        idle = [name for name in self._movers if name not in stay or (name in busy and name not in parked)]
        for name in sorted(idle, key=lambda name: (rank.get(name, len(rank)), name not in busy)):
            with self._obstacles_of_others(""):
                if not self._step_aside(name, end):
                    return name
        for name, route in self.routes.items():
            self._wait(name, end)
            del route.deeds[end:], route.stances[end + 1 :]
        return ""

    @contextmanager
    def _obstacles_of_others(self, name: str) -> Iterator[None]:
        """For a while, what others pick up is in the way until they do."""
        taken = self._reserved.taken
        theirs = [
            (self._lattice.covered_by(obstacle), gone)
            for obstacle, (owner, gone) in self._gone_at.items()
            if owner != name
        ]
        for cells, gone in theirs:
            taken[: gone + 1, cells] += 1
        try:
            yield
        finally:
            for cells, gone in theirs:
                taken[: gone + 1, cells] -= 1

    def _work(self, name: str) -> bool:
        mover, route = self._movers[name], self.routes[name]
        if self._head_start and not self._hold_back(route):
            return False
        for leg in mover.legs:
            deeds = route_to_deed(
                route.stances[-1],
                len(route.deeds),
                self._limit,
                leg.value,
                leg.rest,
                leg.moves,
                self._reserved.taken,
                MOST_DELAY,
                MOST_NODES,
            )
            if deeds is None:
                return False
            route.extend(deeds, stances_along(route.stances[-1], deeds, leg.moves)[1:])
            if leg.looks_at is not None:
                self._keep_in_sight(route, leg.looks_at)
            if leg.picks_up and leg.object_id in self._gone_at:
                self._gone_at[leg.object_id] = (name, len(route.deeds))
        return battery_of(route.deeds) <= mover.steps_left

    def _keep_in_sight(self, route: Route, point: tuple[float, float]) -> None:
        """While a robot picks an object up, nobody stands between them."""
        time = len(route.deeds) - 1
        hiding = self._lattice.between(route.stances[-1] // AIMS, point)
        self._reserved.taken[time : time + 2, hiding] += 1

    def _hold_back(self, route: Route) -> bool:
        """Wait while those without errands get a head start."""
        cell = route.stances[0] // AIMS
        if self._reserved.taken[: self._head_start + 1, cell].any():
            return True
        route.extend([Deed.WAIT] * self._head_start, [route.stances[0]] * self._head_start)
        return True

    def _step_aside(self, name: str, end: int) -> bool:
        mover, route = self._movers[name], self.routes[name]
        if mover.legs:
            self._reserved.add(route.cells(), 0, -1)
        else:
            self._leave(name)
        start = len(route.deeds)
        if start < end:
            lying = self._lattice.moves(self._lattice.obstacles - self._gone_at.keys())
            left = mover.steps_left - battery_of(route.deeds)
            most = left if mover.can_move else 0
            cells = route_aside(route.stances[-1] // AIMS, start, end, lying, self._reserved.taken, most)
            if cells is None:
                return False
            self._follow(route, cells, lying)
        self._reserve(name)
        return True

    def _follow(self, route: Route, cells: NDArray[np.int64], moves: NDArray[np.int32]) -> None:
        aim = route.stances[-1] % AIMS
        for here, there in zip(cells[:-1].tolist(), cells[1:].tolist()):
            deed = Deed.WAIT if here == there else Deed(int(np.flatnonzero(moves[here] == there)[0]))
            route.extend([deed], [there * AIMS + aim])

    def _wait(self, name: str, end: int) -> None:
        route = self.routes[name]
        missing = end - len(route.deeds)
        route.extend([Deed.WAIT] * missing, [route.stances[-1]] * missing)

    def _reserve(self, name: str) -> None:
        self._reserved.add(self.routes[name].cells(), 0)

    def _stand(self, name: str) -> None:
        self._standing.add(name)
        self._reserved.add(self._start_cells(name), 0)

    def _leave(self, name: str) -> None:
        if name in self._standing:
            self._standing.discard(name)
            self._reserved.add(self._start_cells(name), 0, -1)

    def _start_cells(self, name: str) -> NDArray[np.int64]:
        cell = self._movers[name].stance // AIMS
        return np.full(_STANDING, cell, np.int64)
