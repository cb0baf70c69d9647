"""A member of the paper's LLM-based teams, which agree on their sub-tasks before they act."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from adhoc.agents.body import SkillTable
from adhoc.agents.conduct import WAIT
from adhoc.agents.crew import Crew, plan_message, read_objection
from adhoc.agents.decision import negotiation_trace
from adhoc.agents.llm_robot import LLMRobot
from adhoc.agents.negotiation import Negotiation
from adhoc.agents.policy import Ask, Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Assessment, Objection, Replan
from adhoc.core.values import Action, Capability, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.planning.interfaces import Negotiator, SubSkillPlanner
from adhoc.tasks.task import Task


class LLMTeammate(LLMRobot):
    """A teammate that plans with a language model (paper, appendix 'Teammates with the LLM').

    It tells its abilities in the first step. From then on whoever needs a sub-task plans in its turn, when
    all robots confer: it says whether it agrees with the plans made before, and if not, those whose plans it
    objects to plan again before it does (see `Negotiation`). Then all act, side by side: sub-skills are
    chosen by the language model, and their questions go out together. Findings and changes of state are told
    to everybody.

    Args:
        negotiator: Chooses sub-tasks.
        sub_skill_planner: Chooses sub-skills.
        perception: Settings of the robot's perception.
        skills: Skills by sub-skill name; the paper's seven by default.
        adaptive: Whether the team adapts to a newcomer: it plans again when a robot joins or a member breaks
            down, and prompts say so (the paper's adaptive prompts). Without, it takes a newcomer's messages
            in as anybody's.
        rounds: How often a robot may object before it plans; the paper leaves it open. Each member plans
            again at most once a step, whoever objects.
        patience: See `Progress`.
        pause: See `Conduct`.
        exchanges: See `LLMAgent`.
    """

    acts_apart = True

    def __init__(
        self,
        negotiator: Negotiator,
        sub_skill_planner: SubSkillPlanner,
        perception: PerceptionSettings | None = None,
        skills: SkillTable | None = None,
        adaptive: bool = True,
        rounds: int = 1,
        patience: int = 3,
        pause: int = 5,
        exchanges: Callable[[str], list[dict[str, Any]]] | None = None,
    ) -> None:
        super().__init__(sub_skill_planner, perception, skills, patience, pause, exchanges)
        self._negotiator, self._adaptive, self._rounds = negotiator, adaptive, rounds

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._begin_episode(me, capability, task, ask, "the task begins")
        self._crew = Crew()
        self._negotiation = Negotiation(self._negotiator, self._crew, ask, self._rounds)
        self._joined: dict[str, str] = {}
        self._broken: dict[str, str] = {}
        self._replanned = -1
        self._objections: list[Objection] = []
        self._has_begun = False

    def confer(self, observation: Observation, inbox: Sequence[Message]) -> None:
        """See `Policy`: perceive, assess, and plan a sub-task with the others if one is needed."""
        self._observation = observation
        self._progress.begin_step()
        self._conduct.begin_step()
        _, news = self._memory.observe(observation)
        told = self._memory.hear(inbox)
        self._crew.hear_all(inbox, observation.step)
        self._progress.assess(observation, news, (told,))
        self._notice_broken()
        self._report(self._voice.report(news, self._progress.in_question()))
        objections = self._standing_objections()
        if self._has_begun and (objections or self._needs_sub_task()):
            self._plan(objections)
            self._negotiation.announce(self._progress.sub_task)

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`: execute, and tell what has happened."""
        action = self._conduct.act(observation, self._context) if self._has_begun else self._begin()
        self._tell_events(self._progress.events)
        self._outbox.append(plan_message(self._progress.sub_task, self._out_of_order()))
        return self._end_step(action)

    def respond(self, message: Message) -> Message | None:
        """See `Policy`. A member that objects to this robot's plan has it planned again."""
        if self._observation is None:
            return None
        objection = read_objection(message)
        if objection is not None:
            return self._reconsider(objection, message.step)
        self._crew.hear(message, self._now.step)
        answer = super().respond(message)
        if message.kind is MessageKind.JOIN and not self._crew.is_member(message.sender):
            self._adapt(self._joined, message.sender, f"has joined the team at step {message.step}")
        return answer

    # The team

    def _begin(self) -> Action:
        """The first step: look around, and tell what this robot can do."""
        self._has_begun = True
        self._progress.events.append("I am ready")
        return WAIT

    def _plan(self, objections: Sequence[Objection] = ()) -> None:
        """Agree on a sub-task; `objections` are what members have against the one there is."""
        self._taken()  # What was asked meanwhile, such as where things belong, is not of this decision.
        changes = (*self._joined.values(), *self._broken.values())
        keeps = None if objections else self._progress.worth_keeping()
        plan, raised = self._negotiation.agree(self._context, objections, changes, keeps)
        reason = self._progress.reason if not objections else f"{objections[0].objector} objected"
        if "decision" in self._trace:
            self._trace.setdefault("superseded", []).append(self._trace["decision"])
        self._trace["decision"] = negotiation_trace(plan, raised, objections, reason)
        self._trace["decision"]["exchanges"] = self._taken()
        self._progress.begin(self._now.step, plan.sub_task, plan.fallback)

    def _reconsider(self, objection: Objection, step: int) -> Message | None:
        """Plan again, once a step at most, and answer with the plan; a robot whose turn in this step is still
        to come does it then, if the plan still stands."""
        if not self._crew.is_member(objection.objector):
            return None
        able = not self._conduct.stopped and self._now.steps_left > 1
        if able and self._replanned < step and self._is_about(objection):
            self._replanned = step
            if self._now.step < step:
                self._objections.append(objection)
            else:
                self._plan((objection,))
        return plan_message(self._progress.sub_task, not able)

    def _is_about(self, objection: Objection) -> bool:
        sub_task = self._progress.sub_task
        return sub_task is not None and sub_task == objection.sub_task

    def _standing_objections(self) -> tuple[Objection, ...]:
        """Those that were raised before this robot's turn, to a plan that it would go on with."""
        raised, self._objections = self._objections, []
        goes_on = self._progress.replan is not Replan.TASK and self._progress.worth_keeping() is not None
        return tuple(it for it in raised if goes_on and self._is_about(it))

    def _notice_broken(self) -> None:
        silent = self._crew.broken(self._now.step)
        self._broken = {name: change for name, change in self._broken.items() if name in silent}
        for name in silent:
            self._adapt(
                self._broken, name, f"is broken: it has been silent since step {self._crew.heard(name)}"
            )

    def _adapt(self, changes: dict[str, str], name: str, change: str) -> None:
        """Take a change in the team into account, if this team does, from now on."""
        if self._adaptive and name not in changes:
            changes[name] = f"{name} {change}"
            self._progress.take(Assessment(True, changes[name], Replan.TASK))

    def _needs_sub_task(self) -> bool:
        able = not self._conduct.stopped and self._now.steps_left > 0
        waits = self._now.step < self._progress.rest_until or self._conduct.looks_around
        return able and not waits and self._progress.replan is Replan.TASK
