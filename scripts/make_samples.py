"""Make the sample houses of `adhoc.houses.samples` from the layouts that are declared here.

    python scripts/make_samples.py [--out adhoc/houses/samples]

Nothing is random: each layout names every room, door, piece of furniture and item. Items are placed on the
surfaces that `adhoc.houses.build` gives the furniture, a millimetre above them.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from adhoc.houses.build import object_solid
from adhoc.houses.facts import asset, category_facts
from adhoc.houses.house import FLOOR, Corner, House, HouseObject, Opening, Room
from adhoc.houses.procthor_writing import house_document, raise_walls, standard_hole

HEIGHT = 2.6
GAP = 0.025
"""Metres between furniture and the middle line of its wall, as in ProcTHOR."""
REST = 0.001
SILL = 0.9

YAW = {"south": 0.0, "north": math.pi, "west": -math.pi / 2, "east": math.pi / 2}
"""Yaw of furniture that stands against that side of a room, with its front to the room."""


@dataclass(frozen=True)
class Item:
    """An item on the surface number `board` of its furniture (from below; -1 is the highest), `x` metres to
    its +x side and `y` metres to its front, turned by `turn` quarter turns."""

    asset: str
    board: int = -1
    x: float = 0.0
    y: float = 0.0
    turn: int = 0


@dataclass(frozen=True)
class Furniture:
    """A piece against a side of its room, its middle `along` metres from the room's lower corner on that
    side; `off` metres further away from the wall."""

    asset: str
    side: str
    along: float
    items: tuple[Item, ...] = ()
    off: float = 0.0


@dataclass(frozen=True)
class Space:
    """A room: its type, its outline (or its lower and upper corner), and what stands and lies in it.

    `loose` are items on the floor: asset, x and y in the frame of the house.
    """

    room_type: str
    outline: tuple[Corner, ...]
    furniture: tuple[Furniture, ...] = ()
    loose: tuple[tuple[str, float, float], ...] = ()


@dataclass(frozen=True)
class Hole:
    """A door or a window whose middle is at that point of the plan, between two rooms (by position in the
    layout), or towards the outside if `second` is None."""

    middle: Corner
    first: int
    second: int | None = None
    kind: str = "door"


@dataclass(frozen=True)
class Layout:
    """A house. `open_plan` lists pairs of rooms without a wall between them."""

    spaces: tuple[Space, ...]
    holes: tuple[Hole, ...]
    open_plan: tuple[tuple[int, int], ...] = field(default=())


def kitchen(outline: tuple[Corner, ...], counter: Furniture, *furniture: Furniture) -> Space:
    """A kitchen with a laid counter."""
    laid = Furniture(
        counter.asset,
        counter.side,
        counter.along,
        (
            Item("Mug_1", x=-0.7, y=0.1),
            Item("Pan_10", x=-0.2, turn=1),
            Item("Tomato_1", x=0.3, y=0.05),
        ),
    )
    return Space("Kitchen", outline, (laid, *furniture))


FRIDGE_ITEMS = (
    Item("Apple_1", board=2, x=-0.2, y=0.1),
    Item("Lettuce_1", board=2, x=0.15, y=0.05),
    Item("Potato_1", board=3, x=0.1, y=0.1),
)

CORRIDOR = Layout(
    (
        Space(
            "LivingRoom",
            ((0, 0), (5, 0), (5, 5), (0, 5)),
            (
                Furniture(
                    "RoboTHOR_sofa_alrid",
                    "south",
                    1.6,
                    (Item("RoboTHOR_pillow_dvala_v", x=-0.25, y=0.08), Item("Remote_1", x=0.4, y=0.2)),
                ),
                Furniture(
                    "TV_Stand_206_1",
                    "north",
                    1.6,
                    (Item("Book_10", board=0, x=0.2, y=0.05), Item("Keychain_1", board=1, x=-0.2, y=0.1)),
                ),
                Furniture(
                    "Coffee_Table_202_1",
                    "south",
                    1.6,
                    (Item("Newspaper_1", x=-0.2), Item("Bowl_1", x=0.2)),
                    off=1.75,
                ),
                Furniture("bin_1", "east", 0.5, (Item("Candle_1"),)),
                Furniture("Shelving_Unit_001_1", "west", 2.6, (Item("Vase_Decorative_1", board=1),)),
                Furniture("Floor_Lamp_17", "south", 3.2),
            ),
        ),
        Space("Corridor", ((5, 1.6), (9, 1.6), (9, 3.4), (5, 3.4))),
        kitchen(
            ((9, 0), (14, 0), (14, 5), (9, 5)),
            Furniture("Countertop_I_6x2", "north", 1.5),
            Furniture("Fridge_12", "north", 3.4, FRIDGE_ITEMS),
            Furniture(
                "Dining_Table_203_1",
                "south",
                3.0,
                (Item("Plate_1", x=-0.4), Item("Bottle_1", x=0.1, y=0.1), Item("Cup_1", x=0.4)),
                off=0.9,
            ),
            Furniture("Chair_002_1", "south", 3.0, off=0.1),
            Furniture(
                "Shelving_Unit_219_1",
                "east",
                2.6,
                (Item("Book_10", board=2), Item("Pot_1", board=1, turn=1), Item("Spray_Bottle_1", board=3)),
            ),
            Furniture("bin_10", "west", 4.4),
        ),
    ),
    (
        Hole((5, 2.5), 0, 1),
        Hole((9, 2.5), 1, 2),
        Hole((3.8, 5), 0),
        Hole((2.5, 0), 0, kind="window"),
        Hole((11.5, 0), 2, kind="window"),
    ),
)

ONE_ROOM = Layout(
    (
        Space(
            "LivingRoom",
            ((0, 0), (6, 0), (6, 5), (0, 5)),
            (
                Furniture(
                    "RoboTHOR_sofa_ektorp_v",
                    "south",
                    1.8,
                    (
                        Item("RoboTHOR_pillow_dvala_v", x=-0.3, y=0.08),
                        Item("Remote_1", x=0.3, y=0.2),
                        Item("Newspaper_1", x=0.6, y=0.1, turn=1),
                    ),
                ),
                Furniture(
                    "Coffee_Table_202_1",
                    "south",
                    1.8,
                    (Item("Bowl_1", x=-0.25), Item("Book_10", x=0.2)),
                    off=1.75,
                ),
                Furniture(
                    "TV_Stand_206_1",
                    "north",
                    1.8,
                    (
                        Item("Keychain_1", board=0, x=-0.2, y=0.1),
                        Item("Cellphone_1", board=1, x=0.2, y=0.1),
                        Item("Television_16", board=-1),
                    ),
                ),
                Furniture(
                    "Desk_229_1",
                    "east",
                    1.3,
                    (
                        Item("Laptop_1", x=0.0, y=0.05),
                        Item("Pen_1", x=0.35),
                        Item("CreditCard_1", x=-0.4),
                    ),
                ),
                Furniture("Chair_002_1", "east", 2.3),
                Furniture(
                    "Shelving_Unit_001_1",
                    "west",
                    2.7,
                    (Item("Vase_Decorative_1", board=1), Item("Book_1", board=2)),
                ),
                Furniture(
                    "Dresser_205_1",
                    "north",
                    4.8,
                    (Item("Tissue_Box_1", x=-0.3), Item("Watch_1", x=0.2), Item("Candle_1", board=0)),
                ),
                Furniture("RoboTHOR_armchair_overallt", "west", 4.2, (Item("Cellphone_2", y=0.1),)),
                Furniture("Side_Table_201_3_1", "south", 3.2, (Item("Plate_10"),)),
                Furniture("Floor_Lamp_17", "south", 4.2),
                Furniture("bin_1", "east", 4.2, (Item("Candle_2"),)),
            ),
            (("Box_13", 5.6, 0.4),),
        ),
    ),
    (Hole((6, 3.2), 0), Hole((0, 1.2), 0, kind="window")),
)

BEDROOM_BED = (
    Item("RoboTHOR_pillow_dvala_v", x=-0.3, y=-0.6),
    Item("Teddy_Bear_1", x=0.2, y=0.4),
)
DESK_ITEMS = (Item("Laptop_1", y=0.05), Item("Pencil_1", x=0.35))
DRESSER_ITEMS = (Item("Alarm_Clock_1", x=-0.3), Item("Book_10", board=1, y=0.02))


def bathroom(outline: tuple[Corner, ...], *furniture: Furniture) -> Space:
    """A bathroom with what stands in it."""
    return Space("Bathroom", outline, furniture)


TOILET_ITEMS = (Item("Toilet_Paper", x=0.1),)
SINK_ITEMS = (Item("Soap_Bottle_1"),)
BATH_TABLE_ITEMS = (Item("Cloth_1", x=-0.12),)

FOUR_ROOMS = Layout(
    (
        kitchen(
            ((0, 0), (5, 0), (5, 4.5), (0, 4.5)),
            Furniture("Countertop_I_6x2", "south", 2.6),
            Furniture("Fridge_12", "south", 0.8, FRIDGE_ITEMS),
            Furniture(
                "Dining_Table_203_1",
                "north",
                1.4,
                (Item("Plate_1", x=-0.4), Item("Cup_1", x=0.3)),
                off=0.65,
            ),
            Furniture("Chair_002_1", "north", 1.4),
        ),
        Space(
            "LivingRoom",
            ((5, 0), (10, 0), (10, 9), (8.5, 9), (8.5, 4.5), (5, 4.5)),
            (
                Furniture(
                    "RoboTHOR_sofa_ektorp_v",
                    "south",
                    2.5,
                    (Item("Remote_1", x=0.3, y=0.2),),
                ),
                Furniture("Coffee_Table_202_1", "south", 2.5, (Item("Newspaper_1"),), off=1.75),
                Furniture(
                    "TV_Stand_206_1",
                    "east",
                    3.6,
                    (Item("Television_16", board=-1), Item("Keychain_1", board=1, y=0.1)),
                ),
                Furniture("Shelving_Unit_001_1", "east", 8.2, (Item("Vase_Decorative_1", board=1),)),
                Furniture("Floor_Lamp_17", "south", 0.4),
                Furniture("bin_1", "south", 4.4),
            ),
        ),
        Space(
            "Bedroom",
            ((0, 4.5), (5, 4.5), (5, 9), (0, 9)),
            (
                Furniture("Bed_2", "west", 2.6, BEDROOM_BED),
                Furniture("Side_Table_201_3_1", "west", 3.8, (Item("Cellphone_1"),)),
                Furniture("Desk_229_1", "north", 3.4, DESK_ITEMS),
                Furniture("Chair_002_1", "north", 4.5),
                Furniture("Dresser_205_1", "south", 1.2, DRESSER_ITEMS),
            ),
            (("Basketball_1", 4.6, 8.0),),
        ),
        bathroom(
            ((5, 4.5), (8.5, 4.5), (8.5, 9), (5, 9)),
            Furniture("Toilet_2", "north", 0.6, TOILET_ITEMS),
            Furniture("Sink_15", "north", 2.4, SINK_ITEMS),
            Furniture("RoboTHOR_side_table_hopen", "west", 3.0, BATH_TABLE_ITEMS),
            Furniture("bin_10", "south", 0.5),
        ),
    ),
    (
        Hole((3.4, 4.5), 0, 2),
        Hole((8.5, 6.4), 1, 3),
        Hole((10, 5.6), 1),
        Hole((0, 2.4), 0, kind="window"),
        Hole((2.0, 9), 2, kind="window"),
        Hole((7.0, 0), 1, kind="window"),
    ),
    open_plan=((0, 1),),
)

EIGHT_ROOMS = Layout(
    (
        kitchen(
            ((0, 0), (5, 0), (5, 4), (0, 4)),
            Furniture("Countertop_I_6x2", "south", 2.8),
            Furniture("Fridge_12", "south", 0.9, FRIDGE_ITEMS),
            Furniture("Side_Table_202_1", "north", 1.2, (Item("Bottle_1", x=0.25),)),
            Furniture("bin_10", "west", 2.4),
        ),
        Space(
            "LivingRoom",
            ((5, 0), (11, 0), (11, 4), (5, 4)),
            (
                Furniture(
                    "RoboTHOR_sofa_ektorp_v",
                    "south",
                    1.4,
                    (Item("Remote_1", x=0.3, y=0.2),),
                ),
                Furniture(
                    "TV_Stand_206_1",
                    "north",
                    4.4,
                    (Item("Television_16", board=-1), Item("Book_10", board=0, y=0.05)),
                ),
                Furniture("RoboTHOR_armchair_overallt", "south", 4.8),
            ),
        ),
        Space(
            "Bedroom",
            ((11, 0), (15, 0), (15, 4), (11, 4)),
            (
                Furniture("Bed_2", "south", 2.9, BEDROOM_BED),
                Furniture("Dresser_205_1", "north", 2.6, DRESSER_ITEMS),
                Furniture("Side_Table_201_3_1", "south", 1.8),
            ),
        ),
        bathroom(
            ((0, 4), (3.5, 4), (3.5, 8), (0, 8)),
            Furniture("Toilet_2", "south", 0.7, TOILET_ITEMS),
            Furniture("Sink_15", "west", 2.4, SINK_ITEMS),
            Furniture("RoboTHOR_side_table_hopen", "north", 1.6, BATH_TABLE_ITEMS),
        ),
        Space(
            "LivingRoom",
            ((3.5, 4), (9.5, 4), (9.5, 8), (3.5, 8)),
            (
                Furniture(
                    "Dining_Table_203_1",
                    "north",
                    2.9,
                    (Item("Bowl_1", x=-0.3),),
                ),
                Furniture(
                    "Shelving_Unit_001_1",
                    "south",
                    0.8,
                    (Item("Newspaper_1", board=2),),
                ),
                Furniture("Floor_Lamp_17", "south", 5.4),
            ),
        ),
        Space(
            "Bedroom",
            ((9.5, 4), (15, 4), (15, 8), (9.5, 8)),
            (
                Furniture("Bed_20", "east", 2.0),
                Furniture("Desk_229_1", "north", 1.6, DESK_ITEMS),
                Furniture("Chair_002_1", "north", 2.7),
                Furniture("Ottoman_205_1", "south", 1.2),
            ),
            (("Basketball_1", 14.6, 7.5),),
        ),
        Space(
            "Bedroom",
            ((0, 8), (5.5, 8), (5.5, 12), (0, 12)),
            (
                Furniture("Bed_2", "west", 2.0, (Item("Cellphone_1", x=0.3, y=0.2),)),
                Furniture("Shelving_Unit_219_1", "north", 4.4, (Item("Box_13", board=1),)),
                Furniture("Side_Table_201_3_1", "north", 1.0),
            ),
        ),
        bathroom(
            ((5.5, 8), (9.5, 8), (9.5, 12), (5.5, 12)),
            Furniture("Toilet_1", "north", 0.8),
            Furniture("Sink_15", "north", 2.4),
            Furniture("bin_1", "east", 3.0, (Item("Candle_2"),)),
        ),
    ),
    (
        Hole((11, 2.0), 1, 2),
        Hole((7.5, 4), 1, 4),
        Hole((3.5, 6.0), 3, 4),
        Hole((9.5, 6.0), 4, 5),
        Hole((4.5, 8), 4, 6),
        Hole((8.5, 8), 4, 7),
        Hole((8.2, 0), 1),
        Hole((0, 1.4), 0, kind="window"),
        Hole((15, 1.6), 2, kind="window"),
        Hole((3.0, 12), 6, kind="window"),
    ),
    open_plan=((0, 1),),
)

LAYOUTS = {
    "corridor": CORRIDOR,
    "one_room": ONE_ROOM,
    "four_rooms": FOUR_ROOMS,
    "eight_rooms": EIGHT_ROOMS,
}


def main(arguments: list[str] | None = None) -> int:
    """Write the sample houses; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).parents[1] / "adhoc/houses/samples")
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    for name, text in sample_files().items():
        (options.out / name).write_text(text, encoding="utf-8", newline="\n")
        print(f"{options.out / name}: {len(text)} bytes")
    return 0


