"""The paper's ad hoc agent: perceive, assess, plan with a language model, act, talk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from adhoc.agents import communication
from adhoc.agents.body import Body, SkillTable
from adhoc.agents.conduct import Conduct
from adhoc.agents.context import build_context
from adhoc.agents.decision import decision_trace, doing_trace
from adhoc.agents.memory import Memory
from adhoc.agents.news import News
from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.agents.progress import Progress
from adhoc.agents.voice import Voice
from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.plans import Context
from adhoc.core.values import Capability, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.planning.interfaces import Consultation, Planner, SubSkillPlanner
from adhoc.tasks.task import Task


class LLMAgent(Policy):
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
        self._planner = planner
        self._sub_skill_planner = sub_skill_planner
        self._settings = perception
        self._skills = skills
        self._patience = patience
        self._pause = pause
        self._exchanges = exchanges or (lambda name: [])

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._me, self._capability, self._task = me, capability, task
        self._memory = Memory(me, task, self._settings)
        self._body = Body(self._memory, capability, self._skills)
        self._voice = Voice(self._memory, capability, ask)
        self._progress = Progress(self._memory, self._body, task, self._patience, "joined the team")
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
        self._from_replies: list[News] = []
        self._joined = False
        self._observation: Observation | None = None
        self._taken()

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`: one pass through perception, communication, assessment, planning and execution."""
        self._observation = observation
        self._trace: dict[str, Any] = {}
        self._progress.begin_step()
        self._conduct.begin_step()
        _, news = self._memory.observe(observation)
        told = self._memory.hear(inbox)
        self._join()
        self._progress.assess(observation, news, (told, *self._from_replies))
        self._from_replies = []
        report = self._voice.report(news, self._progress.in_question())
        self._outbox = [] if report is None else [report]
        action = self._conduct.act(observation, self._context, self._plan_sub_task)
        if self._conduct.skills:
            self._trace["skills"] = self._conduct.skills
        self._announce()
        self._memory.remember_sent(self._outbox)
        self._trace["doing"] = doing_trace(self._progress.sub_task, self._body.call)
        return Turn(action, tuple(self._outbox), self._trace)

    def respond(self, message: Message) -> Message | None:
        """See `Policy`."""
        return None if self._observation is None else self._voice.answer(message, self._state())

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

    def _announce(self) -> None:
        """The task-relevant state, whenever a sub-task or a sub-skill began or ended."""
        events = self._progress.events
        if self._now.steps_left == 1 and not self._conduct.stopped:
            events.append("My battery is empty")
        if events:
            text = " ".join(f"{event}." for event in events)
            self._outbox.append(communication.task_state_message(text, self._state()))

    # Planning

    def _plan_sub_task(self) -> None:
        self._taken()  # What was asked meanwhile, such as where things belong, is not of this decision.
        plan = self._planner.plan(self._context(), self._consult)
        self._trace["decision"] = decision_trace(plan, self._progress.reason)
        self._trace["decision"]["exchanges"] = self._taken()
        self._progress.begin(self._now.step, plan.sub_task, plan.fallback)

    # Views

    @property
    def _now(self) -> Observation:
        assert self._observation is not None
        return self._observation

    def _taken(self) -> list[dict[str, Any]]:
        return self._exchanges(self._me)

    def _context(self) -> Context:
        progress = self._progress
        return build_context(
            self._memory, self._task, self._capability, self._now, progress.sub_task, tuple(progress.done)
        )

    def _state(self) -> dict[str, Any]:
        stopped = self._conduct.stopped or self._now.steps_left <= 1
        return self._voice.state(self._now, self._progress.sub_task, self._body.call, stopped)
