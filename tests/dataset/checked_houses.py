"""Houses for the tests of the checks: those of the package, and the real ones where they are at hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from adhoc.houses.house import House, HouseObject
from adhoc.houses.procthor import read_houses
from adhoc.houses.samples import sample_house

DATA = Path(__file__).parents[3] / "shared" / "data"


def real_houses(every: int) -> list[House]:
    """The ten-room house and every so many of the single-room ones; skips the test without them."""
    files = [
        DATA / "procthor-train-1-ten-rooms.json.gz",
        DATA / "procthor-single-room-500.jsonl.gz",
    ]
    if not all(path.exists() for path in files):
        pytest.skip("the real ProcTHOR houses are not beside the checkout")
    return [*read_houses(files[0]), *list(read_houses(files[1]))[::every]]


def changed(house: House, object_id: str, **changes: object) -> House:
    """The house with other values for one object."""
    return replace(
        house,
        objects=tuple(
            replace(thing, **changes) if thing.id == object_id else thing for thing in house.objects
        ),
    )


def with_block(position: tuple[float, float, float], size: tuple[float, float, float]) -> House:
    """The sample `corridor` with an extra block of furniture."""
    house = sample_house("corridor")
    block = HouseObject("block", "Box_13", "Box", position, 0.0, size, "room|2", None, False, 0.0, False)
    return replace(house, objects=(*house.objects, block))
