"""A member of the paper's LLM-based teams, which agree on their sub-tasks before they act."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from adhoc.agents import communication
from adhoc.agents.body import Body, SkillTable
from adhoc.agents.conduct import WAIT, Conduct
from adhoc.agents.context import build_context
from adhoc.agents.crew import Crew, plan_message, read_objection
from adhoc.agents.decision import doing_trace, negotiation_trace
from adhoc.agents.memory import Memory
from adhoc.agents.negotiation import Negotiation
from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.agents.progress import Progress
from adhoc.agents.voice import Voice
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Assessment, Context, Objection, Replan
from adhoc.core.values import Action, Capability, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.planning.interfaces import Negotiator, SubSkillPlanner
from adhoc.tasks.task import Task


class LLMTeammate(Policy):
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
        self._negotiator, self._sub_skill_planner = negotiator, sub_skill_planner
        self._settings, self._skills = perception, skills
        self._adaptive, self._rounds = adaptive, rounds
        self._patience, self._pause = patience, pause
        self._exchanges = exchanges or (lambda name: [])

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._me, self._capability, self._task = me, capability, task
        self._memory = Memory(me, task, self._settings)
        self._body = Body(self._memory, capability, self._skills)
        self._voice = Voice(self._memory, capability, ask)
        self._crew = Crew()
        self._negotiation = Negotiation(self._negotiator, self._crew, ask, self._rounds)
        self._progress = Progress(self._memory, self._body, task, self._patience, "the task begins")
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
        self._joined: dict[str, str] = {}
        self._broken: dict[str, str] = {}
        self._replanned = -1
        self._objections: list[Objection] = []
        self._trace: dict[str, Any] = {}
        self._outbox: list[Message] = []
        self._has_begun = False
        self._observation: Observation | None = None
        self._taken()

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
        report = self._voice.report(news, self._progress.in_question())
        self._outbox = [] if report is None else [report]
        objections = self._standing_objections()
        if self._has_begun and (objections or self._needs_sub_task()):
            self._plan(objections)
            self._negotiation.announce(self._progress.sub_task)

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`: execute, and tell what has happened."""
        action = self._conduct.act(observation, self._context) if self._has_begun else self._begin()
        if self._conduct.skills:
            self._trace["skills"] = self._conduct.skills
        self._announce()
        self._memory.remember_sent(self._outbox)
        self._trace["doing"] = doing_trace(self._progress.sub_task, self._body.call)
        trace, self._trace = self._trace, {}
        return Turn(action, tuple(self._outbox), trace)

    def respond(self, message: Message) -> Message | None:
        """See `Policy`. A member that objects to this robot's plan has it planned again."""
        if self._observation is None:
            return None
        objection = read_objection(message)
        if objection is not None:
            return self._reconsider(objection, message.step)
        self._crew.hear(message, self._now.step)
        answer = self._voice.answer(message, self._state())
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

    def _announce(self) -> None:
        """What began or ended, to everybody; the plan and that this robot works, to the team."""
        events = self._progress.events
        if self._now.steps_left == 1 and not self._conduct.stopped:
            events.append("My battery is empty")
        if events:
            text = " ".join(f"{event}." for event in events)
            self._outbox.append(communication.task_state_message(text, self._state()))
        self._outbox.append(plan_message(self._progress.sub_task, self._is_out_of_order()))

    # Views

    @property
    def _now(self) -> Observation:
        assert self._observation is not None
        return self._observation

    def _needs_sub_task(self) -> bool:
        able = not self._conduct.stopped and self._now.steps_left > 0
        waits = self._now.step < self._progress.rest_until or self._conduct.looks_around
        return able and not waits and self._progress.replan is Replan.TASK

    def _is_out_of_order(self) -> bool:
        return self._conduct.stopped or self._now.steps_left <= 1

    def _taken(self) -> list[dict[str, Any]]:
        return self._exchanges(self._me)

    def _context(self) -> Context:
        progress = self._progress
        return build_context(
            self._memory, self._task, self._capability, self._now, progress.sub_task, tuple(progress.done)
        )

    def _state(self) -> dict[str, Any]:
        return self._voice.state(self._now, self._progress.sub_task, self._body.call, self._is_out_of_order())
