"""`adhoc house FILE [INDEX]`: what is in a house file."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from adhoc.evaluation.floor_drawing import draw_floor_plan
from adhoc.evaluation.scenario import difficulty_of
from adhoc.houses.house import House
from adhoc.houses.procthor import read_house


def main(arguments: Sequence[str]) -> int:
    """Describe one house of a ProcTHOR file. Raises HouseError if it cannot be read."""
    parser = argparse.ArgumentParser(prog="adhoc house", description="Describe a house of a ProcTHOR file.")
    parser.add_argument("file", type=Path, help="a .json, .json.gz or .jsonl.gz file")
    parser.add_argument("index", type=int, nargs="?", default=0, help="which house of the file (0)")
    parser.add_argument("--picture", metavar="PNG", type=Path, help="draw the floor plan")
    options = parser.parse_args(list(arguments))
    house = read_house(options.file, options.index)
    _describe(house, Console())
    if options.picture is not None:
        draw_floor_plan(house, options.picture)
    return 0


def _describe(house: House, console: Console) -> None:
    pickupable = sum(thing.pickupable for thing in house.objects)
    console.print(
        f"{house.id}: {len(house.rooms)} rooms ({difficulty_of(len(house.rooms)).value}), "
        f"{len(house.objects)} objects, {pickupable} of them can be picked up"
    )
    table = Table("room", "type", "receptacles", "things that can be picked up")
    for room in house.rooms:
        inside = [thing for thing in house.objects if thing.room == room.id]
        table.add_row(
            room.id,
            room.room_type,
            _count(thing.category for thing in inside if thing.is_receptacle and not thing.pickupable),
            _count(thing.category for thing in inside if thing.pickupable),
        )
    console.print(table)


def _count(categories: object) -> str:
    counted = Counter(categories)  # type: ignore[call-overload]
    return ", ".join(name if count == 1 else f"{name} x{count}" for name, count in sorted(counted.items()))
