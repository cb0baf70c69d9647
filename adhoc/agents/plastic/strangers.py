"""The teammates as a newcomer knows them, in the form in which a member knows its team."""

from __future__ import annotations

from collections.abc import Mapping

from adhoc.agents.memory import Memory
from adhoc.agents.plastic.deeds import attended
from adhoc.agents.roster import MemberState, Roster
from adhoc.core.messages import TeammateView
from adhoc.core.values import Capability
from adhoc.tasks.task import Task


class Strangers(Roster):
    """A roster filled from public messages and own eyes; the team's private talk is not listened to.

    A teammate whose place was neither told nor seen is left out. One that never said what it can is taken to
    be able. Whether it has nothing left to explore is not known; it is taken to go on.

    Args:
        memory: What the newcomer knows.
        task: Says what is work on objects.
    """

    def __init__(self, memory: Memory, task: Task) -> None:
        super().__init__()
        self._memory, self._task = memory, task
        self._seen: dict[str, tuple[int, tuple[float, float]]] = {}

    def look(self, step: int, robots: Mapping[str, tuple[float, float]]) -> None:
        """Bring all up to date with what was heard, and with the robots in view at a step."""
        self._seen.update((name, (step, place)) for name, place in robots.items())
        names = {*self._memory.teammates, *self._seen}
        states = (self._state(name) for name in sorted(names))
        self.members = {state.name: state for state in states if state is not None}

    def _state(self, name: str) -> MemberState | None:
        view = self._memory.teammates.get(name) or TeammateView(name)
        step, place = self._seen.get(name, (-1, None))
        if place is None or (view.position is not None and view.last_heard > step):
            place = view.position
        if place is None:
            return None
        busy = attended(view, self._task)
        return MemberState(
            name,
            place,
            view.capability or Capability(),
            busy if busy is not None and self._memory.claimed(busy) == name else None,
            stopped=view.stopped,
        )
