"""Whether a house survives being written as ProcTHOR JSON and read again."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import fields

from adhoc.houses.house import House, HouseObject, Opening, Room, Wall
from adhoc.houses.procthor import parse_house
from adhoc.houses.procthor_writing import house_document

TOLERANCE = 2e-5
"""Lengths and angles may differ by this, in metres and radians: documents keep five decimals."""

Part = Room | Wall | Opening | HouseObject


def read_back(house: House) -> House:
    """The house as whoever reads its document gets it. Raises HouseError and AssetError like `read_house`."""
    text = json.dumps(house_document(house))
    return parse_house(json.loads(text), house.source or house.id, house.id)


def differences(first: House, second: House) -> Iterator[tuple[str, str]]:
    """What differs between two houses: id of the part, and what about it. The order of parts may differ."""
    yield from _differences(first.rooms, second.rooms)
    yield from _differences(first.walls, second.walls)
    yield from _differences(first.openings, second.openings)
    yield from _differences(first.objects, second.objects)


def _differences(first: Sequence[Part], second: Sequence[Part]) -> Iterator[tuple[str, str]]:
    others = {part.id: part for part in second}
    for part in first:
        other = others.pop(part.id, None)
        if other is None:
            yield part.id, f"this {_kind(part)} is lost on the way through its document"
            continue
        for field in fields(part):
            mine, theirs = getattr(part, field.name), getattr(other, field.name)
            if not _alike(mine, theirs, turning=field.name == "yaw"):
                yield part.id, f"{field.name} is {mine!r}, and {theirs!r} after writing and reading"
    for part in others.values():
        yield part.id, f"this {_kind(part)} is only there after writing and reading"


def _alike(first: object, second: object, turning: bool = False) -> bool:
    if isinstance(first, (float, int)) and isinstance(second, (float, int)):
        gap = abs(first - second)
        return min(gap, abs(2 * math.pi - gap)) <= TOLERANCE if turning else gap <= TOLERANCE
    if isinstance(first, Opening) and isinstance(second, Opening):
        return all(_alike(getattr(first, field.name), getattr(second, field.name)) for field in fields(first))
    if isinstance(first, tuple) and isinstance(second, tuple):
        return len(first) == len(second) and all(map(_alike, first, second))
    return first == second


def _kind(part: Part) -> str:
    return "object" if isinstance(part, HouseObject) else type(part).__name__.lower()
