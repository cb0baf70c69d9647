"""What can be read in a prompt: the offline reasoner's whole knowledge of the situation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

Position = tuple[float, float]


class CallText(NamedTuple):
    """A sub-task or a sub-skill as words."""

    name: str
    args: tuple[str, ...] = ()

    def __str__(self) -> str:
        return " ".join((self.name, *self.args))


class SpecFact(NamedTuple):
    """One call of a vocabulary. `parameters` maps a parameter's name to its kind, in order."""

    name: str
    parameters: Mapping[str, str]
    needs_manipulation: bool = False
    steps: tuple[str, ...] = ()
    ends_work: bool = False
    """Whether this sub-skill is the whole of a sub-task."""


class RoomFact(NamedTuple):
    """One known room. `room_type` None while unknown; `distance` in metres."""

    id: str
    room_type: str | None
    explored: bool
    distance: float


class ObjectFact(NamedTuple):
    """One object of interest; `attention` None while undecided, `mass` in kilograms."""

    id: str
    category: str
    attention: bool | None
    room: str | None
    receptacle: str | None
    position: Position | None
    distance: float
    mass: float


class ReceptacleFact(NamedTuple):
    """One known receptacle."""

    id: str
    category: str
    room: str
    room_type: str | None
    distance: float


class TeammateFact(NamedTuple):
    """One teammate that is still at work."""

    name: str
    manipulation: bool
    payload: float
    position: Position | None
    room: str | None
    holding: str | None
    sub_task: CallText | None
    sub_skill: CallText | None

    @property
    def claims(self) -> frozenset[str]:
        """The ids that it is at: what it holds and what its sub-task and sub-skill name."""
        claimed = {self.holding} if self.holding else set()
        for call in (self.sub_task, self.sub_skill):
            claimed.update(call.args if call else ())
        return frozenset(claimed)


class EventFact(NamedTuple):
    """One line of memory."""

    step: int
    text: str


class ReplyFact(NamedTuple):
    """One reply of a teammate to the intention."""

    sender: str
    text: str


class Facts(NamedTuple):
    """Everything that a prompt says. What it does not say is absent, empty, or at its least useful."""

    output_format: str = ""
    instruction: str = ""
    sub_tasks: tuple[SpecFact, ...] = ()
    sub_skills: tuple[SpecFact, ...] = ()
    step: int = 0
    room: str | None = None
    position: Position | None = None
    holding: str | None = None
    done: tuple[CallText, ...] = ()
    last: str = ""
    manipulation: bool = False
    payload: float = float("inf")
    rooms: tuple[RoomFact, ...] = ()
    objects: tuple[ObjectFact, ...] = ()
    receptacles: Mapping[str, tuple[ReceptacleFact, ...]] = {}
    """By category, nearest first."""
    teammates: tuple[TeammateFact, ...] = ()
    history: tuple[EventFact, ...] = ()
    candidates: tuple[CallText, ...] = ()
    chosen: CallText | None = None
    replies: tuple[ReplyFact, ...] = ()
    predictions: Mapping[str, CallText] = {}
    plans: Mapping[str, CallText] = {}
    """What members of the team have planned, by name, in the order of planning."""
    objected: frozenset[CallText] = frozenset()
    """Plans of this robot that members object to."""
    current: CallText | None = None
    current_steps: tuple[str, ...] = ()
    current_arguments: Mapping[str, tuple[str, str]] = {}
    """Name of each parameter of the current sub-task: its kind and its value."""
    asked_category: str | None = None
    """The type of object whose places are asked for, among `receptacle_types` and `room_types`."""
    receptacle_types: tuple[str, ...] = ()
    room_types: tuple[str, ...] = ()
