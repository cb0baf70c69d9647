"""The tidying-up task."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from importlib import resources

from adhoc.core.calls import Call, CallSpec
from adhoc.core.values import ObjectRecord, RoomRecord
from adhoc.tasks.common_sense import CommonSense
from adhoc.tasks.placement import PlacementCommonSense
from adhoc.tasks.task import Task
from adhoc.tasks.tidying_up.vocabulary import EXPLORE, REPLACE, STOP, SUB_SKILLS, SUB_TASKS

_STAGES = ("generate", "evaluate", "reflect", "sub_skill", "negotiate")


class TidyingUp(Task):
    """The paper's task: put every misplaced object into a reasonable receptacle.

    Args:
        common_sense: Where things belong, for the robots alone: the referee has its own table. The placement
            statistics of ProcTHOR by default.
        misplaced_below: An object is called misplaced when the probability that its place is reasonable,
            over the inferred room types, falls below this. The paper decides by common sense alone; a
            robot that has seen half of a room has to weigh what the room may be.
        reasonable_above: It is called well placed above this, and stays undecided in between.
    """

    def __init__(
        self,
        common_sense: CommonSense | None = None,
        misplaced_below: float = 0.05,
        reasonable_above: float = 0.5,
    ) -> None:
        self._common_sense = common_sense or PlacementCommonSense()
        self._misplaced_below = misplaced_below
        self._reasonable_above = reasonable_above
        self._belongs: dict[tuple[str, str, str], bool] = {}

    @property
    def name(self) -> str:
        """`tidying_up`."""
        return "tidying_up"

    @property
    def description(self) -> str:
        """The task description of every prompt."""
        return _text("description").replace("\n", " ")

    @property
    def sub_tasks(self) -> Sequence[CallSpec]:
        """Explore, Re-place, Stop."""
        return SUB_TASKS

    @property
    def sub_skills(self) -> Sequence[CallSpec]:
        """The seven sub-skills of the paper's appendix."""
        return SUB_SKILLS

    @property
    def fallback(self) -> Call:
        """Stop: the only sub-task that needs nothing to be known."""
        return Call(STOP.name)

    @property
    def examples(self) -> Mapping[str, str]:
        """One in-context example per stage."""
        return {stage: _text(f"example_{stage}") for stage in _STAGES}

    @property
    def common_sense(self) -> CommonSense:
        """Where things belong, as the robots see it."""
        return self._common_sense

    def with_common_sense(self, common_sense: CommonSense) -> TidyingUp:
        """See `Task`."""
        return TidyingUp(common_sense, self._misplaced_below, self._reasonable_above)

    def begin_episode(self) -> None:
        """See `Task`."""
        self._belongs.clear()
        super().begin_episode()

    def anticipate(self, records: Iterable[ObjectRecord]) -> None:
        """Consider all that can be judged at once."""
        self._common_sense.consider(
            record.category for record in records if record.room is not None and _holder(record) is not None
        )

    def judge(self, record: ObjectRecord, room_type: Mapping[str, float]) -> bool | None:
        """Whether the object is misplaced, over what its room may be; None while undecided.

        An object that belongs nowhere is left alone (None): nobody could put it right.
        """
        holder = _holder(record)
        if holder is None or not room_type:
            return None
        if not self._common_sense.places_for(record.category):
            return None
        likely = sum(
            probability
            for kind, probability in room_type.items()
            if self._is_reasonable(record.category, holder, kind)
        )
        if likely < self._misplaced_below:
            return True
        return False if likely > self._reasonable_above else None

    def is_place_for(self, record: ObjectRecord, receptacle: ObjectRecord, room_type: str | None) -> bool:
        """Whether the receptacle, in a room inferred to be of that type, is reasonable for the object."""
        return room_type is not None and self._is_reasonable(record.category, receptacle.category, room_type)

    def finished(self, sub_task: Call, done: Sequence[Call], rooms: Mapping[str, RoomRecord]) -> bool:
        """Explore ends with its room explored; Re-place with its object put; Stop never."""
        if sub_task.name == EXPLORE.name:
            room = rooms.get(str(sub_task.args[0]))
            return room is not None and room.explored
        if sub_task.name == REPLACE.name:
            return any(call.name == "PutObject" and call.args[0] == sub_task.args[0] for call in done)
        return False

    def attend(self, record: ObjectRecord, places: Sequence[tuple[ObjectRecord, str | None]]) -> Call | None:
        """Re-place the object: to the nearest known reasonable receptacle, else to its likeliest place."""
        for receptacle, room_type in places:
            if room_type is not None and self.is_place_for(record, receptacle, room_type):
                return Call(REPLACE.name, (record.id, receptacle.category, room_type))
        likeliest = next(iter(self._common_sense.places_for(record.category)), None)
        if likeliest is None:
            return None
        return Call(REPLACE.name, (record.id, likeliest.receptacle, likeliest.room_type))

    def safe_choice(self, rooms: Sequence[RoomRecord]) -> Call:
        """Explore the nearest unexplored room, or else the nearest: it helps a little and disturbs nobody.

        Stop, which is for good, only while no room is known.
        """
        ordered = [*(room for room in rooms if not room.explored), *rooms]
        return Call(EXPLORE.name, (ordered[0].id,)) if ordered else self.fallback

    def search(self, room: str) -> Call | None:
        """Explore the room."""
        return Call(EXPLORE.name, (room,))

    def _is_reasonable(self, category: str, receptacle: str, room_type: str) -> bool:
        key = (category, receptacle, room_type)
        if key not in self._belongs:
            self._belongs[key] = not self._common_sense.is_misplaced(*key)
        return self._belongs[key]


def _holder(record: ObjectRecord) -> str | None:
    """What kind of thing an object lies on or in; None for furniture, and while it is unknown."""
    return record.receptacle_category if record.is_pickupable else None


@cache
def _text(name: str) -> str:
    """One of the texts that lie beside this file, and that prompts carry."""
    return (resources.files(__package__) / "texts" / f"{name}.txt").read_text(encoding="utf-8").strip()
