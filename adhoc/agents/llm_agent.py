"""The paper's ad hoc agent: perceive, assess, plan with a language model, act, talk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from adhoc.agents import communication
from adhoc.agents.assessment import assess_action, assess_news, assess_skill
from adhoc.agents.body import Body, SkillOutcome, SkillTable
from adhoc.agents.context import build_context
from adhoc.agents.decision import decision_trace, skill_trace
from adhoc.agents.memory import Memory
from adhoc.agents.news import News, merge_news
from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.agents.voice import Voice
from adhoc.core.calls import Call
from adhoc.core.errors import ReplyError
from adhoc.core.messages import Message
from adhoc.core.plans import Assessment, Context, Replan
from adhoc.core.values import Action, ActionName, Capability, ObjectRecord, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.planning.interfaces import Consultation, Planner, SubSkillPlanner
from adhoc.skills.explore import NOTHING_LEFT
from adhoc.tasks.task import Task

_WAIT = Action(ActionName.ROTATE_RIGHT)
_LOOK_AROUND = (Action(ActionName.LOOK_DOWN), *[_WAIT] * 3)


class LLMAgent(Policy):
    """A robot that joins an unknown team and plans with a language model (paper, section Methodology).

    A robot that joins and sees no floor, facing a wall say, first looks around: it could not plan anything.
    Then it plans on events, not at every step: a sub-task at once, when the current one is over, when
    misplaced objects are found, when a teammate stops, and after `patience` failures in a row; a sub-skill
    when the last one is over or a receptacle for the object at hand is found.

    Args:
        planner: Chooses sub-tasks.
        sub_skill_planner: Chooses sub-skills.
        perception: Settings of the robot's perception.
        skills: Skills by sub-skill name; the paper's seven by default.
        patience: Failed sub-skills in a row before the sub-task is planned again (the paper re-plans after
            a failure and leaves the number open).
        pause: Steps to wait, looking around, when a new plan leads to no action at once, so that a model
            that keeps proposing the impossible is asked at a bounded rate.
        exchanges: Returns the model calls made since it was last asked, for transcripts.
    """

    def __init__(
        self,
        planner: Planner,
        sub_skill_planner: SubSkillPlanner,
        perception: PerceptionSettings | None = None,
        skills: SkillTable | None = None,
        patience: int = 3,
        pause: int = 5,
        exchanges: Callable[[], list[dict[str, Any]]] | None = None,
    ) -> None:
        self._planner = planner
        self._sub_skill_planner = sub_skill_planner
        self._settings = perception
        self._skills = skills
        self._patience = patience
        self._pause = pause
        self._exchanges = exchanges or list

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._capability, self._task = capability, task
        self._memory = Memory(me, task, self._settings)
        self._body = Body(self._memory, capability, self._skills)
        self._voice = Voice(self._memory, capability, ask)
        self._sub_task: Call | None = None
        self._done: list[Call] = []
        self._from_replies: list[News] = []
        self._last: Assessment | None = None
        self._replan = Replan.TASK
        self._reason = "joined the team"
        self._failures = 0
        self._rest_until = -1
        self._looks = 0
        self._joined = self._stopped = False
        self._observation: Observation | None = None
        self._exchanges()

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`: one pass through perception, communication, assessment, planning and execution."""
        self._observation = observation
        self._events: list[str] = []
        self._trace: dict[str, Any] = {}
        _, news = self._memory.observe(observation)
        told = self._memory.hear(inbox)
        self._join()
        self._assess_step(news, told)
        report = self._voice.report(news, self._in_question())
        self._outbox = [] if report is None else [report]
        action = self._decide()
        self._announce()
        self._memory.remember_sent(self._outbox)
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
        if self._now.steps_left == 1 and not self._stopped:
            self._events.append("My battery is empty")
        if self._events:
            text = " ".join(f"{event}." for event in self._events)
            self._outbox.append(communication.task_state_message(text, self._state()))

    # State assessment

    def _assess_step(self, news: News, told: News) -> None:
        """What the last action and the new detections mean for the plan."""
        last = assess_action(self._now)
        if last is not None and not last.ok:
            self._memory.note(last.reason)
        held = self._memory.held
        useful = () if held is None else tuple(it.id for it in self._memory.fitting(news.receptacles, [held]))
        everything = merge_news(news, told, *self._from_replies)
        self._from_replies = []
        names = () if self._sub_task is None else self._sub_task.args
        settled = tuple(name for name in everything.settled if name in names)
        assessment = assess_news(everything, settled, useful)
        if assessment is not None:
            self._take(assessment)
        resting = self._now.step < self._rest_until
        if self._sub_task is not None and not resting and self._is_finished():
            self._take(Assessment(True, f"sub-task {self._sub_task} is finished", Replan.TASK))

    def _take(self, assessment: Assessment) -> None:
        """Remember an assessment and what it asks to plan again."""
        self._memory.note(assessment.reason)
        self._last = assessment
        self._rest_until = -1
        if assessment.replan is Replan.TASK:
            self._replan, self._reason = Replan.TASK, assessment.reason
        if assessment.replan is not Replan.NONE:
            self._body.interrupt()

    def _assess_outcome(self, outcome: SkillOutcome) -> None:
        """What a finished sub-skill means for the plan."""
        self._failures = 0 if outcome.failure is None else self._failures + 1
        if outcome.failure is None:
            self._done.append(outcome.call)
        elif outcome.failure.startswith(NOTHING_LEFT) and self._focus_room() is not None:
            self._memory.perception.tell_explored(str(self._focus_room()), "me")
        assessment = assess_skill(outcome.call, outcome.failure, self._failures, self._patience)
        self._events.append(assessment.reason)
        self._take(assessment)
        if outcome.failure is None and self._sub_task is not None and self._is_finished():
            self._finish_sub_task()
        elif assessment.replan is Replan.TASK:
            self._failures = 0

    def _finish_sub_task(self) -> None:
        """The sub-task is over: whatever it was about needs no attention any more."""
        assert self._sub_task is not None
        text = f"sub-task {self._sub_task} is finished"
        self._events.append(text)
        for record in self._in_question():
            self._memory.settle(record.id)
        self._take(Assessment(True, text, Replan.TASK))

    # Planning

    def _decide(self) -> Action:
        """The action of this step: plan what must be planned, then execute.

        At most one sub-task, and as many sub-skills as failures are borne, are planned in one step; a robot
        that still has no action rests for a while.
        """
        if self._stopped or self._now.steps_left <= 0:
            return self._stop()
        if self._now.step < self._rest_until:
            return _WAIT
        if not self._memory.perception.rooms and self._looks < len(_LOOK_AROUND):
            self._looks += 1
            return _LOOK_AROUND[self._looks - 1]
        planned = False
        for _ in range(self._patience + 1):
            if self._replan is Replan.TASK:
                if planned:
                    break
                self._plan_sub_task()
                planned = True
                if self._is_finished():
                    break
            if self._body.call is None and not self._plan_sub_skill():
                break
            outcome = self._body.act(self._now)
            if isinstance(outcome, Action):
                return self._stop() if outcome.name is ActionName.STOP else outcome
            self._assess_outcome(outcome)
        self._rest_until = self._now.step + self._pause
        return _WAIT

    def _plan_sub_task(self) -> None:
        self._exchanges()  # What was asked meanwhile, such as where things belong, is not of this decision.
        plan = self._planner.plan(self._context(), self._consult)
        self._trace["decision"] = decision_trace(plan, self._reason)
        self._trace["decision"]["exchanges"] = self._exchanges()
        self._sub_task, self._done, self._replan = plan.sub_task, [], Replan.NONE
        self._body.interrupt()
        self._memory.note(f"new sub-task: {plan.sub_task}" + (f" ({plan.fallback})" if plan.fallback else ""))
        self._events.append(f"My sub-task is now: {plan.sub_task}")

    def _plan_sub_skill(self) -> bool:
        """Choose and begin the next sub-skill; False if the model gave none that this robot can do."""
        assert self._sub_task is not None
        self._exchanges()
        try:
            call = self._sub_skill_planner.next_skill(self._context(), self._sub_task, self._last)
        except ReplyError as error:
            return self._refuse_skill(f"the model gave no usable sub-skill: {error}")
        illegal = self._task.legal_skill(call, self._capability)
        if illegal is not None:
            return self._refuse_skill(illegal)
        self._trace.setdefault("skills", []).append(
            {**skill_trace(call, None), "exchanges": self._exchanges()}
        )
        self._body.begin(call, self._now, self._focus_room(), self._others())
        self._events.append(f"My sub-skill is now: {call}")
        return True

    def _refuse_skill(self, reason: str) -> bool:
        self._failures += 1
        replan = Replan.TASK if self._failures >= self._patience else Replan.SKILL
        self._trace.setdefault("skills", []).append({"refused": reason, "exchanges": self._exchanges()})
        self._take(Assessment(False, reason, replan))
        return False

    def _stop(self) -> Action:
        if not self._stopped:
            self._stopped = True
            self._events.append("I stop")
        return Action(ActionName.STOP)

    # Views

    @property
    def _now(self) -> Observation:
        assert self._observation is not None
        return self._observation

    def _context(self) -> Context:
        return build_context(
            self._memory, self._task, self._capability, self._now, self._sub_task, tuple(self._done)
        )

    def _is_finished(self) -> bool:
        assert self._sub_task is not None
        return self._task.finished(self._sub_task, self._done, self._memory.perception.rooms)

    def _in_question(self) -> list[ObjectRecord]:
        """The objects that the current sub-task names."""
        names = () if self._sub_task is None else self._sub_task.args
        known = (self._memory.record(name) for name in names if isinstance(name, str))
        return [record for record in known if record is not None]

    def _focus_room(self) -> str | None:
        names = () if self._sub_task is None else self._sub_task.args
        rooms = self._memory.perception.rooms
        return next((name for name in names if isinstance(name, str) and name in rooms), None)

    def _others(self) -> tuple[tuple[float, float], ...]:
        views = self._memory.teammates.values()
        return tuple(view.position for view in views if view.position is not None and not view.stopped)

    def _state(self) -> dict[str, Any]:
        return self._voice.state(
            self._now, self._sub_task, self._body.call, self._stopped or self._now.steps_left <= 1
        )
