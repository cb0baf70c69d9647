"""A tiny house with hand-computed answers, and the way to the real houses."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from adhoc.houses.house import House
from adhoc.houses.procthor import read_house, read_houses

HEIGHT = 2.5


def point(x: float, y: float, z: float) -> dict[str, float]:
    return {"x": x, "y": y, "z": z}


def wall(wall_id: str, room: str, a: tuple[float, float], b: tuple[float, float]) -> dict[str, Any]:
    low = [point(a[0], 0, a[1]), point(b[0], 0, b[1])]
    high = [point(a[0], HEIGHT, a[1]), point(b[0], HEIGHT, b[1])]
    # As in ProcTHOR, an exterior wall gives its top points first.
    return {
        "id": wall_id,
        "roomId": room,
        "polygon": [*high, *low] if "exterior" in wall_id else [*low, *high],
    }


def placed(object_id: str, asset: str, x: float, y: float, z: float, yaw: float = 0.0) -> dict[str, Any]:
    return {
        "id": object_id,
        "assetId": asset,
        "position": point(x, y, z),
        "rotation": point(0.0, yaw, 0.0),
        "kinematic": True,
    }


def tiny_document() -> dict[str, Any]:
    """Two rooms side by side, in the Unity frame: a kitchen over x 0..4 and a bedroom over x 4..8, z 0..3.

    The kitchen's wall to the bedroom runs from z = 3 to z = 0; the door's hole is 0.5..1.5 m along it.
    """
    fridge = placed("f", "Fridge_5", 0.45, 0.8463, 1.5, 90.0)
    fridge["children"] = [placed("e", "Egg_1", 0.45, 1.2, 1.5)]
    return {
        "metadata": {"schema": "1.0.0"},
        "rooms": [
            {
                "id": "room|2",
                "roomType": "Kitchen",
                "floorPolygon": [point(0, 0, 0), point(0, 0, 3), point(4, 0, 3), point(4, 0, 0)],
            },
            {
                "id": "room|3",
                "roomType": "Bedroom",
                "floorPolygon": [point(4, 0, 0), point(4, 0, 3), point(8, 0, 3), point(8, 0, 0)],
            },
        ],
        "walls": [
            wall("wall|2|0|0|0|3", "room|2", (0, 0), (0, 3)),
            wall("wall|2|0|3|4|3", "room|2", (0, 3), (4, 3)),
            wall("wall|2|4|0|4|3", "room|2", (4, 3), (4, 0)),
            wall("wall|2|0|0|4|0", "room|2", (4, 0), (0, 0)),
            wall("wall|3|4|0|4|3", "room|3", (4, 0), (4, 3)),
            wall("wall|3|4|3|8|3", "room|3", (4, 3), (8, 3)),
            wall("wall|3|8|0|8|3", "room|3", (8, 3), (8, 0)),
            wall("wall|3|4|0|8|0", "room|3", (8, 0), (4, 0)),
            wall("wall|exterior|0|0|0|3", "exterior", (0, 0), (0, 3)),
            wall("wall|exterior|4|0|8|0", "exterior", (8, 0), (4, 0)),
        ],
        "doors": [
            {
                "id": "door|2|3",
                "assetId": "Doorway_1",
                "room0": "room|2",
                "room1": "room|3",
                "wall0": "wall|2|4|0|4|3",
                "wall1": "wall|3|4|0|4|3",
                "holePolygon": [point(0.5, 0, 0), point(1.5, 2.0, 0)],
                "openable": True,
                "openness": 1,
            },
            {
                "id": "door|1|3",
                "assetId": "Doorway_4",
                "room0": "room|3",
                "room1": "room|3",
                "wall0": "wall|3|4|0|8|0",
                "wall1": "wall|exterior|4|0|8|0",
                "holePolygon": [point(1.0, 0, 0), point(2.0, 2.0, 0)],
                "openable": False,
                "openness": 0,
            },
        ],
        "windows": [
            {
                "id": "window|2|0",
                "assetId": "Window_Fixed_60x36",
                "room0": "room|2",
                "room1": "room|2",
                "wall0": "wall|2|0|0|0|3",
                "wall1": "wall|exterior|0|0|0|3",
                "holePolygon": [point(1.0, 0.8, 0), point(2.5, 1.7, 0)],
            }
        ],
        "objects": [
            fridge,
            placed("b", "Basketball_1", 7.0, 0.12, 2.0),
            placed("t", "Dining_Table_203_1", 6.0, 0.375, 1.5, 0.0),
        ],
        "proceduralParameters": {},
    }


@pytest.fixture
def document() -> dict[str, Any]:
    return tiny_document()


@pytest.fixture
def fresh_document() -> Callable[[], dict[str, Any]]:
    """Gives a new copy at every call."""
    original = tiny_document()
    return lambda: copy.deepcopy(original)


REAL_FOLDER = Path(__file__).parents[2].parent / "shared" / "data"
SINGLE_ROOMS = REAL_FOLDER / "procthor-single-room-500.jsonl.gz"
TEN_ROOMS = REAL_FOLDER / "procthor-train-1-ten-rooms.json.gz"


@pytest.fixture(scope="session")
def real_houses() -> tuple[House, ...]:
    """The 500 real single-room houses and, last, the ten-room house."""
    for path in (SINGLE_ROOMS, TEN_ROOMS):
        if not path.is_file():
            pytest.skip(f"the real houses are not beside the checkout: no {path.name}")
    return (*read_houses(SINGLE_ROOMS), read_house(TEN_ROOMS))
