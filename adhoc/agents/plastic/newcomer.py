"""A newcomer that chooses sub-skills by a network, and watches its teammates."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from adhoc.agents.learned.policy import LearnedPolicy
from adhoc.agents.learned.shipped import Decide
from adhoc.agents.plastic.strangers import Strangers
from adhoc.agents.plastic.watching import Behaviour, Watch
from adhoc.agents.policy import Ask
from adhoc.core.messages import Message
from adhoc.core.values import Capability
from adhoc.perception.perception import PerceptionSettings
from adhoc.tasks.common_sense import CommonSense
from adhoc.tasks.task import Task


class LearnedNewcomer(LearnedPolicy):
    """Acts as a member of a learned team does, but knows its teammates as a newcomer does.

    Perception, judgement, choice and execution are those of `LearnedPolicy`. What a member hears in the
    private talk of its team, this robot takes from public messages and its own eyes. It joins as all
    newcomers do, and says nothing in private.

    Args:
        decide: Chooses the kind of the next sub-skill.
        notice: Is given every observed behaviour of a teammate, before anything is chosen.
        common_sense: Judges; the learned team's if None.
        team_checkpoints: The folder of the learned team's checkpoints; the shipped one if None.
        perception: Settings of its perception.
    """

    def __init__(
        self,
        decide: Decide,
        notice: Callable[[Behaviour], None],
        common_sense: CommonSense | None = None,
        team_checkpoints: str | None = None,
        perception: PerceptionSettings | None = None,
    ) -> None:
        super().__init__(
            decide=decide, common_sense=common_sense, checkpoints=team_checkpoints, perception=perception
        )
        self._notice = notice

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        super().reset(me, capability, task, seed, ask)
        self._watch = Watch(self._memory, self._task)
        self._greeted = False

    def _make_roster(self) -> Strangers:
        self._strangers = Strangers(self._memory, self._task)
        return self._strangers

    def _listen(self, inbox: Sequence[Message]) -> None:
        self._memory.hear(inbox)
        if not self._greeted:
            self._greeted = True
            self._voice.join(self._state())
        robots = self._sighting.robots
        for behaviour in self._watch.observe(self._now.step, robots):
            self._notice(behaviour)
        self._strangers.look(self._now.step, robots)

    def _talks_to_team(self) -> bool:
        return False
