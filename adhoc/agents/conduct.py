"""From a sub-task to the action of a step: choose sub-skills, execute them, assess what came of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from adhoc.agents.body import Body
from adhoc.agents.decision import skill_trace
from adhoc.agents.memory import Memory
from adhoc.agents.progress import Progress
from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.plans import Context, Replan
from adhoc.core.values import Action, ActionName, Capability, Observation
from adhoc.planning.interfaces import SubSkillPlanner
from adhoc.tasks.task import Task

WAIT = Action(ActionName.ROTATE_RIGHT)
_LOOK_AROUND = (Action(ActionName.LOOK_DOWN), *[WAIT] * 3)


class Conduct:
    """A robot's way from its sub-task to its actions.

    A robot that sees no floor at first, facing a wall say, looks around before anything is planned: it could
    not plan anything.

    Args:
        memory: What the robot knows.
        body: Executes sub-skills.
        progress: Its sub-task, and what becomes of it.
        task: Says which sub-skills the robot may begin.
        capability: What it can do.
        planner: Chooses sub-skills.
        patience: As many sub-skills as failures are borne are planned in one step.
        pause: Steps to wait, looking around, when a new plan leads to no action at once, so that a model
            that keeps proposing the impossible is asked at a bounded rate.
        exchanges: Takes the model calls since it was last asked, for transcripts.

    Raises:
        ConfigurationError: pause is negative.
    """

    def __init__(
        self,
        memory: Memory,
        body: Body,
        progress: Progress,
        task: Task,
        capability: Capability,
        planner: SubSkillPlanner,
        patience: int,
        pause: int,
        exchanges: Callable[[], list[dict[str, Any]]],
    ) -> None:
        if pause < 0:
            raise ConfigurationError(f"pause={pause} must not be negative")
        self._memory, self._body, self._progress = memory, body, progress
        self._task, self._capability, self._planner = task, capability, planner
        self._patience, self._pause, self._exchanges = patience, pause, exchanges
        self._looks = 0
        self.stopped = False
        self.skills: list[dict[str, Any]] = []
        """The sub-skill decisions of this step, for transcripts."""

    def begin_step(self) -> None:
        """Forget the decisions of the step before."""
        self.skills = []

    @property
    def looks_around(self) -> bool:
        """Whether nothing can be planned yet, since no floor was seen."""
        return not self._memory.perception.rooms and self._looks < len(_LOOK_AROUND)

    def act(
        self, now: Observation, context: Callable[[], Context], plan: Callable[[], None] | None = None
    ) -> Action:
        """The action of this step: plan what must be planned, then execute.

        At most one sub-task is planned in a step, by `plan` where that was not done before; without it, a
        robot that needs another sub-task waits for the next step. One that has a new one and still no action
        rests for a while.
        """
        if self.stopped or now.steps_left <= 0:
            return self._stop()
        if now.step < self._progress.rest_until:
            return WAIT
        if self.looks_around:
            self._looks += 1
            return _LOOK_AROUND[self._looks - 1]
        planned = fresh = self._progress.begun_at == now.step
        for _ in range(self._patience + 1):
            if self._progress.replan is Replan.TASK:
                if planned:
                    break
                if plan is None:
                    return WAIT
                plan()
                planned = fresh = True
            if fresh and self._progress.is_finished():
                break
            fresh = False
            if self._body.call is None and not self._plan_sub_skill(now, context()):
                break
            outcome = self._body.act(now)
            if isinstance(outcome, Action):
                return self._stop() if outcome.name is ActionName.STOP else outcome
            self._progress.end_skill(outcome)
        self._progress.rest_until = now.step + self._pause
        return WAIT

    def _plan_sub_skill(self, now: Observation, context: Context) -> bool:
        """Choose and begin the next sub-skill; False if the model gave none that this robot can do."""
        sub_task = self._progress.sub_task
        assert sub_task is not None
        self._exchanges()
        try:
            call = self._planner.next_skill(context, sub_task, self._progress.last)
        except ReplyError as error:
            return self._refuse(f"the model gave no usable sub-skill: {error}")
        illegal = self._task.legal_skill(call, self._capability)
        if illegal is not None:
            return self._refuse(illegal)
        self.skills.append({**skill_trace(call, None), "exchanges": self._exchanges()})
        self._body.begin(call, now, self._progress.focus_room(), self._memory.teammates_at())
        self._progress.events.append(f"My sub-skill is now: {call}")
        return True

    def _refuse(self, reason: str) -> bool:
        self.skills.append({"refused": reason, "exchanges": self._exchanges()})
        self._progress.refuse_skill(reason)
        return False

    def _stop(self) -> Action:
        if not self.stopped:
            self.stopped = True
            self._progress.events.append("I stop")
        return Action(ActionName.STOP)
