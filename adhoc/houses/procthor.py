"""Reading houses: ProcTHOR house JSON of both vintages, as values in our own frame.

ProcTHOR's Unity frame is left-handed with y up and yaw clockwise; ours (`core.geometry`) is right-handed
with z up: (x, y, z) there is (x, z, y) here, and yaw changes its sign.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from adhoc.core.errors import HouseError
from adhoc.houses.house import House
from adhoc.houses.house_files import decode, documents
from adhoc.houses.json_fields import Fields
from adhoc.houses.procthor_objects import parse_objects
from adhoc.houses.procthor_openings import assemble_walls, parse_openings
from adhoc.houses.procthor_rooms import check_enclosed, parse_rooms, parse_wall_sides
from adhoc.houses.wall_merging import merge_walls


def read_houses(path: str | Path) -> Iterator[House]:
    """The houses of a `.json`, `.jsonl`, `.json.gz` or `.jsonl.gz` file, read lazily, one at a time.

    A house's id is the file's name without extension, for lines followed by `:` and its index from 0.
    Raises HouseError (broken, truncated or foreign file or house) or AssetError (unknown asset); both name
    the file, the line, the field and the value.
    """
    for document in documents(path):
        yield parse_house(decode(document), document.source, document.name)


def read_house(path: str | Path, index: int = 0) -> House:
    """The house number `index`, from 0, of a file; the houses before it are not parsed.

    Raises what `read_houses` raises, and HouseError if the file has no such house.
    """
    if index < 0:
        raise HouseError(f"{path}: the index of a house is {index}; it should be 0 or more")
    document = next(islice(documents(path), index, None), None)
    if document is None:
        raise HouseError(f"{path}: there is no house number {index} (counted from 0)")
    return parse_house(decode(document), document.source, document.name)


def parse_house(data: object, source: str, house_id: str | None = None) -> House:
    """The house of one decoded JSON document; `source` says in errors where it came from.

    `house_id` is `source` unless given. Raises HouseError and AssetError as `read_houses` does.
    """
    fields = Fields.of(data, source)
    rooms = parse_rooms(fields)
    sides = parse_wall_sides(fields, rooms)
    stretches = merge_walls(sides)
    check_enclosed(rooms, stretches, source)
    holes = parse_openings(fields, rooms, sides)
    walls, left_out = assemble_walls(stretches, holes, source)
    objects = parse_objects(fields, rooms)
    house = House(house_id or source, rooms, walls, (*holes, *left_out), objects, source)
    _check_unique(house)
    return house


def _check_unique(house: House) -> None:
    ids = [room.id for room in house.rooms] + [wall.id for wall in house.walls]
    ids += [opening.id for opening in house.openings] + [thing.id for thing in house.objects]
    counts = Counter(ids)
    twice = [name for name, count in counts.items() if count > 1]
    if twice:
        raise HouseError(f"{house.source}: id {twice[0]!r} is used {counts[twice[0]]} times; ids are unique")
