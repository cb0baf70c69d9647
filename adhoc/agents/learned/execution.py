"""The action execution module: predicted sub-skills are executed by rule (paper, 'Learning-based Policy')."""

from __future__ import annotations

from collections.abc import Iterable

from adhoc.agents.assignment import Worker, assign
from adhoc.agents.attempts import Attempts
from adhoc.agents.body import Body, SkillOutcome
from adhoc.agents.learned.decision import SubSkillKind
from adhoc.agents.learned.places import KnownPlaces, Target, refusal_of
from adhoc.agents.memory import Memory
from adhoc.core.calls import Call
from adhoc.core.geometry import planar_distance
from adhoc.core.values import Action, Capability, ObjectRecord, Observation
from adhoc.skills.explore import NOTHING_LEFT

_EXPLORE = Call(SubSkillKind.EXPLORE.value)
_CALLS_PER_STEP = 4


class Execution:
    """Turns kinds of sub-skills into sub-skills with arguments, and these into actions.

    `PickupObject` takes an object that was detected to be misplaced: the one that the closest-robot rule
    gives to this robot, else the nearest that it can carry; with none it explores, as in the paper.
    `PutObject` goes to the nearest known place that the predictor calls reasonable; with none it explores.

    Args:
        memory: What the robot knows.
        body: Executes sub-skills.
        places: Finds targets.
        capability: What the robot can do.
        attempts: Remembers objects that it tried in vain.
        refusals: Remembers places that did not work out for what it holds.
    """

    def __init__(
        self,
        memory: Memory,
        body: Body,
        places: KnownPlaces,
        capability: Capability,
        attempts: Attempts,
        refusals: Attempts,
    ) -> None:
        self._memory, self._body, self._places = memory, body, places
        self._capability, self._attempts, self._refusals = capability, attempts, refusals
        self._calls: list[Call] = []
        self._target: Target | None = None
        self.object_id: str | None = None
        """The object that it is after or is putting; None while it explores."""
        self.idle = False
        """Whether nothing was left to explore when it last tried."""
        self._gone: list[str] = []

    @property
    def exploring(self) -> bool:
        """Whether a sub-skill of exploring is in progress."""
        return self._body.call == _EXPLORE

    def begin(
        self,
        kind: SubSkillKind,
        now: Observation,
        open_objects: Iterable[ObjectRecord],
        others: Iterable[Worker],
        crowd: tuple[tuple[float, float], ...],
    ) -> None:
        """Begin a sub-skill of that kind; exploring that is in progress just goes on.

        `open_objects` need attention and nobody is after them; `others` are the robots that might take them;
        `crowd` is where exploration need not go.
        """
        calls: list[Call] | None = None
        if kind is SubSkillKind.PICKUP_OBJECT and now.held is None:
            calls = self._to_pick_up(now, list(open_objects), others)
        elif kind is SubSkillKind.PUT_OBJECT and now.held is not None:
            calls = self._to_put(now)
        if calls is not None:
            self._calls = calls
            self._body.interrupt()
        elif not self.exploring:
            self.object_id, self._calls = None, []
            self._body.begin(_EXPLORE, now, None, crowd)

    def step(self, now: Observation) -> Action | None:
        """The next action; None when the sub-skill is over, or has no action."""
        for _ in range(_CALLS_PER_STEP):
            if self._body.call is None:
                if not self._calls:
                    return None
                self._body.begin(self._calls.pop(0), now)
            outcome = self._body.act(now)
            if isinstance(outcome, Action):
                return outcome
            self._end(outcome, now)
        return None

    def drop(self) -> None:
        """Leave the object alone: it needs nothing any more, or another robot takes it."""
        self.object_id, self._calls = None, []
        self._body.interrupt()

    def take_gone(self) -> list[str]:
        """Objects that were not where they were believed to be, since this was last asked."""
        gone, self._gone = self._gone, []
        return gone

    def place_known(self, now: Observation) -> bool:
        """Whether there is a target for what is held."""
        return self._nearest_place(now) is not None

    def _to_pick_up(
        self, now: Observation, open_objects: list[ObjectRecord], others: Iterable[Worker]
    ) -> list[Call] | None:
        unable = self._attempts.pending(now.step)
        me = Worker(self._memory.me, (now.pose.x, now.pose.y), self._capability, True, unable)
        mine = [record for record in open_objects if me.can_take(record)]
        if not mine:
            return None
        given = assign(open_objects, [me, *others]).get(me.name)
        nearest = min(mine, key=lambda it: (planar_distance(it.position, me.position), it.id))
        self.object_id = nearest.id if given is None else given
        return [Call(name, (self.object_id,)) for name in ("GoToObject", "PickupObject")]

    def _to_put(self, now: Observation) -> list[Call] | None:
        self._target = self._nearest_place(now)
        if self._target is None or now.held is None:
            return None
        self.object_id = now.held
        return [Call("PutObject", (now.held, *self._target))]

    def _nearest_place(self, now: Observation) -> Target | None:
        if self._memory.held is None:
            return None
        return self._places.nearest(
            self._memory.held, (now.pose.x, now.pose.y), self._refusals.pending(now.step)
        )

    def _end(self, outcome: SkillOutcome, now: Observation) -> None:
        if outcome.call == _EXPLORE:
            self.idle = outcome.failure is not None and outcome.failure.startswith(NOTHING_LEFT)
        elif outcome.failure is not None:
            self._give_up(now)
        elif not self._calls:
            self._finish(now)

    def _finish(self, now: Observation) -> None:
        """Picked up, or put in its place: then nobody needs to look after it any more."""
        if self.object_id is not None and now.held is None:
            self._memory.settle(self.object_id)
            self.idle = False
        self.object_id = None

    def _give_up(self, now: Observation) -> None:
        """The object is not there or cannot be taken, or the place does not work out."""
        object_id, self.object_id, self._calls = self.object_id, None, []
        if now.held is not None and self._target is not None:
            self._refusals.put_off(refusal_of(self._target), now.step)
        elif object_id is not None and self._memory.record(object_id) is None:
            self._gone.append(object_id)
        elif object_id is not None:
            self._attempts.put_off(object_id, now.step)
