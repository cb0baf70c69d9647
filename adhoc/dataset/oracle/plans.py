"""One plan for the whole team: the division of the errands, and the routes to carry it out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from adhoc.dataset.oracle.coordination import Conflict, Mover, Route, coordinate
from adhoc.dataset.oracle.errands import Carrier, Division, divide, tours
from adhoc.dataset.oracle.legs import Leg, Legs
from adhoc.dataset.oracle.situation import Situation
from adhoc.dataset.oracle.stances import AIMS
from adhoc.dataset.oracle.views import Mask
from adhoc.houses.house import FLOOR

MOST_DIVISIONS = 60
"""How often the division is refined by exact costs, or changed since robots were in each other's way."""
MOST_CONFLICTS = 4
"""How many divisions are given up because the robots were in each other's way."""

Tours = dict[frozenset[str], tuple[int, tuple[str, ...]]]


@dataclass(frozen=True)
class Worker:
    """One robot in a situation: where it is, and what it can still do."""

    name: str
    stance: int
    height: float
    steps_left: int
    can_move: bool
    carries: frozenset[str]
    holds: str | None = None


@dataclass(frozen=True)
class Plan:
    """What each robot does: its route, and the legs whose acts the route has, in order."""

    routes: Mapping[str, Route]
    legs: Mapping[str, tuple[Leg, ...]]
    left: frozenset[str]
    """The objects that stay where they are under this plan."""
    least: int
    """The steps that the slowest robot would take if nobody was in its way."""

    @property
    def steps(self) -> int:
        """The steps that the plan takes."""
        return max(len(route.deeds) for route in self.routes.values())


@dataclass(frozen=True)
class NoPlan:
    """Why there is no plan."""

    reason: str


