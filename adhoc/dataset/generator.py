"""Houses of our own: drawn, furnished, checked, and drawn again until one is sound."""

from __future__ import annotations

from dataclasses import dataclass

from adhoc.core.errors import HouseError
from adhoc.core.streams import stream
from adhoc.dataset.checks.house_checks import sound_house
from adhoc.houses.generation.furnishing import furnish
from adhoc.houses.generation.shell import draw_shell
from adhoc.houses.house import House

ROOM_COUNTS = (1, 2, 3, 4, 5, 6, 7, 8, 10)
"""The numbers of rooms that ProcTHOR's houses, and ours, have."""

MOST_ATTEMPTS = 100


@dataclass(frozen=True)
class Generated:
    """A sound house, and why each attempt before it was rejected."""

    house: House
    rejected: tuple[str, ...]
    """`check: subject: detail` of the first check that each rejected attempt failed."""


def generate_house(rooms: int, seed: int, house_id: str | None = None) -> Generated:
    """A house with that many rooms in which nothing is wrong (see `house_checks`; gravity aside).

    Attempt n draws from a stream of its own, so a house depends on nothing but `rooms` and `seed`. It is
    exactly the house that its ProcTHOR document says: lengths have five decimals.

    Raises HouseError for a number of rooms that is not in `ROOM_COUNTS`, or if no attempt is sound.
    """
    if rooms not in ROOM_COUNTS:
        raise HouseError(f"rooms must be one of {', '.join(map(str, ROOM_COUNTS))}, not {rooms!r}")
    name = house_id or f"generated-{rooms:02d}-{seed}"
    rejected: list[str] = []
    for attempt in range(MOST_ATTEMPTS):
        found = sound_house(draw_candidate(rooms, seed, attempt, name))
        if isinstance(found, House):
            return Generated(found, tuple(rejected))
        rejected.append(str(found))
    raise HouseError(
        f"{name}: none of {MOST_ATTEMPTS} attempts at a house of {rooms} rooms from seed {seed} is sound; "
        f"the last one: {rejected[-1]}"
    )


def draw_candidate(rooms: int, seed: int, attempt: int, name: str) -> House:
    """The house of one attempt, unchecked."""
    generator = stream(seed, "house", rooms, attempt)
    shell = draw_shell(rooms, generator)
    objects = furnish(shell, generator)
    source = f"generated, {rooms} rooms, seed {seed}, attempt {attempt}"
    return House(name, shell.rooms, shell.walls, shell.openings, objects, source)
