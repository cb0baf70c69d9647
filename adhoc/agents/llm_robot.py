"""What all robots that plan with a language model have in common."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from adhoc.agents.body import SkillTable
from adhoc.agents.conduct import Conduct
from adhoc.agents.context import build_context
from adhoc.agents.decision import doing_trace
from adhoc.agents.policy import Ask, Turn
from adhoc.agents.progress import Progress
from adhoc.agents.talking import TalkingPolicy
from adhoc.core.calls import Call
from adhoc.core.plans import Context
from adhoc.core.values import Action, Capability
from adhoc.perception.perception import PerceptionSettings
from adhoc.planning.interfaces import SubSkillPlanner
from adhoc.tasks.task import Task


class LLMRobot(TalkingPolicy):
    """Has a sub-task and what becomes of it (`Progress`), and a way from it to actions (`Conduct`).

    Args:
        sub_skill_planner: Chooses sub-skills.
        perception: Settings of the robot's perception.
        skills: Skills by sub-skill name; the paper's seven by default.
        patience: See `Progress`.
        pause: See `Conduct`.
        exchanges: Returns the model calls that the robot of a name made since it was last asked for them,
            for transcripts.
    """

    def __init__(
        self,
        sub_skill_planner: SubSkillPlanner,
        perception: PerceptionSettings | None,
        skills: SkillTable | None,
        patience: int,
        pause: int,
        exchanges: Callable[[str], list[dict[str, Any]]] | None,
    ) -> None:
        super().__init__(perception, skills)
        self._sub_skill_planner = sub_skill_planner
        self._patience, self._pause = patience, pause
        self._exchanges = exchanges or (lambda name: [])

    def _begin_episode(self, me: str, capability: Capability, task: Task, ask: Ask, reason: str) -> None:
        """Begin without a sub-task; `reason` says why the first is planned."""
        self._wake(me, capability, task, ask)
        self._progress = Progress(self._memory, self._body, task, self._patience, reason)
        self._conduct = Conduct(
            self._memory,
            self._body,
            self._progress,
            task,
            capability,
            self._sub_skill_planner,
            self._patience,
            self._pause,
            self._taken,
        )
        self._trace: dict[str, Any] = {}
        self._taken()

    def _has_stopped(self) -> bool:
        return self._conduct.stopped

    def _doing(self) -> tuple[Call | None, Call | None]:
        return self._progress.sub_task, self._body.call

    def _context(self) -> Context:
        progress = self._progress
        return build_context(
            self._memory, self._task, self._capability, self._now, progress.sub_task, tuple(progress.done)
        )

    def _taken(self) -> list[dict[str, Any]]:
        return self._exchanges(self._me)

    def _end_step(self, action: Action) -> Turn:
        """The step's turn, with the trace of what was decided in it."""
        trace, self._trace = self._trace, {}
        if self._conduct.skills:
            trace["skills"] = self._conduct.skills
        return self._turn(action, {**trace, "doing": doing_trace(*self._doing())})
