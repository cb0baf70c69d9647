"""How a robot gets on with its sub-task (paper, section State Assessment): the state between two plans."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.agents.assessment import assess_action, assess_news, assess_skill
from adhoc.agents.body import Body, SkillOutcome
from adhoc.agents.memory import Memory
from adhoc.agents.news import News, merge_news
from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError
from adhoc.core.plans import Assessment, Replan
from adhoc.core.values import ObjectRecord, Observation
from adhoc.skills.explore import NOTHING_LEFT
from adhoc.tasks.task import Task


class Progress:
    """What has been done of the current sub-task, what went wrong, and what must be planned again.

    A sub-task is to be planned when there is none, when the current one is over, when misplaced objects are
    found, when a teammate stops, and after `patience` failures in a row; a sub-skill when the last one is
    over or a receptacle for the object at hand is found.

    Args:
        memory: What the robot knows; assessments are noted there.
        body: Its sub-skill in progress is dropped when something must be planned again.
        task: Says when a sub-task is finished.
        patience: Failed sub-skills in a row before the sub-task is planned again (the paper re-plans after
            a failure and leaves the number open).
        reason: Why the first sub-task is planned.

    Raises:
        ConfigurationError: patience is below 1.
    """

    def __init__(self, memory: Memory, body: Body, task: Task, patience: int, reason: str) -> None:
        if patience < 1:
            raise ConfigurationError(f"patience={patience} must be at least 1")
        self._memory, self._body, self._task, self._patience = memory, body, task, patience
        self._failures = 0
        self.sub_task: Call | None = None
        self.done: list[Call] = []
        """Sub-skills that succeeded since the sub-task began."""
        self.last: Assessment | None = None
        """The latest assessment."""
        self.replan = Replan.TASK
        self.reason = reason
        """Why a sub-task must be planned."""
        self._given_up = False
        self.begun_at = -1
        """The step in which the sub-task was chosen."""
        self.rest_until = -1
        """The step until which the robot rests, unless something happens."""
        self.events: list[str] = []
        """What began or ended in this step, for the robot's messages."""

    def begin_step(self) -> None:
        """Forget what began or ended in the step before."""
        self.events = []

    def assess(self, now: Observation, news: News, others_news: Sequence[News]) -> None:
        """What the last action, the own detections and those of others mean for the plan."""
        last = assess_action(now)
        if last is not None and not last.ok:
            self._memory.note(last.reason)
        held = self._memory.held
        useful = () if held is None else tuple(it.id for it in self._memory.fitting(news.receptacles, [held]))
        everything = merge_news(news, *others_news)
        names = () if self.sub_task is None else self.sub_task.args
        settled = tuple(name for name in everything.settled if name in names)
        assessment = assess_news(everything, settled, useful)
        if assessment is not None:
            self.take(assessment)
        if self.sub_task is not None and now.step >= self.rest_until and self.is_finished():
            self.take(Assessment(True, f"sub-task {self.sub_task} is finished", Replan.TASK))

    def take(self, assessment: Assessment) -> None:
        """Remember an assessment and what it asks to plan again."""
        self._memory.note(assessment.reason)
        self.last = assessment
        self.rest_until = -1
        if assessment.replan is Replan.TASK:
            self.replan, self.reason = Replan.TASK, assessment.reason
        if assessment.replan is not Replan.NONE:
            self._body.interrupt()

    def begin(self, step: int, sub_task: Call, fallback: str | None) -> None:
        """Go on with this sub-task; `fallback` says why it is the safe choice, if it is."""
        self.begun_at, self._given_up = step, False
        self.sub_task, self.done, self.replan = sub_task, [], Replan.NONE
        self._body.interrupt()
        self._memory.note(f"new sub-task: {sub_task}" + (f" ({fallback})" if fallback else ""))
        self.events.append(f"My sub-task is now: {sub_task}")

    def end_skill(self, outcome: SkillOutcome) -> None:
        """What a finished sub-skill means for the plan."""
        focus = self.focus_room()
        self._failures = 0 if outcome.failure is None else self._failures + 1
        if outcome.failure is None:
            self.done.append(outcome.call)
        elif outcome.failure.startswith(NOTHING_LEFT) and focus is not None:
            self._memory.perception.tell_explored(focus, "me")
        assessment = assess_skill(outcome.call, outcome.failure, self._failures, self._patience)
        self.events.append(assessment.reason)
        self.take(assessment)
        if outcome.failure is None and self.sub_task is not None and self.is_finished():
            self._finish()
        elif assessment.replan is Replan.TASK:
            self._failures, self._given_up = 0, True

    def refuse_skill(self, reason: str) -> None:
        """No sub-skill was chosen that the robot could begin."""
        self._failures += 1
        self._given_up = self._given_up or self._failures >= self._patience
        self.take(Assessment(False, reason, Replan.TASK if self._given_up else Replan.SKILL))

    def worth_keeping(self) -> Call | None:
        """The sub-task, if it is neither over nor given up after failures."""
        if self.sub_task is None or self._given_up or self.is_finished():
            return None
        return self.sub_task

    def is_finished(self) -> bool:
        """Whether the task says that the sub-task is over."""
        assert self.sub_task is not None
        return self._task.finished(self.sub_task, self.done, self._memory.perception.rooms)

    def in_question(self) -> list[ObjectRecord]:
        """The objects that the sub-task names."""
        names = () if self.sub_task is None else self.sub_task.args
        known = (self._memory.record(name) for name in names if isinstance(name, str))
        return [record for record in known if record is not None]

    def focus_room(self) -> str | None:
        """The room that the sub-task names."""
        names = () if self.sub_task is None else self.sub_task.args
        rooms = self._memory.perception.rooms
        return next((name for name in names if isinstance(name, str) and name in rooms), None)

    def _finish(self) -> None:
        """The sub-task is over: whatever it was about needs no attention any more."""
        text = f"sub-task {self.sub_task} is finished"
        self.events.append(text)
        for record in self.in_question():
            self._memory.settle(record.id)
        self.take(Assessment(True, text, Replan.TASK))
