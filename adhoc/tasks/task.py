"""The contract of a task: what is to be done, in which sub-tasks and sub-skills, and what is allowed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence

from adhoc.core.calls import Call, CallSpec, ParameterKind, TaskBrief
from adhoc.core.errors import TaskError
from adhoc.core.values import Capability, ObjectRecord, RoomRecord
from adhoc.tasks.common_sense import CommonSense


class Task(ABC):
    """A goal with its vocabularies (paper, section Generalization to Different Tasks).

    A new task brings its own descriptions, sub-tasks, sub-skills and examples; prompts, planners and
    agents stay as they are.
    """

    @property
    @abstractmethod
    def name(self) -> str:
        """Short name, as in configuration."""

    @property
    @abstractmethod
    def description(self) -> str:
        """The task description of every prompt: situation, setting, and what is to be done."""

    @property
    @abstractmethod
    def sub_tasks(self) -> Sequence[CallSpec]:
        """The candidate sub-tasks."""

    @property
    @abstractmethod
    def sub_skills(self) -> Sequence[CallSpec]:
        """The candidate sub-skills; each needs a skill of that name in the agent."""

    @property
    @abstractmethod
    def fallback(self) -> Call:
        """The safe sub-task when no candidate survives and nothing is known."""

    @property
    def examples(self) -> Mapping[str, str]:
        """In-context examples per stage: `generate`, `evaluate`, `reflect`, `sub_skill`, `negotiate`."""
        return {}

    @property
    def common_sense(self) -> CommonSense | None:
        """By what the task judges where things belong; None if it has no need of that."""
        return None

    def with_common_sense(self, common_sense: CommonSense) -> Task:
        """The same task as a robot sees it that judges by `common_sense`; itself if it has no need of any."""
        return self

    def begin_episode(self) -> None:
        """Told before every episode: nothing that was asked for in an earlier one may be left over."""
        if self.common_sense is not None:
            self.common_sense.begin_episode()

    def anticipate(self, records: Iterable[ObjectRecord]) -> None:  # noqa: B027
        """Told which objects `judge` is asked about next, so that a model can be asked about all together."""

    @abstractmethod
    def judge(self, record: ObjectRecord, room_type: Mapping[str, float]) -> bool | None:
        """Whether a detected object needs attention (in tidying up: is misplaced); None if undecided.

        `room_type` gives the probability of each room type for the room that the object is in; it is empty
        while the room is unknown.
        """

    @abstractmethod
    def is_place_for(self, record: ObjectRecord, receptacle: ObjectRecord, room_type: str | None) -> bool:
        """Whether `receptacle` in a room of that type would be a right place for the object."""

    @abstractmethod
    def finished(self, sub_task: Call, done: Sequence[Call], rooms: Mapping[str, RoomRecord]) -> bool:
        """Whether `sub_task` is over, as far as the robot can know: from the sub-skills `done` since it began
        and the `rooms` it knows, by id."""

    def attend(self, record: ObjectRecord, places: Sequence[tuple[ObjectRecord, str | None]]) -> Call | None:
        """For rule-based robots: the sub-task that deals with an object that needs attention.

        `places` are the known receptacles with their rooms' types, nearest first. None if the task has no
        such rule; rule-based robots then only search.
        """
        return None

    def safe_choice(self, rooms: Sequence[RoomRecord]) -> Call:
        """The safe sub-task when no candidate survives; `rooms` are the known ones, nearest first."""
        return self.fallback

    def search(self, room: str) -> Call | None:
        """For rule-based robots: the sub-task of searching a room; None if the task has none."""
        return None

    def legal(self, call: Call, capability: Capability) -> str | None:
        """None if a robot of that capability may do the sub-task `call`; else the reason, as a sentence.

        Raises nothing: an unknown name or a wrong number of arguments is a reason too.
        """
        return self._refusal(call, capability, self.sub_tasks, "sub-task")

    def legal_skill(self, call: Call, capability: Capability) -> str | None:
        """The same for a sub-skill: the two vocabularies may share names."""
        return self._refusal(call, capability, self.sub_skills, "sub-skill")

    def spec(self, name: str) -> CallSpec | None:
        """The declared sub-task of that name, or None."""
        return next((spec for spec in self.sub_tasks if spec.name == name), None)

    def _refusal(
        self, call: Call, capability: Capability, specs: Sequence[CallSpec], kind: str
    ) -> str | None:
        spec = next((spec for spec in specs if spec.name == call.name), None)
        if spec is None:
            return f"{call.name!r} is not a {kind} of the task {self.name!r}"
        if len(call.args) != len(spec.parameters):
            return f"{spec.signature} takes {len(spec.parameters)} arguments, not {len(call.args)}"
        for argument, parameter in zip(call.args, spec.parameters):
            is_number = isinstance(argument, (int, float))
            if is_number != (parameter.kind is ParameterKind.NUMBER):
                return f"argument <{parameter.name}> of {call.name} cannot be {argument!r}"
        if spec.needs_manipulation and not capability.can_manipulate:
            return f"{call.name} needs manipulation ability, which the robot lacks"
        return None

    def brief(self, rooms: Sequence[RoomRecord] = ()) -> TaskBrief:
        """The task as planners and prompts see it, with the safe choice among the known `rooms`.

        Raises TaskError if the declaration is inconsistent.
        """
        self._check_declaration()
        return TaskBrief(
            self.name,
            self.description,
            tuple(self.sub_tasks),
            tuple(self.sub_skills),
            self.safe_choice(rooms),
            dict(self.examples),
        )

    def _check_declaration(self) -> None:
        for kind, specs in (("sub-task", self.sub_tasks), ("sub-skill", self.sub_skills)):
            names = [spec.name for spec in specs]
            if not names or len(set(names)) != len(names):
                raise TaskError(f"task {self.name!r}: {kind} names must be unique and not empty: {names}")
        if self.fallback.name not in {spec.name for spec in self.sub_tasks}:
            raise TaskError(f"task {self.name!r}: fallback {self.fallback} is not one of its sub-tasks")
