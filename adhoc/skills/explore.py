"""The sub-skill that learns more of the house: frontier-based exploration."""

from __future__ import annotations

import math

from adhoc.core.calls import Call
from adhoc.core.geometry import wrap_angle
from adhoc.core.values import Action
from adhoc.perception.frontiers import Frontier
from adhoc.skills.bounded import BoundedSkill, level_camera
from adhoc.skills.navigator import Travel
from adhoc.skills.skill import SkillView

NOTHING_LEFT = "nothing left to explore"
"""The failure of `Explore` when no frontier is left; with a focus room, `... in <room>` follows."""

_AT_FRONTIER = 0.4
_FACING = math.radians(40)
_PEER_PITCH = math.radians(60)


class Explore(BoundedSkill):
    """`Explore`: go to the best frontier and look beyond it (paper, Description of Sub-Skills).

    With a focus room only its frontiers count, else all do. The best frontier is the cheapest to reach, in
    moves, after a bonus for its size and a penalty near teammates. The skill succeeds when that frontier is
    resolved, from wherever that happens, and fails with `NOTHING_LEFT` when there was none. A frontier that
    stays after a look at it from close by, or that cannot be reached, is dismissed: exploration always ends.

    Args:
        size_bonus: Moves that one metre of frontier is worth.
        crowd_radius: Metres within which a teammate makes a frontier less attractive.
        crowd_penalty: Moves that a teammate right at the frontier costs.
        revisit: Whether to go on to what only teammates have inspected when nothing else is left: for a
            newcomer it may be the way to what nobody has seen.
        turn_for: Straight runs of at least so many moves are faced; short, since looking ahead is the point.
        most_actions: Bound on the number of actions.
    """

    def __init__(
        self,
        size_bonus: float = 2.0,
        crowd_radius: float = 4.0,
        crowd_penalty: float = 20.0,
        revisit: bool = True,
        turn_for: int = 2,
        most_actions: int = 80,
    ) -> None:
        super().__init__(most_actions)
        self._size_bonus = size_bonus
        self._crowd_radius = crowd_radius
        self._crowd_penalty = crowd_penalty
        self._revisit = revisit
        self._turn_for = turn_for
        self._target: Frontier | None = None
        self._turns: list[Action] | None = None
        self._peered = False

    def begin(self, call: Call, view: SkillView) -> None:
        """See `BoundedSkill`."""
        self._target = None
        self._peered = False

    def next_action(self, view: SkillView) -> Action | None:
        """See `BoundedSkill`."""
        tilt = None if self._peered else level_camera(view)
        if tilt is not None:
            return tilt
        for _ in range(8):
            if self._target is None:
                self._target = self._choose(view)
                self._turns, self._peered = None, False
                if self._target is None:
                    room = view.focus_room
                    return self.fail(NOTHING_LEFT if room is None else f"{NOTHING_LEFT} in {room}")
            elif not view.map.is_frontier(*self._target.point):
                return None
            action = self._approach(view, self._target)
            if action is not None:
                return action
            view.map.dismiss(*self._target.point)
            if self._taken:
                return None
            self._target = None
        return None

    def _approach(self, view: SkillView, target: Frontier) -> Action | None:
        observation = view.observation
        step = view.navigator.travel(observation, self._turn_for)
        if isinstance(step, Action):
            return step
        return self._look_around(view, target) if step is Travel.ARRIVED else None

    def _look_around(self, view: SkillView, target: Frontier) -> Action | None:
        """Turn toward the unknown, then look down: close by it may lie below the picture."""
        if self._turns is None:
            beyond = view.map.unknown_direction(*target.point)
            if beyond is None:
                return None
            pose = view.observation.pose
            x, y = target.point[0] + beyond[0] - pose.x, target.point[1] + beyond[1] - pose.y
            turn = view.navigator.turn_toward(view.observation, x, y, _FACING)
            bearing = abs(wrap_angle(math.atan2(y, x) - pose.yaw))
            self._turns = [] if turn is None else [turn] * round(bearing / (math.pi / 2))
        if self._turns:
            return self._turns.pop()
        if self._peered:
            return None
        self._peered = True
        return view.navigator.tilt_toward(view.observation, _PEER_PITCH, 0.0)

    def _choose(self, view: SkillView) -> Frontier | None:
        for told in (False, True) if self._revisit else (False,):
            frontiers = view.map.frontiers(view.focus_room, told)
            chosen = self._best(view, frontiers) if frontiers else None
            if chosen is not None:
                return chosen
        return None

    def _best(self, view: SkillView, frontiers: tuple[Frontier, ...]) -> Frontier | None:
        costs = view.navigator.travel_costs(view.observation, [frontier.point for frontier in frontiers])
        best, best_score = None, math.inf
        for frontier, score in zip(frontiers, costs):
            score -= self._size_bonus * frontier.size * view.map.settings.cell
            for other in view.others:
                away = math.dist(other, frontier.point)
                score += self._crowd_penalty * max(0.0, 1.0 - away / self._crowd_radius)
            if score < best_score:
                best, best_score = frontier, score
        if best is None or not view.navigator.aim_at_point(*best.point, _AT_FRONTIER):
            return None
        return best