class Planner:
    """Plans in one situation. What it computes for one team is kept for the next."""

    def __init__(self, situation: Situation) -> None:
        self._situation = situation
        self._legs = Legs(situation)
        self._tours: dict[tuple[Worker, bool], Tours] = {}

    @property
    def situation(self) -> Situation:
        """The situation that is planned in."""
        return self._situation

    def plan(self, workers: Sequence[Worker], limit: int) -> Plan | NoPlan:
        """The fastest plan that was found within `limit` steps; it may leave objects that nobody can reach
        yet, but not all.

        First everybody counts on the others to pick up in time what lies in the way. Where that does not
        work, or not without delay, everybody plans around it.
        """
        hopeful = self._search(workers, limit, careful=False)
        if isinstance(hopeful, Plan) and not hopeful.left and hopeful.steps <= hopeful.least:
            return hopeful
        careful = self._search(workers, limit, careful=True)
        if isinstance(careful, NoPlan):
            return hopeful
        if isinstance(hopeful, NoPlan) or (len(careful.left), careful.steps) < (
            len(hopeful.left),
            hopeful.steps,
        ):
            return careful
        return hopeful

    def _search(self, workers: Sequence[Worker], limit: int, careful: bool) -> Plan | NoPlan:
        able = [worker for worker in workers if worker.can_move and worker.carries]
        known = {worker.name: self._tours_of(worker, careful) for worker in able}
        banned: set[tuple[str, frozenset[str]]] = set()
        exact: dict[tuple[str, frozenset[str]], int] = {}
        version = self._situation.version
        conflicts = 0
        for _ in range(MOST_DIVISIONS):
            if version != self._situation.version:
                version = self._situation.version
                exact.clear()
            division = self._divide(able, known, exact, banned, limit)
            if not division.orders:
                return NoPlan(
                    "the robots are in each other's way" if conflicts else self._obstacle(able, known)
                )
            if self._refine(division, able, known, exact, careful):
                continue
            legs = self._legs_of(division, workers, known, careful)
            movers = [_mover(worker, legs.get(worker.name, ())) for worker in workers]
            routes = coordinate(self._situation.lattice, movers, limit)
            if isinstance(routes, Conflict):
                conflicts += 1
                if conflicts == MOST_CONFLICTS:
                    return NoPlan("the robots are in each other's way")
                banned |= _blamed(routes, division)
                continue
            if self._shows_all(routes, legs, workers):
                return Plan(routes, legs, division.left, division.steps)
        return NoPlan("no plan after many attempts")

    def _tours_of(self, worker: Worker, careful: bool) -> Tours:
        situation, lattice = self._situation, self._situation.lattice
        key = (worker, careful)
        if key not in self._tours:
            self._tours[key] = tours(
                lattice.moves if careful else lambda _: lattice.moves(()),
                situation.objects,
                _carrier(worker),
                lambda name, height: _cells(situation.picks(name, height)),
                lambda name, height: _cells(situation.puts(name, height)),
            )
        return self._tours[key]

    def _legs_for(
        self, worker: Worker, order: Sequence[str], careful: bool, left: frozenset[str]
    ) -> tuple[Leg, ...]:
        everything = frozenset(self._situation.lying)
        lying = everything if careful else everything & (left | set(order))
        return self._legs.of(order, worker.height, worker.holds, lying)

    def _divide(
        self,
        able: Sequence[Worker],
        known: Mapping[str, Tours],
        exact: Mapping[tuple[str, frozenset[str]], int],
        banned: set[tuple[str, frozenset[str]]],
        limit: int,
    ) -> Division:
        costs = {
            worker.name: {
                share: exact.get((worker.name, share), steps)
                for share, (steps, _) in known[worker.name].items()
                if (worker.name, share) not in banned
            }
            for worker in able
        }
        carriers = [_carrier(worker) for worker in able]
        return divide(self._situation.objects, carriers, costs, limit)

    def _refine(
        self,
        division: Division,
        able: Sequence[Worker],
        known: Mapping[str, Tours],
        exact: dict[tuple[str, frozenset[str]], int],
        careful: bool,
    ) -> bool:
        """Find the true costs of a division; whether one was not known before."""
        news = False
        for worker in able:
            share = frozenset(division.orders.get(worker.name, ()))
            if share and (worker.name, share) not in exact:
                legs = self._legs_for(worker, known[worker.name][share][1], careful, division.left)
                exact[worker.name, share] = int(legs[0].value[divmod(worker.stance, AIMS)])
                news = True
        return news

    def _legs_of(
        self, division: Division, workers: Sequence[Worker], known: Mapping[str, Tours], careful: bool
    ) -> dict[str, tuple[Leg, ...]]:
        legs = {}
        for worker in workers:
            if worker.name in division.orders:
                order = known[worker.name][frozenset(division.orders[worker.name])][1]
                legs[worker.name] = self._legs_for(worker, order, careful, division.left)
        return legs

    def _shows_all(
        self, routes: Mapping[str, Route], legs: Mapping[str, tuple[Leg, ...]], workers: Sequence[Worker]
    ) -> bool:
        """Whether all pictures show what the acts need, and nothing is dropped where it does harm; if not,
        those stances are struck out."""
        situation, fine = self._situation, True
        for worker in workers:
            for leg, (_, stance) in zip(legs.get(worker.name, ()), routes[worker.name].acts):
                target = leg.object_id
                if not leg.picks_up:
                    target = situation.target_at(leg.object_id, worker.height, stance)
                if target == FLOOR:
                    fine = situation.is_droppable(leg.object_id, stance) and fine
                else:
                    fine = situation.is_seen(target, worker.height, stance) and fine
        return fine

    def _obstacle(self, able: Sequence[Worker], known: Mapping[str, Tours]) -> str:
        """Why nothing can be done, as far as a single robot can tell."""
        situation = self._situation
        for name in situation.objects:
            carriers = [worker for worker in able if name in worker.carries]
            if not carriers:
                return f"no robot with steps left can carry {name}"
            if not any(
                worker.holds == name or situation.picks(name, worker.height).any() for worker in carriers
            ):
                return f"{name} can be seen and reached from nowhere"
            if not any(situation.puts(name, worker.height).any() for worker in carriers):
                return f"no right place with room for {name} can be seen and reached"
            if not any(name in share for worker in carriers for share in known[worker.name]):
                return f"no robot gets to {name} and from there to a right place"
        return "the batteries, or the steps, do not last"


def _blamed(conflict: Conflict, division: Division) -> set[tuple[str, frozenset[str]]]:
    """What to do without next: the share of the robot in trouble, or, if it has none, the largest share."""
    name = conflict.name
    if name not in division.orders:
        name = max(division.orders, key=lambda other: len(division.orders[other]))
    return {(name, frozenset(division.orders[name]))}


def _mover(worker: Worker, legs: tuple[Leg, ...]) -> Mover:
    can_move = worker.can_move and worker.steps_left > 0
    return Mover(worker.name, worker.stance, worker.steps_left, can_move, legs)


def _carrier(worker: Worker) -> Carrier:
    return Carrier(
        worker.name, worker.stance // AIMS, worker.height, worker.steps_left, worker.carries, worker.holds
    )


def _cells(mask: Mask) -> Mask:
    return np.asarray(mask.any(axis=1))