def sample_files() -> dict[str, str]:
    """The text of every sample file, by file name."""
    return {
        f"{name}.json": json.dumps(house_document(lay_out(name, layout)), indent=1) + "\n"
        for name, layout in LAYOUTS.items()
    }


def lay_out(name: str, layout: Layout) -> House:
    """The house of a layout."""
    rooms = tuple(
        Room(f"room|{index + 2}", space.room_type, tuple((float(x), float(y)) for x, y in space.outline))
        for index, space in enumerate(layout.spaces)
    )
    holes = tuple(hole_opening(rooms, index, hole) for index, hole in enumerate(layout.holes))
    pairs = [frozenset((rooms[a].id, rooms[b].id)) for a, b in layout.open_plan]
    walls, openings = raise_walls(rooms, HEIGHT, holes, pairs)
    numbers: Counter[str] = Counter()
    objects = tuple(
        thing for room, space in zip(rooms, layout.spaces) for thing in furnish(room, space, numbers)
    )
    return House(name, rooms, walls, openings, objects)


def hole_opening(rooms: tuple[Room, ...], index: int, hole: Hole) -> Opening:
    """The opening of a hole in the wall of its first room that its middle lies on."""
    first = rooms[hole.first]
    second = first if hole.second is None else rooms[hole.second]
    width, height = standard_hole(hole.kind)
    x, y = map(float, hole.middle)
    upright = any(
        ax == bx == x and min(ay, by) < y < max(ay, by)
        for (ax, ay), (bx, by) in zip(first.polygon, [*first.polygon[1:], first.polygon[0]])
    )
    dx, dy = (0.0, width / 2) if upright else (width / 2, 0.0)
    bottom = SILL if hole.kind == "window" else 0.0
    return Opening(
        f"{hole.kind}|{first.id.split('|')[1]}|{index}",
        hole.kind,
        (first.id, second.id),
        (x - dx, y - dy),
        (x + dx, y + dy),
        bottom,
        bottom + height,
        hole.kind == "door" and hole.second is not None,
    )


