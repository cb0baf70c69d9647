"""The expert of the learned team: it knows the metadata of the task, and shows each robot what to do."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from adhoc.agents.assignment import Worker, assign
from adhoc.agents.learned.decision import KINDS, SubSkillKind, is_possible
from adhoc.agents.learned.features import encode
from adhoc.agents.learned.shipped import Decide
from adhoc.agents.learned.situation import Detection, OwnState, Situation
from adhoc.core.values import ObjectRecord
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.scenario import Scenario
from adhoc.training.demonstrations import Recorder
from adhoc.worlds.world import World


class Expert:
    """Says what kind of sub-skill is right, given which objects are truly misplaced.

    The metadata of the task decide what is worth picking up, so that false alarms are passed by. The rest
    follows from what the robot knows, or it could not be learned from that: the closest able and free robot
    takes an object, as in the heuristic team; what is held is put where a place is known; a robot stops when
    nothing is left to explore, and, if it can manipulate, nobody could find anything for it any more. The
    paper only says that metadata of the task and the scene make the demonstrations.
    """

    def __init__(self, world: World, scenario: Scenario) -> None:
        self._referee = PlacementReferee(world, scenario)

    def __call__(self, situation: Situation) -> SubSkillKind:
        """The right kind in this situation."""
        own = situation.own
        if own.holding:
            return SubSkillKind.PUT_OBJECT if own.place_known else SubSkillKind.EXPLORE
        if self._is_given_one(situation):
            return SubSkillKind.PICKUP_OBJECT
        return SubSkillKind.STOP if own.idle and not self._can_wait(situation) else SubSkillKind.EXPLORE

    def _is_given_one(self, situation: Situation) -> bool:
        own = situation.own
        if not own.capability.can_manipulate:
            return False
        given_up = frozenset(it.id for it in situation.detections if it.given_up)
        workers = [Worker(own.name, own.position, own.capability, True, given_up)]
        workers += [
            Worker(it.name, it.position, it.capability, not it.busy and not it.stopped, it.unable)
            for it in situation.others
            if it.position is not None
        ]
        return own.name in assign(self._waiting(situation.detections), workers)

    def _waiting(self, detections: Iterable[Detection]) -> list[ObjectRecord]:
        """The truly misplaced objects that nobody is after, as the rule takes them."""
        wrong = set(self._referee.watched) - set(self._referee.replaced())
        return [
            ObjectRecord(it.id, "", (*it.position, 0.0), mass=it.mass)
            for it in detections
            if it.id in wrong and not it.handled
        ]

    def _can_wait(self, situation: Situation) -> bool:
        own = situation.own
        if not own.capability.can_manipulate:
            return False
        at_work = any(not it.stopped and (it.busy or not it.idle) for it in situation.others)
        return at_work or any(_may_take(own, it) and it.given_up for it in situation.detections)


class Demonstrator(Recorder):
    """Decides as the expert does, takes that down, and now and then does something else.

    A robot that always does the right thing never shows what is right after a mistake; hence the strays, of
    which the expert's opinion is recorded and not the stray itself (noise injection, as in DART, Laskey et
    al. 2017). It never strays into `Stop`, which is for good.

    Args:
        expert: Knows what is right, as `Expert` does.
        stray: Probability of a stray.
        generator: Draws the strays.
    """

    def __init__(self, expert: Decide, stray: float, generator: np.random.Generator) -> None:
        super().__init__()
        self._expert, self._stray, self._generator = expert, stray, generator

    def decide(self, situation: Situation) -> SubSkillKind:
        """The kind of sub-skill that is executed."""
        right = self._expert(situation)
        self.note(encode(situation), KINDS.index(right))
        if self._generator.random() >= self._stray:
            return right
        possible = [
            kind for kind in KINDS if kind is not SubSkillKind.STOP and is_possible(kind, situation.own)
        ]
        return possible[int(self._generator.integers(len(possible)))]


def _may_take(own: OwnState, detection: Detection) -> bool:
    return detection.mass <= own.capability.payload and not detection.handled
