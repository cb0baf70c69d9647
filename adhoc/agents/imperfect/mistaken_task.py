"""A task as a robot sees it that judges some objects wrongly."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from adhoc.core.calls import Call, CallSpec
from adhoc.core.values import ObjectRecord, RoomRecord
from adhoc.tasks.common_sense import CommonSense
from adhoc.tasks.task import Task


class MistakenTask(Task):
    """The same task, but that an object which `is_mistaken` names needs attention where it needs none, and
    none where it needs some. What is undecided stays so."""

    def __init__(self, task: Task, is_mistaken: Callable[[ObjectRecord], bool]) -> None:
        self._task, self._is_mistaken = task, is_mistaken

    def judge(self, record: ObjectRecord, room_type: Mapping[str, float]) -> bool | None:
        """See `Task`."""
        judgement = self._task.judge(record, room_type)
        return judgement if judgement is None else judgement != self._is_mistaken(record)

    def with_common_sense(self, common_sense: CommonSense) -> Task:
        """See `Task`."""
        return MistakenTask(self._task.with_common_sense(common_sense), self._is_mistaken)

    @property
    def name(self) -> str:
        """See `Task`."""
        return self._task.name

    @property
    def description(self) -> str:
        """See `Task`."""
        return self._task.description

    @property
    def sub_tasks(self) -> Sequence[CallSpec]:
        """See `Task`."""
        return self._task.sub_tasks

    @property
    def sub_skills(self) -> Sequence[CallSpec]:
        """See `Task`."""
        return self._task.sub_skills

    @property
    def fallback(self) -> Call:
        """See `Task`."""
        return self._task.fallback

    @property
    def examples(self) -> Mapping[str, str]:
        """See `Task`."""
        return self._task.examples

    @property
    def common_sense(self) -> CommonSense | None:
        """See `Task`."""
        return self._task.common_sense

    def begin_episode(self) -> None:
        """See `Task`."""
        self._task.begin_episode()

    def anticipate(self, records: Iterable[ObjectRecord]) -> None:
        """See `Task`."""
        self._task.anticipate(records)

    def is_place_for(self, record: ObjectRecord, receptacle: ObjectRecord, room_type: str | None) -> bool:
        """See `Task`."""
        return self._task.is_place_for(record, receptacle, room_type)

    def finished(self, sub_task: Call, done: Sequence[Call], rooms: Mapping[str, RoomRecord]) -> bool:
        """See `Task`."""
        return self._task.finished(sub_task, done, rooms)

    def attend(self, record: ObjectRecord, places: Sequence[tuple[ObjectRecord, str | None]]) -> Call | None:
        """See `Task`."""
        return self._task.attend(record, places)

    def safe_choice(self, rooms: Sequence[RoomRecord]) -> Call:
        """See `Task`."""
        return self._task.safe_choice(rooms)

    def search(self, room: str) -> Call | None:
        """See `Task`."""
        return self._task.search(room)
