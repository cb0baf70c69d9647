"""The sub-skill that puts the held object onto or into a receptacle."""

from __future__ import annotations

from adhoc.core.calls import Call
from adhoc.core.values import Action, ActionName, Failure
from adhoc.houses.house import FLOOR
from adhoc.skills.approach import Approach, Approached
from adhoc.skills.bounded import BoundedSkill, sentence_of
from adhoc.skills.go_to import travel_on
from adhoc.skills.skill import SkillView

_FROM_ELSEWHERE = frozenset({Failure.TOO_FAR, Failure.NOT_VISIBLE, Failure.NO_FREE_PLACE})


class PutObject(BoundedSkill):
    """`PutObject <object> <receptacle> <room>`: place the held object into or onto a receptacle in a room.

    Goes there, faces the receptacle and puts the object down, from another standing place if the world
    refuses for a reason that may depend on it. For the receptacle `Floor` the object is dropped in the room.

    Args:
        reach: Horizontal metres to the receptacle's nearest visible point at which the object is put down.
        attempts: Standing places that are tried to bring the receptacle into view.
        places: Standing places from which putting down is tried while there is no free place.
        most_actions: Bound on the number of actions.
    """

    def __init__(
        self, reach: float = 1.45, attempts: int = 5, places: int = 2, most_actions: int = 250
    ) -> None:
        super().__init__(most_actions)
        self._reach = reach
        self._attempts = attempts
        self._approach = Approach("", reach, attempts)
        self._object = ""
        self._room = ""
        self._places = places
        self._refused = 0
        self._released = False
        self._refusal: str | None = None

    def begin(self, call: Call, view: SkillView) -> None:
        """See `BoundedSkill`."""
        self._object, receptacle, self._room = (str(argument) for argument in call.args)
        self._released, self._refusal, self._refused = False, None, 0
        self._approach = Approach(receptacle, self._reach, self._attempts)
        self._approach.begin(view)
        if view.observation.held != self._object:
            self.fail(f"the robot does not hold {self._object}")
        elif receptacle == FLOOR:
            if not view.navigator.aim_at_room(self._room):
                self.fail(f"there is no known way to {self._room}")
        elif receptacle not in view.objects:
            self.fail(f"the receptacle {receptacle} is not known")

    def next_action(self, view: SkillView) -> Action | None:
        """See `BoundedSkill`."""
        if view.observation.held != self._object:
            return None if self._released else self.fail(f"the robot does not hold {self._object}")
        result = view.observation.last_result
        if self._released and result is not None and not result.ok:
            self._refusal = sentence_of(result)
            self._refused += result.failure is Failure.NO_FREE_PLACE
            final = result.failure not in _FROM_ELSEWHERE or self._refused >= self._places
            if final or self._approach.object_id == FLOOR:
                return self.fail(self._refusal)
            if result.failure is not Failure.NO_FREE_PLACE:
                self._approach.reach -= 0.2
            self._approach.try_elsewhere(view)
        self._released = False
        return self._drop(view) if self._approach.object_id == FLOOR else self._put(view)

    def _put(self, view: SkillView) -> Action | None:
        receptacle = self._approach.object_id
        step = self._approach.next_action(view)
        if isinstance(step, Action):
            return step
        if step is Approached.IN_REACH:
            self._released = True
            return Action(ActionName.PUT_DOWN, receptacle)
        if self._refusal is not None:
            return self.fail(self._refusal)
        if step is Approached.GONE:
            return self.fail(f"the receptacle {receptacle} cannot be seen from where it should be")
        return self.fail(f"there is no way to {receptacle}")

    def _drop(self, view: SkillView) -> Action | None:
        pose = view.observation.pose
        if view.map.room_at(pose.x, pose.y) != self._room:
            action = travel_on(self, view, self._room)
            if action is not None or self.failure is not None:
                return action
        self._released = True
        return Action(ActionName.DROP)
