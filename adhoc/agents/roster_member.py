"""A robot whose team shares, step by step, where its members are and what they are at."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence

from adhoc.agents.attempts import Attempts
from adhoc.agents.body import SkillTable
from adhoc.agents.policy import Ask
from adhoc.agents.roster import MemberState, Roster
from adhoc.agents.talking import TalkingPolicy
from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.values import Action, ActionName, Capability
from adhoc.perception.perception import PerceptionSettings
from adhoc.tasks.task import Task


class RosterMember(TalkingPolicy):
    """Knows its team by a `Roster`, leaves alone for a while what it tried in vain, and tells both.

    Args:
        perception: Settings of its perception.
        skills: Skills by sub-skill name; the paper's by default.
        attempts: How often an object is tried; then it is left to others.
        retry_after: Steps before an object is tried again: more is known of the house by then.
    """

    def __init__(
        self,
        perception: PerceptionSettings | None,
        skills: SkillTable | None,
        attempts: int,
        retry_after: int,
    ) -> None:
        super().__init__(perception, skills)
        self._most_attempts, self._retry_after = attempts, retry_after

    def _wake(self, me: str, capability: Capability, task: Task, ask: Ask) -> None:
        super()._wake(me, capability, task, ask)
        self._roster = self._make_roster()
        self._attempts = Attempts(self._most_attempts, self._retry_after)
        self._sub_task: Call | None = None
        self._stopped = False

    def _make_roster(self) -> Roster:
        """What the robot knows the others by; its memory is there already."""
        return Roster()

    @abstractmethod
    def _busy_with(self) -> str | None:
        """Id of the object that it deals with."""

    @abstractmethod
    def _is_idle(self) -> bool:
        """Whether it has nothing left to explore."""

    @abstractmethod
    def _take_gone(self) -> list[str]:
        """Objects that were not where they were believed to be, since it was last asked."""

    @abstractmethod
    def _current_sub_task(self) -> Call | None:
        """What it is at."""

    def _unable_now(self) -> frozenset[str]:
        """Objects that it leaves alone for now."""
        return self._attempts.pending(self._now.step)

    def _listen(self, inbox: Sequence[Message]) -> None:
        self._memory.hear(inbox)
        for state in self._roster.hear(self._now.step, inbox):
            self._memory.perception.tell_covered(state.covered)
            for object_id in state.gone:
                self._memory.lose(object_id)

    def _announce(self) -> None:
        """Tell everybody when the sub-task changed, and the own team where this robot is and what it does."""
        over = self._out_of_order()
        sub_task = None if over else self._current_sub_task()
        if sub_task != self._sub_task:
            self._sub_task = sub_task
            self._tell(["I stop" if over else f"My sub-task is now: {sub_task}"])
        if self._talks_to_team():
            self._outbox.append(self._member_state().message())

    def _talks_to_team(self) -> bool:
        """Whether there is a team that understands it."""
        return True

    def _member_state(self) -> MemberState:
        return MemberState(
            self._me,
            self._position,
            self._capability,
            self._busy_with(),
            self._is_idle(),
            self._out_of_order(),
            tuple(sorted(self._unable_now())),
            tuple(self._take_gone()),
            self._memory.perception.take_covered(),
        )

    def _stop(self) -> Action:
        self._stopped = True
        return Action(ActionName.STOP)

    def _has_stopped(self) -> bool:
        return self._stopped

    def _doing(self) -> tuple[Call | None, Call | None]:
        return self._sub_task, self._body.call
