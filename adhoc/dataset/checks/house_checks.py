"""What a sound house is: one check per promise, each of which names what breaks it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from adhoc.core.errors import AssetError, HouseError
from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.checks.house_format import differences, read_back
from adhoc.dataset.checks.penetration import LIMIT, penetrations
from adhoc.dataset.checks.sight import Sight
from adhoc.dataset.checks.support import unsupported
from adhoc.houses.build import build_solids
from adhoc.houses.facts import is_reasonable
from adhoc.houses.house import FLOOR, House
from adhoc.houses.solids import Solid


@dataclass(frozen=True)
class Violation:
    """One broken promise: the name of the check, the id of the part of the house, and what is wrong."""

    check: str
    subject: str
    detail: str

    def __str__(self) -> str:
        return f"{self.check}: {self.subject}: {self.detail}"


class Inspection:
    """A house under inspection, with what the checks need of it, computed once and only if needed."""

    def __init__(self, house: House) -> None:
        self.house = house

    @cached_property
    def again(self) -> House:
        """The house as its document is read. Raises HouseError and AssetError."""
        return read_back(self.house)

    @cached_property
    def solids(self) -> tuple[Solid, ...]:
        """The boxes of the house."""
        return build_solids(self.house)

    @cached_property
    def cells(self) -> FreeCells:
        """Where robots fit."""
        return FreeCells(self.house.rooms, self.solids)

    @cached_property
    def sight(self) -> Sight:
        """What they see and reach."""
        return Sight(self.solids, self.cells)


Check = Callable[[Inspection], Iterator[Violation]]


def check_house(house: House) -> list[Violation]:
    """Everything that is wrong with a house but for what gravity does to it; nothing for a sound house.

    A house whose document cannot be read back is not looked at further.
    """
    inspection = Inspection(house)
    broken = list(check_schema(inspection))
    if broken:
        return broken
    return [violation for check in CHECKS_OF_CONTENT.values() for violation in check(inspection)]


def sound_house(candidate: House) -> House | Violation:
    """The house as its document is read, or the first thing that is wrong with it, cheap checks first."""
    drawn = Inspection(candidate)
    for violation in check_schema(drawn):
        return violation
    read = Inspection(drawn.again)
    for check in CHECKS_OF_CONTENT.values():
        for violation in check(read):
            return violation
    return read.house


def check_placement(inspection: Inspection) -> Iterator[Violation]:
    """No object that can be picked up is where common sense (`houses.facts.is_reasonable`) says it is not."""
    house = inspection.house
    room_types = {room.id: room.room_type for room in house.rooms}
    categories = {thing.id: thing.category for thing in house.objects}
    for thing in house.objects:
        if not thing.pickupable or thing.parent is None:
            continue
        receptacle = FLOOR if thing.parent == FLOOR else categories[thing.parent]
        room_type = room_types[thing.room]
        if not is_reasonable(thing.category, receptacle, room_type):
            detail = f"a {thing.category} does not belong on a {receptacle} in a {room_type}"
            yield Violation("placement", thing.id, detail)


def check_support(inspection: Inspection) -> Iterator[Violation]:
    """Everything stands, lies or hangs where the house says; nothing hovers."""
    for subject, detail in unsupported(inspection.house, inspection.solids):
        yield Violation("support", subject, detail)


def check_penetration(inspection: Inspection) -> Iterator[Violation]:
    """No two things are more than 2 mm inside each other. Walls may meet walls."""
    for first, second, depth in penetrations(inspection.solids):
        detail = f"is {1000 * depth:.1f} mm inside {first}, more than {1000 * LIMIT:g} mm"
        yield Violation("penetration", second, detail)


def check_rooms(inspection: Inspection) -> Iterator[Violation]:
    """A robot of radius 0.2 m can drive between all rooms: the largest connected part reaches into each."""
    house, cells = inspection.house, inspection.cells
    if not cells.free.any():
        yield Violation("rooms", house.id, "a robot of radius 0.2 m fits nowhere")
        return
    reached = set(cells.room[cells.connected].tolist())
    for number, room in enumerate(house.rooms):
        if number not in reached:
            if (cells.free & (cells.room == number)).any():
                detail = f"this {room.room_type} is cut off: no way leads there from the rest of the house"
            else:
                detail = f"this {room.room_type} has no cell where a robot of radius 0.2 m fits"
            yield Violation("rooms", room.id, detail)


def check_sight(inspection: Inspection) -> Iterator[Violation]:
    """Every object, whether it can be picked up or not, is seen from within reach by some robot.

    That is asked of furniture and of what hangs on walls too, of which some part must be within reach; a
    camera that looks 30 degrees up sees 75 degrees above the horizon, so pictures are no exception.
    """
    for thing in inspection.house.objects:
        if not inspection.sight.is_seen(thing.id):
            yield Violation(
                "sight", thing.id, f"no robot sees this {thing.category} from where it can reach it"
            )


def check_schema(inspection: Inspection) -> Iterator[Violation]:
    """The house is written as ProcTHOR JSON and read back as the same house."""
    house = inspection.house
    try:
        again = inspection.again
    except (HouseError, AssetError) as error:
        yield Violation("schema", house.id, f"its document cannot be read: {error}")
        return
    for subject, detail in differences(house, again):
        yield Violation("schema", subject, detail)


CHECKS_OF_CONTENT: Mapping[str, Check] = {
    "placement": check_placement,
    "support": check_support,
    "penetration": check_penetration,
    "rooms": check_rooms,
    "sight": check_sight,
}
"""The checks of what is in a house, cheap ones first."""

CHECKS: Mapping[str, Check] = {"schema": check_schema, **CHECKS_OF_CONTENT}
"""All checks by name, but for gravity."""
