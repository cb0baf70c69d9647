import numpy as np
import pytest

from adhoc.core.values import Label
from adhoc.perception.holders import decide_holders
from adhoc.perception.object_table import NO_RECEPTACLE, ON_FLOOR, SEEN, ObjectTable

TABLE = (0.0, 0.0, 0.0, 1.0, 1.0, 0.8)
DESK = (-1.0, -1.0, 0.0, 2.0, 2.0, 0.8)
SHELF = (0.0, 0.0, 0.0, 1.0, 1.0, 2.0)


def holder_of(item: tuple[float, ...], **receptacles: tuple[float, ...]) -> str | None:
    """What geometry alone says, from boxes (x0, y0, z0, x1, y1, z1)."""
    table = ObjectTable()
    kinds = {"table": "DiningTable", "desk": "Desk", "shelf": "ShelvingUnit", "bowl": "Bowl"}
    for name, box in {"item": item, **receptacles}.items():
        slot = table.slot(Label(name, kinds.get(name, "Apple")))
        table.boxes[slot] = box
        table.known[slot] = SEEN
    changed = np.zeros(1, np.uint8)
    decide_holders(
        np.array([0]),
        1,
        len(table.ids),
        table.kinds,
        table.known,
        table.boxes,
        table.can_hold,
        table.vote_slots,
        table.vote_counts,
        table.holders,
        np.zeros((40, 40), np.uint8),
        np.array([-1.0, -1.0]),
        0.05,
        0.1,
        changed,
    )
    answer = int(table.holders[0])
    assert changed[0] == (answer != NO_RECEPTACLE)
    return {NO_RECEPTACLE: None, ON_FLOOR: "Floor"}.get(answer) or (
        table.ids[answer] if answer >= 0 else None
    )


def at(x: float, y: float, bottom: float) -> tuple[float, ...]:
    return (x - 0.05, y - 0.05, bottom, x + 0.05, y + 0.05, bottom + 0.1)


@pytest.mark.parametrize(
    ("item", "receptacles", "expected"),
    [
        pytest.param(
            at(0.5, 0.5, 0.8), {"table": TABLE, "desk": DESK}, "table", id="the tighter of two tops"
        ),
        pytest.param(at(0.5, 0.5, 0.8), {"shelf": SHELF, "desk": DESK}, "desk", id="on top before inside"),
        pytest.param(at(0.5, 0.5, 0.4), {"shelf": SHELF, "desk": DESK}, "shelf", id="inside the tighter one"),
        pytest.param(at(0.5, 0.5, 1.2), {"table": TABLE}, None, id="hanging in the air above it"),
        pytest.param(at(1.5, 0.5, 0.8), {"table": TABLE}, None, id="beside it, high"),
        pytest.param(at(1.5, 0.5, 0.0), {"table": TABLE}, "Floor", id="beside it, low"),
        pytest.param(at(0.5, 0.5, 0.8), {"apple": TABLE}, None, id="apples hold nothing"),
        pytest.param(
            at(0.5, 0.5, 0.8), {"bowl": (0.49, 0.49, 0.8, 0.51, 0.51, 0.85)}, None, id="too small a bowl"
        ),
    ],
)
def test_receptacle_from_geometry(item, receptacles, expected):
    assert holder_of(item, **receptacles) == expected


def test_slots_are_for_good_and_columns_grow():
    table = ObjectTable()
    names = [f"Apple|{index}" for index in range(300)]
    slots = [table.slot(Label(name, "Apple")) for name in names]
    table.boxes[slots[5]] = 1.0
    assert slots == list(range(300))
    assert table.slot(Label("Apple|7", "Apple")) == 7
    assert table.slot(Label("wall|1", "Wall")) == table.slot(Label("wall|2", "Wall"))
    assert len(table.kinds) >= 301
    assert table.centre(5) == (1.0, 1.0, 1.0)
