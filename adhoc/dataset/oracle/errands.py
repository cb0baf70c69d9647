"""Who carries what, in which order: the fastest division of the objects among the robots.

Robots are taken to pass through each other here; `coordination` makes them give way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.oracle.fields import FAR, cell_field

Ints = NDArray[np.int32]
Mask = NDArray[np.bool_]

_DIGIT = 8
"""Orders of errands are written in digits of this base."""


@dataclass(frozen=True)
class Carrier:
    """A robot as far as the division of errands is concerned."""

    name: str
    cell: int
    height: float
    steps_left: int
    """What its battery pays for."""
    carries: frozenset[str]
    """The objects that it may carry."""
    holds: str | None = None


@dataclass(frozen=True)
class Division:
    """`orders` names for each robot the objects that it carries, in order; `steps` is when the last robot is
    done; `left` are the objects that nobody can take."""

    orders: dict[str, tuple[str, ...]]
    steps: int
    left: frozenset[str]


Moves = Callable[[Iterable[str]], Ints]
"""Where moves lead, (cells, 4), while some objects lie where they were (`Lattice.moves`)."""

Places = Callable[[str, float], Mask]
"""The cells from which an object can be picked up, or put into a right place, at a camera height."""


def tours(
    moves: Moves, objects: Sequence[str], carrier: Carrier, picks: Places, puts: Places
) -> dict[frozenset[str], tuple[int, tuple[str, ...]]]:
    """The fewest steps in which a robot brings each set of objects home, and the order, without turning.

    A dynamic programme over sets: the cost field after a set is the least over its last object. What a robot
    has picked up is no longer in its way; what others pick up still is.
    """
    held = carrier.holds
    mine = [name for name in objects if name in carrier.carries and name != held]
    start: Ints = np.full(len(moves(())), FAR, np.int32)
    start[carrier.cell] = 0
    fields: dict[frozenset[str], tuple[Ints, Ints]] = {}
    first: frozenset[str] = frozenset()
    labels: Ints = np.zeros(len(start), np.int32)
    if held is not None:
        first = frozenset({held})
        lying = [name for name in objects if name != held]
        start, labels = _deliver(moves, lying, (start, labels), puts(held, carrier.height))
    fields[first] = (start, labels)
    found: dict[frozenset[str], tuple[int, tuple[str, ...]]] = {frozenset(): (0, ())}
    for size in range(len(mine)):
        for done in [key for key in fields if len(key) == size + len(first)]:
            for last, name in enumerate(mine):
                if name in done:
                    continue
                key = done | {name}
                lying = [other for other in objects if other not in done]
                field = _fetch(moves, lying, name, fields[done], carrier.height, picks, puts)
                costs, orders = field[0], field[1] * _DIGIT + last + 1
                if key in fields:
                    best, best_orders = fields[key]
                    better = costs < best
                    costs = np.where(better, costs, best)
                    orders = np.where(better, orders, best_orders)
                fields[key] = (costs, orders)
    for key, field in fields.items():
        _note(found, key, field, mine, held)
    return found


def divide(
    objects: Sequence[str],
    carriers: Sequence[Carrier],
    costs: dict[str, dict[frozenset[str], int]],
    limit: int,
) -> Division:
    """The division that leaves the fewest objects and then ends first, and then costs the fewest steps.

    `costs` has the steps of each robot for each set of objects that it can bring home; what exceeds its
    battery or `limit` is left out. What a robot holds, only that robot can bring home.
    """
    best: dict[frozenset[str], tuple[int, int, tuple[tuple[str, frozenset[str]], ...]]] = {
        frozenset(): (0, 0, ())
    }
    for carrier in carriers:
        most = min(limit, carrier.steps_left)
        merged = dict(best)
        for share, steps in costs[carrier.name].items():
            if not share or steps > most:
                continue
            for done, (end, total, shares) in best.items():
                if share & done:
                    continue
                option = (max(end, steps), total + steps, (*shares, (carrier.name, share)))
                key = share | done
                if key not in merged or option[:2] < merged[key][:2]:
                    merged[key] = option
        best = merged
    done = min(best, key=lambda key: (-len(key), best[key][:2], sorted(key)))
    return Division(
        {name: tuple(sorted(share)) for name, share in best[done][2]},
        best[done][0],
        frozenset(objects) - done,
    )


def _fetch(
    moves: Moves,
    lying: Sequence[str],
    name: str,
    field: tuple[Ints, Ints],
    height: float,
    picks: Places,
    puts: Places,
) -> tuple[Ints, Ints]:
    """The field after going for an object, picking it up, and putting it into a right place."""
    costs, labels = cell_field(moves(lying), *field)
    costs = np.where(picks(name, height) & (costs < FAR), costs + 1, FAR).astype(np.int32)
    rest = [other for other in lying if other != name]
    return _deliver(moves, rest, (costs, labels), puts(name, height))


def _deliver(moves: Moves, lying: Sequence[str], field: tuple[Ints, Ints], puts: Mask) -> tuple[Ints, Ints]:
    costs, labels = cell_field(moves(lying), *field)
    return np.where(puts & (costs < FAR), costs + 1, FAR).astype(np.int32), labels


def _note(
    found: dict[frozenset[str], tuple[int, tuple[str, ...]]],
    key: frozenset[str],
    field: tuple[Ints, Ints],
    mine: Sequence[str],
    held: str | None,
) -> None:
    cell = int(field[0].argmin())
    if field[0][cell] >= FAR:
        return
    code, order = int(field[1][cell]), []
    while code:
        code, digit = divmod(code, _DIGIT)
        order.append(mine[digit - 1])
    found[key] = (int(field[0][cell]), (() if held is None else (held,)) + tuple(reversed(order)))
