"""The learned policy of the paper's original teams (appendix, 'Teammates with Learning-based Policy')."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from adhoc.agents.attempts import Attempts
from adhoc.agents.body import SkillTable
from adhoc.agents.decision import doing_trace
from adhoc.agents.learned.awareness import Awareness
from adhoc.agents.learned.decision import SubSkillKind
from adhoc.agents.learned.execution import Execution
from adhoc.agents.learned.places import KnownPlaces
from adhoc.agents.learned.shipped import Decide, common_sense_in, decision_in, fingerprint_of
from adhoc.agents.news import News
from adhoc.agents.policy import Ask, Turn
from adhoc.agents.roster_member import RosterMember
from adhoc.core.calls import Call
from adhoc.core.geometry import planar_distance
from adhoc.core.messages import Message
from adhoc.core.values import Action, ActionName, Capability, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.tasks.common_sense import CommonSense
from adhoc.tasks.task import Task

WAIT = Action(ActionName.ROTATE_RIGHT)
_CHOICES_PER_STEP = 4


class LearnedPolicy(RosterMember):
    """A network says what kind of sub-skill comes next, and rules execute it.

    What is misplaced and where it belongs is judged by the learned detector and predictor, in place of the
    task's common sense. The robot chooses whenever a sub-skill is over, and while it explores also when
    something changed that choices depend on: an object that needs attention, or what a member is at. The
    paper does not say when. `PickupObject` and `PutObject` are carried through. The members tell each other
    at every step where they are and what they are at, which makes the others' state features.

    Args:
        decide: Chooses; the decision module of `checkpoints` if None.
        common_sense: Judges; detector and predictor of `checkpoints` if None.
        checkpoints: A folder as `adhoc train team` writes it; the shipped one if None.
        perception: Settings of its perception.
        skills: Skills by sub-skill name; the paper's by default.
        attempts: How often an object, or a place for one, is tried.
        retry_after: Steps before it is tried again.
        patience: A robot that finds nothing to explore looks around for so many steps before it chooses
            again, unless something changes.

    Raises:
        CheckpointError: A checkpoint cannot be read or does not fit.
    """

    def __init__(
        self,
        decide: Decide | None = None,
        common_sense: CommonSense | None = None,
        checkpoints: str | None = None,
        perception: PerceptionSettings | None = None,
        skills: SkillTable | None = None,
        attempts: int = 3,
        retry_after: int = 30,
        patience: int = 10,
    ) -> None:
        super().__init__(perception, skills, attempts, retry_after)
        self._decide = decision_in(checkpoints) if decide is None else decide
        self._common_sense = common_sense_in(checkpoints) if common_sense is None else common_sense
        self._fingerprint = "" if common_sense is None else common_sense.fingerprint
        if decide is None or common_sense is None:
            self._fingerprint = fingerprint_of(checkpoints) + self._fingerprint
        self._patience = patience

    @property
    def fingerprint(self) -> str:
        """See `Policy`: of its checkpoints, and of a common sense that was given to it."""
        return self._fingerprint

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._wake(me, capability, task.with_common_sense(self._common_sense), ask)
        self._execution = Execution(
            self._memory,
            self._body,
            KnownPlaces(self._memory, self._common_sense),
            capability,
            self._attempts,
            Attempts(self._most_attempts, self._retry_after),
        )
        self._awareness = Awareness(self._memory, self._roster, capability)
        self._handling: Call | None = None
        self._chosen_at = -1
        self._chosen_by: Hashable = None

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`."""
        self._observation = observation
        self._sighting, news = self._memory.observe(observation)
        self._listen(inbox)
        self._drop_needless(news)
        self._report(self._voice.report(news, self._memory.attention()))
        action = self._act()
        self._announce()
        return self._turn(action, {"doing": doing_trace(*self._doing())})

    def _drop_needless(self, news: News) -> None:
        """Leave an object that turns out to be in place, or that a nearer member is after as well."""
        object_id = self._execution.object_id
        if object_id is None or self._now.held is not None:
            return
        if object_id in news.settled or self._is_outranked(object_id):
            self._execution.drop()

    def _is_outranked(self, object_id: str) -> bool:
        record = self._memory.record(object_id)
        if record is None:
            return False
        mine = (planar_distance(self._position, record.position), self._me)
        return any(
            state.busy == object_id
            and not state.stopped
            and (planar_distance(state.position, record.position), state.name) < mine
            for state in self._roster.members.values()
        )

    # Choosing and acting

    def _act(self) -> Action:
        if self._stopped or self._now.steps_left <= 0:
            return self._stop()
        for _ in range(_CHOICES_PER_STEP):
            if self._must_choose():
                kind = self._choose()
                if kind is SubSkillKind.STOP:
                    return self._stop()
                self._begin(kind)
            action = self._execution.step(self._now)
            if action is not None:
                return action
        return WAIT

    def _must_choose(self) -> bool:
        if self._execution.object_id is not None:
            return False
        if self._circumstances() != self._chosen_by:
            return True
        waited = self._now.step >= self._chosen_at + self._patience
        return not self._execution.exploring and (waited or not self._execution.idle)

    def _choose(self) -> SubSkillKind:
        self._chosen_at, self._chosen_by = self._now.step, self._circumstances()
        situation = self._awareness.situation(
            self._now,
            self._execution.place_known(self._now),
            self._execution.idle,
            self._unable_now(),
        )
        return self._decide(situation)

    def _begin(self, kind: SubSkillKind) -> None:
        workers = [state.worker() for state in self._roster.members.values()]
        open_objects = self._awareness.open_objects()
        self._execution.begin(kind, self._now, open_objects, workers, self._roster.positions())
        object_id = self._execution.object_id
        record = None if object_id is None else self._memory.record(object_id)
        if record is not None:
            self._handling = self._task.attend(record, self._memory.places_near(record.position))

    def _circumstances(self) -> Hashable:
        """What choices depend on, as far as it changes by leaps."""
        return (
            self._now.held,
            self._execution.idle,
            frozenset(record.id for record in self._memory.attention()),
            self._unable_now(),
            tuple(
                (state.name, state.busy, state.idle, state.stopped) for state in self._roster.members.values()
            ),
        )

    # What others are told

    def _busy_with(self) -> str | None:
        return self._execution.object_id or self._now.held

    def _is_idle(self) -> bool:
        return self._execution.idle

    def _take_gone(self) -> list[str]:
        return self._execution.take_gone()

    def _current_sub_task(self) -> Call | None:
        if self._execution.object_id is not None or self._now.held is not None:
            return self._handling
        room = self._room()
        return None if room is None else self._task.search(room)
