"""A task of one's own: robots take a photograph of every television in the house.

It declares other sub-tasks than tidying up and one new sub-skill, with the skill that executes it. No file of
`adhoc` is touched.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from adhoc import (
    Action,
    ActionName,
    Call,
    CallSpec,
    Capability,
    ObjectRecord,
    Parameter,
    ParameterKind,
    RoomRecord,
    Skill,
    SkillView,
    Task,
    standard_skills,
)

OBJECT = Parameter("object", ParameterKind.OBJECT)
ROOM = Parameter("room", ParameterKind.ROOM)


class Inventory(Task):
    """Photograph every object of one category, a television by default."""

    def __init__(self, category: str = "Television") -> None:
        self.category = category
        self.photographed: set[str] = set()

    name = "inventory"
    description = "Robots take stock of a house: every television must be photographed once, from nearby."
    sub_tasks = (
        CallSpec("Visit", (ROOM,), "Look for televisions in the room.", steps=("GoToRoom {room}", "Explore")),
        CallSpec(
            "Record",
            (OBJECT,),
            "Go to a television and photograph it.",
            steps=("GoToObject {object}", "TakePhoto {object}"),
        ),
        CallSpec("Rest", (), "Do nothing more.", steps=("Stop",)),
    )
    sub_skills = (
        CallSpec("GoToObject", (OBJECT,), "Navigate to a known object."),
        CallSpec("GoToRoom", (ROOM,), "Navigate to a known room."),
        CallSpec("TakePhoto", (OBJECT,), "Photograph an object that is in view and near."),
        CallSpec("Explore", (), "Explore the area around."),
        CallSpec("Stop", (), "Stop for good."),
    )
    fallback = Call("Rest")

    def judge(self, record: ObjectRecord, room_type: Mapping[str, float]) -> bool | None:
        """A television needs attention until it has been photographed."""
        return record.id not in self.photographed if record.category == self.category else None

    def is_place_for(self, record: ObjectRecord, receptacle: ObjectRecord, room_type: str | None) -> bool:
        """Nothing is carried anywhere in this task."""
        return False

    def finished(self, sub_task: Call, done: Sequence[Call], rooms: Mapping[str, RoomRecord]) -> bool:
        """A visit ends with the room explored, a record with its photograph."""
        if sub_task.name == "Visit":
            return sub_task.args[0] in rooms and rooms[str(sub_task.args[0])].explored
        return Call("TakePhoto", sub_task.args) in done

    def attend(self, record: ObjectRecord, places: Sequence[tuple[ObjectRecord, str | None]]) -> Call | None:
        """For rule-based robots: an unphotographed television is recorded."""
        return Call("Record", (record.id,))

    def search(self, room: str) -> Call | None:
        """For rule-based robots: rooms are visited."""
        return Call("Visit", (room,))


class TakePhoto(Skill):
    """Holds still for one step while the camera works, if the object is in view."""

    def __init__(self, task: Inventory) -> None:
        self._task = task

    def start(self, call: Call, view: SkillView) -> None:
        """See `adhoc.Skill`."""
        self._object, self._taken, self.failure = str(call.args[0]), False, None

    def step(self, view: SkillView) -> Action | None:
        """See `adhoc.Skill`."""
        if self._taken:
            self._task.photographed.add(self._object)
            return None
        if self._object not in {label.id for label in view.observation.labels.values()}:
            self.failure = "the object is not in view"
            return None
        self._taken = True
        return Action(ActionName.LOOK_UP)


def inventory_skills(task: Inventory) -> dict:
    """The paper's skills and the new one, by sub-skill name."""
    return {**standard_skills(), "TakePhoto": lambda: TakePhoto(task)}


CAMERA_ROBOT = Capability(can_manipulate=False, camera_height=1.6)
"""A robot that this task is for."""
