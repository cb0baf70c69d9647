"""The paper's ad hoc agent: perceive, assess, plan with a language model, act, talk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from adhoc.agents.body import SkillTable
from adhoc.agents.decision import decision_trace
from adhoc.agents.llm_robot import LLMRobot
from adhoc.agents.news import News
from adhoc.agents.policy import Ask, Turn
from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.values import Capability, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.planning.interfaces import Consultation, Planner, SubSkillPlanner
from adhoc.tasks.task import Task


class LLMAgent(LLMRobot):
    """A robot that joins an unknown team and plans with a language model (paper, section Methodology).

    It plans on events, not at every step (see `Progress`).

    Args:
        planner: Chooses sub-tasks.
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
        planner: Planner,
        sub_skill_planner: SubSkillPlanner,
        perception: PerceptionSettings | None = None,
        skills: SkillTable | None = None,
        patience: int = 3,
        pause: int = 5,
        exchanges: Callable[[str], list[dict[str, Any]]] | None = None,
    ) -> None:
        super().__init__(sub_skill_planner, perception, skills, patience, pause, exchanges)
        self._planner = planner

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._begin_episode(me, capability, task, ask, "joined the team")
        self._from_replies: list[News] = []
        self._joined = False

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`: one pass through perception, communication, assessment, planning and execution."""
        self._observation = observation
        self._progress.begin_step()
        self._conduct.begin_step()
        _, news = self._memory.observe(observation)
        told = self._memory.hear(inbox)
        self._join()
        self._progress.assess(observation, news, (told, *self._from_replies))
        self._from_replies = []
        self._report(self._voice.report(news, self._progress.in_question()))
        action = self._conduct.act(observation, self._context, self._plan_sub_task)
        self._tell_events(self._progress.events)
        return self._end_step(action)

    # Communication

    def _join(self) -> None:
        """Broadcast state and capability once, and take in the reflected messages."""
        if not self._joined:
            self._joined = True
            self._voice.join(self._state())

    def _consult(self, sub_task: Call) -> Consultation:
        """Share an intention. What the replies teach is known at once, and assessed at the next step."""
        replies, news = self._voice.consult(sub_task)
        self._from_replies.append(news)
        return Consultation(replies, self._context())

    # Planning

    def _plan_sub_task(self) -> None:
        self._taken()  # What was asked meanwhile, such as where things belong, is not of this decision.
        plan = self._planner.plan(self._context(), self._consult)
        self._trace["decision"] = decision_trace(plan, self._progress.reason)
        self._trace["decision"]["exchanges"] = self._taken()
        self._progress.begin(self._now.step, plan.sub_task, plan.fallback)
