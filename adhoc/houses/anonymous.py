"""Names that tell nothing: a house whose ids say what a thing is, and not where it comes from."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import replace

from adhoc.core.streams import stream
from adhoc.houses.house import FLOOR, House


def anonymous(house: House, seed: int) -> House:
    """The same house with ids like `Book_0`, as in the paper, numbered in an order drawn from `seed`.

    ProcTHOR's own ids name the room that an object was made for (`Book|2|5`), and walls their end points:
    a robot that is shown them could read off what is misplaced without looking. Room ids stay.
    """
    objects = _names(seed, house.id, ((thing.id, thing.category) for thing in house.objects))
    walls = _names(seed, house.id, ((wall.id, "Wall") for wall in house.walls))
    holes = _names(seed, house.id, ((it.id, it.kind.capitalize()) for it in house.openings))
    openings = {it.id: replace(it, id=holes[it.id]) for it in house.openings}
    return replace(
        house,
        objects=tuple(
            replace(
                thing,
                id=objects[thing.id],
                parent=thing.parent if thing.parent in (None, FLOOR) else objects[str(thing.parent)],
            )
            for thing in house.objects
        ),
        walls=tuple(
            replace(wall, id=walls[wall.id], openings=tuple(openings[it.id] for it in wall.openings))
            for wall in house.walls
        ),
        openings=tuple(openings.values()),
    )


def _names(seed: int, house_id: str, things: Iterable[tuple[str, str]]) -> dict[str, str]:
    """A new name for each id: its category and a number, drawn within the category."""
    by_category: dict[str, list[str]] = defaultdict(list)
    for name, category in things:
        by_category[category].append(name)
    return {
        name: f"{category}_{number}"
        for category, names in by_category.items()
        for name, number in zip(names, stream(seed, "names", house_id, category).permutation(len(names)))
    }
