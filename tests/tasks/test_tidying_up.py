"""The tidying-up task: its vocabulary, what is legal, and what it calls misplaced."""

from __future__ import annotations

import pytest

from adhoc.core.calls import Call
from adhoc.core.values import Capability, ObjectRecord, RoomRecord
from adhoc.tasks.tidying_up import TidyingUp

ABLE = Capability(can_manipulate=True)
UNABLE = Capability(can_manipulate=False)
BEDROOM = {"Bedroom": 1.0, "Kitchen": 0.0, "LivingRoom": 0.0, "Bathroom": 0.0}
KITCHEN = {"Bedroom": 0.0, "Kitchen": 1.0, "LivingRoom": 0.0, "Bathroom": 0.0}
ANYWHERE = dict.fromkeys(BEDROOM, 0.25)


@pytest.fixture
def task() -> TidyingUp:
    return TidyingUp()


def item(category: str, receptacle: str | None, **fields: object) -> ObjectRecord:
    return ObjectRecord(
        f"{category}_1", category, (1.0, 1.0, 0.5), "room|1", "R", receptacle, is_pickupable=True, **fields
    )  # type: ignore[arg-type]


def test_vocabulary_is_the_papers(task):
    assert [spec.name for spec in task.sub_tasks] == ["Explore", "Re-place", "Stop"]
    assert [spec.name for spec in task.sub_skills] == [
        "GoToObject",
        "GoToPoint",
        "GoToRoom",
        "PickupObject",
        "PutObject",
        "Explore",
        "Stop",
    ]


def test_brief_carries_an_example_for_every_stage(task):
    assert set(task.brief().examples) == {"generate", "evaluate", "reflect", "sub_skill", "negotiate"}
    assert all("Answer: {" in text for text in task.brief().examples.values())


@pytest.mark.parametrize(
    ("call", "capability", "reason"),
    [
        (Call("Re-place", ("Book_1", "Desk", "Bedroom")), ABLE, None),
        (Call("Re-place", ("Book_1", "Desk", "Bedroom")), UNABLE, "manipulation"),
        (Call("Explore", ("room|1",)), UNABLE, None),
        (Call("Explore", ()), UNABLE, "takes 1 arguments"),
        (Call("Fly", ()), ABLE, "not a sub-task"),
        (Call("GoToPoint", (1.0, 2.0)), ABLE, "not a sub-task"),
    ],
)
def test_legal_sub_tasks(task, call, capability, reason):
    answer = task.legal(call, capability)
    assert answer is None if reason is None else reason in answer


@pytest.mark.parametrize(
    ("call", "capability", "reason"),
    [
        (Call("GoToPoint", (1.0, 2.0)), UNABLE, None),
        (Call("GoToPoint", ("a", 2.0)), UNABLE, "cannot be 'a'"),
        (Call("PickupObject", ("Book_1",)), UNABLE, "manipulation"),
        (Call("Explore"), UNABLE, None),
        (Call("Re-place", ("Book_1", "Desk", "Bedroom")), ABLE, "not a sub-skill"),
    ],
)
def test_legal_sub_skills(task, call, capability, reason):
    """`Explore` takes a room as a sub-task and nothing as a sub-skill."""
    answer = task.legal_skill(call, capability)
    assert answer is None if reason is None else reason in answer


def test_a_fork_in_the_bed_is_misplaced_whatever_the_room(task):
    assert task.judge(item("Fork", "Bed"), ANYWHERE) is True


def test_a_pillow_on_the_bed_is_well_placed_in_a_bedroom(task):
    assert task.judge(item("Pillow", "Bed"), BEDROOM) is False


def test_the_inferred_room_type_decides(task):
    """A plunger may lie on the floor of a bathroom and not of a kitchen; undecided in between."""
    bathroom = {**dict.fromkeys(BEDROOM, 0.0), "Bathroom": 1.0}
    assert task.judge(item("Plunger", "Floor"), bathroom) is False
    assert task.judge(item("Plunger", "Floor"), KITCHEN) is True
    assert task.judge(item("Plunger", "Floor"), {**KITCHEN, "Kitchen": 0.7, "Bathroom": 0.3}) is None


def test_what_cannot_be_judged_is_left_undecided(task):
    assert task.judge(item("Fork", None), KITCHEN) is None
    assert task.judge(item("AluminumFoil", "Bed"), KITCHEN) is None
    furniture = ObjectRecord("Bed_1", "Bed", (0.0, 0.0, 0.0), is_receptacle=True)
    assert task.judge(furniture, BEDROOM) is None


def test_attend_takes_the_nearest_reasonable_receptacle(task):
    sink = ObjectRecord("Sink_1", "Sink", (0.0, 0.0, 0.0), is_receptacle=True)
    bed = ObjectRecord("Bed_1", "Bed", (0.0, 0.0, 0.0), is_receptacle=True)
    places = [(sink, "Kitchen"), (bed, None), (bed, "Bedroom")]
    assert task.attend(item("Pillow", "Floor"), places) == Call("Re-place", ("Pillow_1", "Bed", "Bedroom"))


def test_attend_without_a_known_receptacle_names_the_likeliest_place(task):
    call = task.attend(item("Pillow", "Floor"), [])
    assert call is not None
    assert call.name == "Re-place"
    assert task.legal(call, ABLE) is None


def test_finished(task):
    rooms = {"room|1": RoomRecord("room|1", explored=True), "room|2": RoomRecord("room|2")}
    put = Call("PutObject", ("Book_1", "Desk_1", "room|1"))
    replace = Call("Re-place", ("Book_1", "Desk", "Bedroom"))
    assert task.finished(Call("Explore", ("room|1",)), (), rooms)
    assert not task.finished(Call("Explore", ("room|2",)), (), rooms)
    assert task.finished(replace, (put,), rooms)
    assert not task.finished(replace, (Call("PickupObject", ("Book_1",)),), rooms)


def test_safe_choice_explores_before_it_stops(task):
    rooms = [RoomRecord("room|1", explored=True), RoomRecord("room|2")]
    assert task.safe_choice(rooms) == Call("Explore", ("room|2",))
    assert task.safe_choice(rooms[:1]) == Call("Explore", ("room|1",))
    assert task.safe_choice([]) == Call("Stop")