def furnish(room: Room, space: Space, numbers: Counter[str]) -> Iterator[HouseObject]:
    """The furniture of a room, each followed by what lies on it, and the items on its floor."""
    for piece in space.furniture:
        thing = stand(room, piece, numbers)
        yield thing
        surfaces = sorted(object_solid(thing).surfaces, key=lambda surface: surface.center[2])
        for item in piece.items:
            height = surfaces[item.board].center[2]
            middle = surfaces[item.board].center[:2]
            cos_yaw, sin_yaw = round(math.cos(thing.yaw)), round(math.sin(thing.yaw))
            x = middle[0] + cos_yaw * item.x - sin_yaw * item.y
            y = middle[1] + sin_yaw * item.x + cos_yaw * item.y
            yield make(
                item.asset, room, (x, y), height, thing.yaw + item.turn * math.pi / 2, thing.id, numbers
            )
    for asset_id, x, y in space.loose:
        yield make(asset_id, room, (x, y), 0.0, 0.0, FLOOR, numbers)


def stand(room: Room, piece: Furniture, numbers: Counter[str]) -> HouseObject:
    """The piece of furniture on its place along a side of the room's bounding rectangle."""
    low = [min(corner[k] for corner in room.polygon) for k in (0, 1)]
    high = [max(corner[k] for corner in room.polygon) for k in (0, 1)]
    away = GAP + piece.off + asset(piece.asset).size[1] / 2
    middle = {
        "south": (low[0] + piece.along, low[1] + away),
        "north": (low[0] + piece.along, high[1] - away),
        "west": (low[0] + away, low[1] + piece.along),
        "east": (high[0] - away, low[1] + piece.along),
    }[piece.side]
    return make(piece.asset, room, middle, -REST, YAW[piece.side], None, numbers)


def make(
    asset_id: str,
    room: Room,
    middle: Corner,
    support: float,
    yaw: float,
    parent: str | None,
    numbers: Counter[str],
) -> HouseObject:
    """An object that rests a millimetre above its support; furniture stands on the floor itself."""
    facts = asset(asset_id)
    room_number = room.id.split("|")[1]
    name = f"{facts.category}|{room_number}|{numbers[facts.category]}"
    numbers[facts.category] += 1
    height = support + REST + facts.size[2] / 2
    return HouseObject(
        name,
        asset_id,
        facts.category,
        (*middle, height),
        yaw,
        facts.size,
        room.id,
        parent,
        facts.pickupable,
        facts.mass,
        category_facts(facts.category).is_receptacle,
    )


if __name__ == "__main__":
    sys.exit(main())
