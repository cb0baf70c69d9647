"""The sub-skill that picks an object up."""

from __future__ import annotations

from adhoc.core.calls import Call
from adhoc.core.values import Action, ActionName, Failure
from adhoc.skills.approach import Approach, Approached
from adhoc.skills.bounded import BoundedSkill, sentence_of
from adhoc.skills.skill import SkillView

_FROM_ELSEWHERE = frozenset({Failure.TOO_FAR, Failure.NOT_VISIBLE})


class PickupObject(BoundedSkill):
    """`PickupObject <object>`: take an object that the robot is near.

    Approaches a little and tilts the camera where needed. What the world refuses is reported in its words.

    Args:
        reach: Horizontal metres to the object's nearest visible point at which the hand is closed.
        attempts: Standing places that are tried.
        most_actions: Bound on the number of actions; small, since going there is `GoToObject`'s part.
    """

    def __init__(self, reach: float = 1.45, attempts: int = 5, most_actions: int = 60) -> None:
        super().__init__(most_actions)
        self._reach = reach
        self._attempts = attempts
        self._approach = Approach("", reach, attempts)
        self._grasped = False

    def begin(self, call: Call, view: SkillView) -> None:
        """See `BoundedSkill`."""
        object_id = str(call.args[0])
        self._grasped = False
        self._approach = Approach(object_id, self._reach, self._attempts)
        self._approach.begin(view)
        if view.observation.held is not None:
            self.fail(f"{Failure.HAND_FULL.value} ({view.observation.held})")
        elif not view.capability.can_manipulate:
            self.fail(Failure.NO_MANIPULATION.value)
        elif object_id not in view.objects:
            self.fail(f"{object_id} is not known")

    def next_action(self, view: SkillView) -> Action | None:
        """See `BoundedSkill`."""
        object_id = self._approach.object_id
        if view.observation.held == object_id:
            return None
        result = view.observation.last_result
        if self._grasped and result is not None and not result.ok:
            if result.failure not in _FROM_ELSEWHERE:
                return self.fail(sentence_of(result))
            self._approach.reach -= 0.2
            self._approach.try_elsewhere(view)
        self._grasped = False
        step = self._approach.next_action(view)
        if isinstance(step, Action):
            return step
        if step is Approached.IN_REACH:
            self._grasped = True
            return Action(ActionName.PICK_UP, object_id)
        if step is Approached.GONE:
            return self.fail(f"the object {object_id} is not there")
        return self.fail(f"there is no way to {object_id}")
