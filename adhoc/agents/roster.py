"""A heuristic team's talk among its own members: where they are, what they cover, who is busy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from adhoc.agents.assignment import Worker
from adhoc.agents.communication import read_capability, read_numbers
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Capability


@dataclass(frozen=True)
class MemberState:
    """What a member says of itself at every step."""

    name: str
    position: tuple[float, float]
    capability: Capability
    busy: str | None = None
    """Id of the object that it is re-placing."""
    idle: bool = False
    """Whether it has nothing left to explore."""
    stopped: bool = False
    unable: tuple[str, ...] = ()
    """Objects that it tried in vain."""
    gone: tuple[str, ...] = ()
    """Objects that were not where they were believed to be, found out at this step."""
    covered: tuple[tuple[int, int], ...] = ()
    """One-metre cells that it inspected since the last step."""

    def message(self) -> Message:
        """The state as the team's private message; to strangers it is noise."""
        payload: dict[str, Any] = {**vars(self), "capability": dict(vars(self.capability))}
        return Message(MessageKind.TEAM, "", payload)

    def worker(self) -> Worker:
        """The member as the assignment rule sees it."""
        free = self.busy is None and not self.stopped
        return Worker(self.name, self.position, self.capability, free, frozenset(self.unable))


class Roster:
    """The latest state of every other member of the team, from the team's own messages.

    Members speak at every step; one that was silent for `patience` steps is out of order.
    """

    def __init__(self, patience: int = 5) -> None:
        self.members: dict[str, MemberState] = {}
        self._patience = patience
        self._heard: dict[str, int] = {}

    def hear(self, step: int, inbox: Sequence[Message]) -> tuple[MemberState, ...]:
        """Take in the team's messages of the step before `step`; the states that were heard now."""
        read = (_read(message) for message in inbox if message.kind is MessageKind.TEAM)
        heard = tuple(state for state in read if state is not None)
        for state in heard:
            self.members[state.name], self._heard[state.name] = state, step
        for name, last in self._heard.items():
            if last < step - self._patience:
                self.members[name] = replace(self.members[name], stopped=True)
        return heard

    def handled(self) -> Iterable[str]:
        """Ids of the objects that members are re-placing."""
        return (state.busy for state in self.members.values() if state.busy is not None and not state.stopped)

    def all_idle(self) -> bool:
        """Whether nobody else is exploring or re-placing any more."""
        return all(state.stopped or (state.idle and state.busy is None) for state in self.members.values())

    def positions(self) -> tuple[tuple[float, float], ...]:
        """Where the others are."""
        return tuple(state.position for state in self.members.values() if not state.stopped)


def _read(message: Message) -> MemberState | None:
    """The state that `MemberState.message` wrote; None for a stranger's noise of the same kind."""
    payload = message.payload
    position, capability = read_numbers(payload.get("position"), 2), payload.get("capability")
    busy, idle, stopped = payload.get("busy"), payload.get("idle"), payload.get("stopped")
    unable, gone, covered = (_list(payload.get(field)) for field in ("unable", "gone", "covered"))
    if payload.keys() != MemberState.__dataclass_fields__.keys() or position is None:
        return None
    if not isinstance(capability, Mapping) or not isinstance(busy, (str, type(None))):
        return None
    return MemberState(
        message.sender,
        (position[0], position[1]),
        read_capability(capability, Capability()),
        busy,
        idle is True,
        stopped is True,
        tuple(it for it in unable if isinstance(it, str)),
        tuple(it for it in gone if isinstance(it, str)),
        tuple((int(cell[0]), int(cell[1])) for it in covered if (cell := read_numbers(it, 2)) is not None),
    )


def _list(value: Any) -> Sequence[Any]:
    return value if isinstance(value, (list, tuple)) else ()
