"""Who re-places what: the paper's rule for heuristic teams (appendix, Heuristic-Based Policy)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from adhoc.core.geometry import planar_distance
from adhoc.core.values import Capability, ObjectRecord


@dataclass(frozen=True)
class Worker:
    """A robot as the rule sees it. `unable` are objects that it has tried in vain."""

    name: str
    position: tuple[float, float]
    capability: Capability
    free: bool
    unable: frozenset[str] = frozenset()

    def can_take(self, record: ObjectRecord, by_hand: bool = True) -> bool:
        """Whether it is free and able to deal with the object: to pick it up, if that is done `by_hand`."""
        able = self.capability.can_manipulate and record.mass <= self.capability.payload
        return self.free and (able or not by_hand) and record.id not in self.unable


def assign(
    objects: Iterable[ObjectRecord], workers: Iterable[Worker], by_hand: bool = True
) -> Mapping[str, str]:
    """Worker name -> object id: every object to the closest free robot that can take it, one each.

    Pairs are taken in the order of their distance, names and ids breaking ties, so that robots with the same
    knowledge come to the same assignment without a leader. Objects that are left wait for a robot to finish.
    """
    workers = list(workers)
    pairs = sorted(
        (round(planar_distance(worker.position, record.position), 3), record.id, worker.name)
        for record in objects
        for worker in workers
        if worker.can_take(record, by_hand)
    )
    assigned: dict[str, str] = {}
    for _, object_id, name in pairs:
        if name not in assigned and object_id not in assigned.values():
            assigned[name] = object_id
    return assigned
