"""One fixed situation of tidying up, with the task's own brief."""

from __future__ import annotations

from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.plans import Assessment, Candidate, Context, Event
from adhoc.core.values import Capability, ObjectRecord, Pose, RoomRecord
from adhoc.prompting.stage import Prediction, StageInput
from adhoc.tasks.tidying_up.task import TidyingUp

REPLACE = Call("Re-place", ("Book_4", "Desk", "Bedroom"))
EXPLORE = Call("Explore", ("room_5",))
CANDIDATES = (
    Candidate(REPLACE, "the nearest misplaced object"),
    Candidate(EXPLORE, "not explored yet"),
    Candidate(Call("Stop"), "nothing else is left"),
)
REPLY = Message(
    MessageKind.REPLY,
    "Current sub-task: Explore room_5. Explored rooms: room_2, room_3. Detected objects: none.",
    {},
    "newcomer",
    "teammate_1",
    40,
)

TIDYING_UP_CONTEXT = Context(
    step=40,
    task=TidyingUp().brief(),
    me="newcomer",
    pose=Pose(2.0, 3.0, 0.0),
    capability=Capability(payload=20.0, camera_height=1.6, max_steps=500),
    steps_left=460,
    room="room_3",
    holding=None,
    objects=(
        ObjectRecord(
            "Book_4", "Book", (4.0, 3.0, 0.8), "room_3", "Sink_1", "Sink", True, 0.5, False, True, 40
        ),
        ObjectRecord(
            "Cup_1",
            "Cup",
            (9.0, 3.0, 0.0),
            "room_2",
            "Floor",
            "Floor",
            True,
            0.3,
            False,
            True,
            31,
            "teammate_1",
        ),
        ObjectRecord("Sink_1", "Sink", (4.0, 3.0, 0.7), "room_3", is_receptacle=True, last_seen=40),
        ObjectRecord("Desk_1", "Desk", (8.0, 3.0, 0.6), "room_2", is_receptacle=True, last_seen=31),
    ),
    rooms=(
        RoomRecord("room_2", "Bedroom", (8.0, 3.0), True, "teammate_1"),
        RoomRecord("room_3", "Bathroom", (3.0, 3.0), True, "me"),
        RoomRecord("room_5", None, (2.0, 9.0)),
    ),
    teammates=(
        TeammateView(
            "teammate_1",
            Capability(can_manipulate=False, payload=0.0, camera_height=0.9, max_steps=400),
            position=(8.0, 3.0),
            room="room_2",
            sub_task=EXPLORE,
            sub_skill=Call("GoToRoom", ("room_5",)),
            steps_left=310,
            explored_rooms=("room_2",),
            last_heard=40,
        ),
        TeammateView("teammate_2", Capability(max_steps=300), last_heard=12),
        TeammateView("teammate_3", stopped=True, last_heard=30),
    ),
    messages=(
        Message(MessageKind.JOIN, "I am newcomer and I join the team.", {}, None, "newcomer", 10),
        Message(MessageKind.REFLECTED, "I am in room_2.", {}, "newcomer", "teammate_1", 10),
        Message(MessageKind.DETECTION, "Detected objects: Cup_1.", {}, None, "teammate_1", 31),
        Message(MessageKind.INTENTION, f"I intend to do: {REPLACE}.", {}, None, "newcomer", 40),
        REPLY,
    ),
    history=(Event(10, "joined the team"), Event(39, "Explore succeeded")),
)

TIDYING_UP_STAGES = {
    "generate": StageInput(count=3),
    "cot": StageInput(count=1),
    "evaluate": StageInput(candidates=CANDIDATES),
    "reflect": StageInput(chosen=CANDIDATES[0], replies=(REPLY,)),
    "gpl_generate": StageInput(count=3, predictions=(Prediction("teammate_1", EXPLORE),)),
    "negotiate": StageInput(plans={"teammate_1": EXPLORE}),
    "sub_skill": StageInput(sub_task=REPLACE, last=Assessment(True, "Explore succeeded", found=("Book_4",))),
}
