"""The heuristic policy of the paper, for original teams and for an ad hoc robot."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.agents.assignment import Worker, assign
from adhoc.agents.body import SkillOutcome, SkillTable
from adhoc.agents.decision import doing_trace
from adhoc.agents.news import News
from adhoc.agents.policy import Ask, Turn
from adhoc.agents.recipe import Recipe
from adhoc.agents.roster_member import RosterMember
from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.values import Action, ActionName, Capability, ObjectRecord, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.skills.explore import NOTHING_LEFT
from adhoc.tasks.task import Task

_SKILLS_PER_STEP = 4


class HeuristicPolicy(RosterMember):
    """Explore until an object needs attention, then the closest able robot deals with it.

    As a member (paper, appendix 'Teammates with Heuristic-Based Policy') a robot shares with its team what
    it covers and who is busy: frontiers are divided, the closest able and free robot takes each object, the
    others go on exploring, and objects wait while all able robots are busy. As a newcomer (paper, 'Ad hoc
    Agent Policy') it knows no team talk: it takes any detected object that it can carry and that nobody
    claims, or explores.

    The paper leaves open when a robot stops. Here: when nothing is left to explore, a robot that cannot
    manipulate stops; one that can waits, looking around, until no member explores any more.

    Args:
        member: Whether the robot belongs to the original team.
        perception: Settings of its perception.
        skills: Skills by sub-skill name; the paper's by default.
        search_skill: The sub-skill that explores.
        attempts: How often an object is tried; then it is left to others.
        retry_after: Steps before an object is tried again: more is known of the house by then.
    """

    def __init__(
        self,
        member: bool = True,
        perception: PerceptionSettings | None = None,
        skills: SkillTable | None = None,
        search_skill: str = "Explore",
        attempts: int = 3,
        retry_after: int = 30,
    ) -> None:
        super().__init__(perception, skills, attempts, retry_after)
        self._member = member
        self._search = Call(search_skill)

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._wake(me, capability, task, ask)
        self._by_hand = any(spec.needs_manipulation for spec in task.sub_tasks)
        self._able = capability.can_manipulate or not self._by_hand
        self._recipe: Recipe | None = None
        self._gone: list[str] = []
        self._idle = self._greeted = False

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`."""
        self._observation = observation
        _, news = self._memory.observe(observation)
        self._listen(inbox)
        self._introduce()
        self._drop_needless(news)
        self._report(self._voice.report(news, self._memory.attention()))
        self._take_object()
        action = self._act()
        self._announce()
        return self._turn(action, {"doing": doing_trace(*self._doing())})

    def _introduce(self) -> None:
        if not self._member and not self._greeted:
            self._voice.join(self._state())
        self._greeted = True

    # Deciding

    def _drop_needless(self, news: News) -> None:
        """Seen from near, the object that this robot is after turns out to be in place, or gone."""
        if self._recipe is None or self._now.held is not None:
            return
        if self._recipe.sub_task.args[0] in news.settled:
            self._recipe = None
            self._body.interrupt()

    def _take_object(self) -> None:
        """Begin to deal with the object that the rule gives to this robot, if it is free for one."""
        if self._recipe is not None or self._stopped or not self._able:
            return
        record = self._memory.held
        if record is not None and record.id in self._unable_now():
            return
        if record is None:
            object_id = self._choose_object()
            record = None if object_id is None else self._memory.record(object_id)
        if record is not None:
            self._deal_with(record)

    def _choose_object(self) -> str | None:
        """The object that falls to this robot by the rule of its team, None if none does."""
        return assign(self._open_objects(), self._workers(), self._by_hand).get(self._me)

    def _deal_with(self, record: ObjectRecord) -> None:
        sub_task = self._task.attend(record, self._memory.places_near(record.position))
        spec = None if sub_task is None else self._task.spec(sub_task.name)
        if sub_task is None or spec is None:
            self._attempts.put_off(record.id, self._now.step)
            return
        holding = self._memory.held is not None
        self._recipe = Recipe(sub_task, spec, self._task, self._search.name, holding)
        self._body.interrupt()

    def _open_objects(self) -> list[ObjectRecord]:
        handled = set(self._roster.handled())
        return [
            record
            for record in self._memory.attention()
            if record.id not in handled and not self._claimed_by_able(record.id)
        ]

    def _claimed_by_able(self, object_id: str) -> bool:
        claimant = self._memory.claimed(object_id)
        if claimant is None or claimant in self._roster.members:
            return False
        capability = self._memory.teammates[claimant].capability
        return capability is None or capability.can_manipulate or not self._by_hand

    def _workers(self) -> list[Worker]:
        me = Worker(self._me, self._position, self._capability, True, self._unable_now())
        return [me, *(state.worker() for state in self._roster.members.values())]

    # Acting

    def _act(self) -> Action:
        if self._stopped or self._now.steps_left <= 0:
            return self._stop()
        for _ in range(_SKILLS_PER_STEP):
            if self._body.call is None:
                if self._recipe is None and self._idle:
                    return self._wait()
                self._body.begin(self._next_skill(), self._now, self._focus_room(), self._roster.positions())
            outcome = self._body.act(self._now)
            if isinstance(outcome, Action):
                return outcome
            self._finish(outcome)
        return Action(ActionName.ROTATE_RIGHT)

    def _next_skill(self) -> Call:
        if self._recipe is None:
            return self._search
        return self._recipe.next_skill(self._memory, self._position)

    def _focus_room(self) -> str | None:
        """The only room that is explored for now; None for the whole house."""
        return None

    def _finish(self, outcome: SkillOutcome) -> None:
        if self._recipe is None:
            self._idle = outcome.failure is not None and outcome.failure.startswith(NOTHING_LEFT)
        elif outcome.failure is None:
            self._recipe.succeeded(outcome.call)
            if self._recipe.finished:
                self._complete()
        elif not (self._holds_object() and self._recipe.refuse_target()):
            self._give_up()

    def _complete(self) -> None:
        """The object is in its place: nobody needs to look after it any more."""
        assert self._recipe is not None
        self._memory.settle(str(self._recipe.sub_task.args[0]))
        self._recipe, self._idle = None, False

    def _give_up(self) -> None:
        """The object is not there, cannot be taken, or has no place to go to."""
        assert self._recipe is not None
        object_id = str(self._recipe.sub_task.args[0])
        if self._memory.record(object_id) is None:
            self._gone.append(object_id)
        else:
            self._attempts.put_off(object_id, self._now.step)
        self._recipe, self._idle = None, False

    def _wait(self) -> Action:
        """Nothing is left to explore: wait for explorers and for another attempt if useful, else stop."""
        useful = self._able and (self._will_retry() or not self._roster.all_idle())
        return Action(ActionName.ROTATE_RIGHT) if useful else self._stop()

    def _will_retry(self) -> bool:
        held = self._memory.held
        pending = [record.id for record in self._memory.attention()] + ([held.id] if held is not None else [])
        return any(map(self._attempts.will_retry, pending))

    # What others are told

    def _talks_to_team(self) -> bool:
        return self._member

    def _busy_with(self) -> str | None:
        return self._now.held if self._recipe is None else str(self._recipe.sub_task.args[0])

    def _is_idle(self) -> bool:
        return self._idle

    def _take_gone(self) -> list[str]:
        gone, self._gone = self._gone, []
        return gone

    def _current_sub_task(self) -> Call | None:
        if self._recipe is not None:
            return self._recipe.sub_task
        room = self._room()
        return None if room is None or self._stopped else self._task.search(room)

    def _holds_object(self) -> bool:
        assert self._recipe is not None
        return self._now.held == self._recipe.sub_task.args[0]
