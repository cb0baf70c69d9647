"""Finding and following paths on a robot's own semantic map."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from adhoc.core.geometry import wrap_angle
from adhoc.core.values import Action, ActionName, Failure, Observation, Pose
from adhoc.perception.semantic_map import SemanticMap
from adhoc.skills import lattice
from adhoc.skills.goals import NO_GOAL, mark_near_point, mark_room, mark_standing_places

MOVES = (ActionName.MOVE_AHEAD, ActionName.MOVE_LEFT, ActionName.MOVE_BACK, ActionName.MOVE_RIGHT)
"""The moves by quarter turns from the heading, counter-clockwise."""

_LONGEST_PATH = 1024
_MEETING = 0.6
_MEETINGS = 3
_CHECKED_AHEAD = 4
_STEEPEST = math.radians(60)
_HIGHEST = math.radians(-30)


class Travel(Enum):
    """How following a path can end."""

    ARRIVED = "arrived"
    UNREACHABLE = "unreachable"


@dataclass(frozen=True)
class TravelSettings:
    """Parameters of navigation. The paper gives none; the sizes of steps are AI2-THOR's."""

    step: float = 0.25
    """Metres of one move."""
    tight_cost: int = 8
    """Extra cost of a node that is 0.1 m from where a robot would touch something; a step costs 10."""
    unknown_cost: int = 20
    """Extra cost of a node whose floor was not seen."""
    robot_clearance: float = 0.45
    """Nodes nearer to a robot in view are not entered, metres."""
    bump_memory: int = 40
    """Steps for which a blocked way is remembered; then it may be free, since robots move."""
    replan_every: int = 12
    """A path is searched again after so many moves, since more is known by then."""
    turn_for: int = 4
    """The robot turns to face a straight run of at least so many moves, and strafes shorter ones. Strafing is
    quicker; facing shows what is new on the way."""
    most_bumps: int = 8
    """After so many bumps on the way to it a goal counts as unreachable."""


class Navigator:
    """Moves one robot over the lattice of 0.25 m steps and quarter turns on which its poses lie.

    Paths are cheapest over what is known: unknown floor may be crossed at a higher cost, robots in view are
    avoided, and ways that turned out blocked are remembered for a while. A path is kept while it stays valid.
    Where robots block the only way, it heads for them: they may have moved on by then.
    Land of which nothing is known is entered only if no other way leads to the goal, say to an object that
    a teammate told of, and then anywhere between what is known and the goal.

    Two robots that meet head-on both step back, each for its own number of moves, so that one of them gets
    through first.

    Args:
        semantic_map: The robot's own map.
        settings: Costs and bounds.
        courtesy: Moves that this robot steps back when it bumps into another; give each robot its own.
    """

    def __init__(
        self, semantic_map: SemanticMap, settings: TravelSettings = TravelSettings(), courtesy: int = 2
    ) -> None:
        self.map = semantic_map
        self.settings = settings
        self._anchor: Pose | None = None
        half = int(semantic_map.settings.extent / 2 / settings.step) - 4
        self._size = 2 * half + 1
        self._frame: NDArray[np.float64] = np.zeros(4)
        self._costs: NDArray[np.int32] = np.zeros((self._size, self._size), np.int32)
        self._goals: NDArray[np.int32] = np.full((self._size, self._size), NO_GOAL, np.int32)
        self._distances: NDArray[np.int32] = np.zeros(self._size * self._size, np.int32)
        self._closed: NDArray[np.uint8] = np.zeros((self._size * self._size, 4), np.uint8)
        self._closed_until: dict[tuple[int, int], int] = {}
        self._tried: NDArray[np.uint8] = np.zeros(self._size * self._size, np.uint8)
        self._target: tuple[float, float] | None = None
        self._open: NDArray[np.uint8] | None = None
        self._courtesy = courtesy
        self._back = 0
        self._back_direction = 0
        self._path: list[int] = []
        self._planned_at: int | None = None
        self._moves = 0
        self._bumps = 0
        self._last_step = -1

    def update(self, observation: Observation) -> None:
        """Take note of the robot's pose and of a blocked move; call once a step, before anything else."""
        if self._anchor is None:
            self._anchor = observation.pose
            yaw, step = observation.pose.yaw, self.settings.step
            self._frame = np.array(
                [observation.pose.x, observation.pose.y, step * math.cos(yaw), step * math.sin(yaw)]
            )
        if observation.step == self._last_step:
            return
        self._last_step = observation.step
        self._reopen(observation.step)
        result = observation.last_result
        if result is None or result.action.name not in MOVES:
            return
        if result.failure is Failure.BLOCKED:
            direction = (self._heading(observation.pose) + MOVES.index(result.action.name)) % 4
            node = self._node(observation.pose)
            if self._step_back(node, direction):
                return
            self._closed[node, direction] = 1
            self._closed_until[node, direction] = observation.step + self.settings.bump_memory
            self._path = []
            self._bumps += 1

    def aim_at_point(self, x: float, y: float, radius: float) -> bool:
        """Make all nodes within `radius` metres of a point the goal; False if no robot can stand there."""
        self._begin((x, y))
        return self._mark_daring(
            lambda: mark_near_point(x, y, radius, self._frame, self._costs, self._goals) > 0
        )

    def aim_at_room(self, room: str, margin: float = 0.5) -> bool:
        """Make the nodes inside a room the goal, `margin` metres from its neighbours' floors if possible.

        False if none of its floor is known, or no robot can stand on it.
        """
        grid = self.map
        self._begin(grid.free_point(room))
        number = grid.table.room_numbers.get(room)
        if number is None:
            return False
        where = (self._frame, grid.settings.cell, grid.origin, grid.floor, self._costs, self._goals)
        return bool(mark_room(number, margin, *where) > 0 or mark_room(number, 0.0, *where) > 0)

    def aim_at_object(
        self, box: NDArray[np.float64], object_id: str, eye_height: float, reach: float
    ) -> bool:
        """Make the nodes from which a box can be seen and reached the goal; False if there is none.

        `box` is (x0, y0, z0, x1, y1, z1) in metres. Nodes that were `set_aside` are left out. Where no node
        has a free line of sight as far as is known, nodes within reach do.
        """
        self._begin((float(box[0] + box[3]) / 2, float(box[1] + box[4]) / 2))
        return self._mark_daring(lambda: self._mark_standing_places(box, object_id, eye_height, reach))

    def _mark_standing_places(
        self, box: NDArray[np.float64], object_id: str, eye_height: float, reach: float
    ) -> bool:
        grid = self.map
        slot = grid.table.slots.get(object_id, -2)
        room = int(grid.table.rooms[slot]) if slot >= 0 else 0
        for needs_sight in (True, False):
            found = mark_standing_places(
                box,
                slot,
                room,
                grid.table.kinds,
                eye_height,
                reach,
                self._frame,
                grid.settings.cell,
                grid.origin,
                grid.voxels,
                grid.topmost,
                grid.floor,
                self._costs,
                self._tried,
                needs_sight,
                self._goals,
            )
            if found:
                return True
        return False

    def set_aside(self, pose: Pose, radius: float = 0.3) -> None:
        """Do not aim at an object from near this pose again, until `forget_set_aside`."""
        node, reach = self._node(pose), int(radius / self.settings.step)
        rows = self._tried.reshape(self._size, self._size)
        a, b = divmod(node, self._size)
        rows[max(a - reach, 0) : a + reach + 1, max(b - reach, 0) : b + reach + 1] = 1

    def forget_set_aside(self) -> None:
        """Allow all nodes again."""
        self._tried[:] = 0

    def travel(self, observation: Observation, turn_for: int | None = None) -> Action | Travel:
        """The next action on the way to the goal that was aimed at, or how the way ended.

        `turn_for` overrides the setting of that name; 0 means never to turn.
        """
        node = self._node(observation.pose)
        self._advance(node)
        if self._goals.flat[node] >= 0 and not self._path and self._planned_at == node:
            return Travel.ARRIVED
        if self._bumps > self.settings.most_bumps:
            return Travel.UNREACHABLE
        if self._back:
            self._back -= 1
            return Action(MOVES[(self._back_direction - self._heading(observation.pose)) % 4])
        if not self._path_holds(node):
            if not self._plan(node):
                return Travel.UNREACHABLE
            if not self._path:
                return Travel.ARRIVED
        return self._follow(observation.pose, self.settings.turn_for if turn_for is None else turn_for)

    def travel_costs(self, observation: Observation, points: Sequence[tuple[float, float]]) -> list[float]:
        """Cost of the way from the robot to each point, in moves; inf where there is none. Drops the goal."""
        self._begin()
        self._goals[:] = NO_GOAL
        self._spread(self._node(observation.pose))
        costs = [int(self._distances[self._node(Pose(x, y))]) for x, y in points]
        return [math.inf if cost == lattice.UNREACHED else cost / lattice.STEP_COST for cost in costs]

    def turn_toward(self, observation: Observation, dx: float, dy: float, tolerance: float) -> Action | None:
        """A quarter turn toward the direction (dx, dy); None if it is within `tolerance` radians of the
        heading, or as near as quarter turns can bring it."""
        bearing = wrap_angle(math.atan2(dy, dx) - observation.pose.yaw)
        if abs(bearing) <= max(tolerance, math.pi / 4 + 1e-3):
            return None
        return Action(ActionName.ROTATE_LEFT if bearing > 0 else ActionName.ROTATE_RIGHT)

    def tilt_toward(self, observation: Observation, pitch: float, tolerance: float) -> Action | None:
        """A tilt of the camera toward `pitch` (radians, down is positive); None if it is near enough, or the
        camera cannot tilt further."""
        result = observation.last_result
        wanted = min(max(pitch, _HIGHEST), _STEEPEST)
        off = wanted - observation.pose.pitch
        if abs(off) <= max(tolerance, math.radians(15) + 1e-3):
            return None
        action = Action(ActionName.LOOK_DOWN if off > 0 else ActionName.LOOK_UP)
        if result is not None and result.failure is Failure.LOOK_LIMIT and result.action.name is action.name:
            return None
        return action

    def _begin(self, target: tuple[float, float] | None = None) -> None:
        self._path = []
        self._planned_at = None
        self._bumps = 0
        self._target, self._open = target, None
        self._refresh_costs()

    def _mark_daring(self, mark: Callable[[], bool]) -> bool:
        """Mark goals over what is known; if there are none, over what robots cover now, and then over what
        may be on the way to the target."""
        if mark():
            return True
        if self.map.robots:
            self._refresh_costs(avoid_robots=False)
            if mark():
                return True
        return self._dare() and mark()

    def _dare(self) -> bool:
        """Open the unknown land between all that is known and the target; False if it is open already."""
        if self._target is None or self._open is not None:
            return False
        grid = self.map
        tiles = round(math.sqrt(grid.told.size))
        width = grid.settings.cell * grid.settings.cells_per_metre
        known = np.argwhere(((grid.known > 0) | (grid.told > 0)).reshape(tiles, tiles))
        target = [int((self._target[axis] - grid.origin[axis]) / width) for axis in (0, 1)]
        corners = np.vstack([known, np.clip(target, 0, tiles - 1)])
        (first_x, first_y), (last_x, last_y) = corners.min(0), corners.max(0)
        land = np.zeros((tiles, tiles), np.uint8)
        land[max(first_x - 1, 0) : last_x + 2, max(first_y - 1, 0) : last_y + 2] = 1
        self._open = land.ravel()
        self._refresh_costs()
        return True

    def _refresh_costs(self, avoid_robots: bool = True) -> None:
        grid, settings = self.map, self.settings
        places = list(grid.robots.values()) if avoid_robots else []
        robots = np.array(places, np.float64).reshape(-1, 2)
        lattice.node_costs(
            self._frame,
            grid.settings.cell,
            grid.origin,
            grid.floor,
            grid.blocked,
            grid.known,
            grid.told if self._open is None else self._open,
            grid.settings.cells_per_metre,
            robots,
            settings.robot_clearance,
            settings.tight_cost,
            settings.unknown_cost,
            self._costs,
        )

    def _spread(self, node: int) -> int:
        grid = self.map
        return int(
            lattice.spread(
                node,
                self._costs,
                self._closed,
                self._frame,
                grid.settings.cell,
                grid.origin,
                grid.blocked,
                self._goals,
                self._distances,
            )
        )

    def _plan(self, node: int) -> bool:
        if self._planned_at is not None:
            self._refresh_costs()
        goal = self._spread(node)
        if goal < 0 and self.map.robots:
            self._refresh_costs(avoid_robots=False)
            goal = self._spread(node)
        if goal < 0 and self._dare():
            goal = self._spread(node)
        if goal < 0:
            return False
        path = np.zeros(_LONGEST_PATH, np.int64)
        grid = self.map
        length = lattice.trace(
            node,
            goal,
            self._costs,
            self._closed,
            self._frame,
            grid.settings.cell,
            grid.origin,
            grid.blocked,
            self._distances,
            path,
        )
        if length == 0 and goal != node:
            return False
        self._path = path[:length].tolist()
        self._planned_at = node
        self._moves = 0
        return True

    def _path_holds(self, node: int) -> bool:
        if not self._path or node != self._planned_at or self._moves >= self.settings.replan_every:
            return False
        for direction in self._path[:_CHECKED_AHEAD]:
            node = self._after(node, direction)
            x, y = self._point(node)
            if not self.map.is_traversable(x, y):
                return False
            for robot in self.map.robots.values():
                if math.dist(robot, (x, y)) < self.settings.robot_clearance:
                    return False
        return True

    def _follow(self, pose: Pose, turn_for: int) -> Action:
        direction = self._path[0]
        quarter = (direction - self._heading(pose)) % 4
        run = 1
        while run < len(self._path) and self._path[run] == direction:
            run += 1
        node = self._node(pose)
        following = self._after(node, direction)
        if quarter and turn_for and (run >= turn_for or not self.map.is_known(*self._point(following))):
            return Action(ActionName.ROTATE_RIGHT if quarter == 3 else ActionName.ROTATE_LEFT)
        return Action(MOVES[quarter])

    def _step_back(self, node: int, direction: int) -> bool:
        """Begin to step back if it was a robot that blocked the way; a bump on the way back ends that.

        One that stands there time and again counts as an obstacle.
        """
        if self._back:
            self._back = 0
            return True
        x, y = self._point(self._after(node, direction))
        near = any(math.dist(robot, (x, y)) < _MEETING for robot in self.map.robots.values())
        met = near and self._bumps < _MEETINGS
        if met:
            self._back, self._back_direction = self._courtesy, (direction + 2) % 4
            self._path = []
            self._bumps += 1
        return met

    def _advance(self, node: int) -> None:
        """Drop the first move of the path once it is made; it need not be, a skill may do something else."""
        if (
            self._path
            and self._planned_at is not None
            and node == self._after(self._planned_at, self._path[0])
        ):
            self._path = self._path[1:]
            self._planned_at = node
            self._moves += 1

    def _reopen(self, step: int) -> None:
        for edge in [edge for edge, until in self._closed_until.items() if until <= step]:
            del self._closed_until[edge]
            self._closed[edge] = 0

    def _heading(self, pose: Pose) -> int:
        assert self._anchor is not None
        return round((pose.yaw - self._anchor.yaw) / (math.pi / 2)) % 4

    def _node(self, pose: Pose) -> int:
        dx, dy = pose.x - self._frame[0], pose.y - self._frame[1]
        scale = self.settings.step**2
        middle = self._size // 2
        a = round((dx * self._frame[2] + dy * self._frame[3]) / scale) + middle
        b = round((dy * self._frame[2] - dx * self._frame[3]) / scale) + middle
        return int(min(max(a, 0), self._size - 1) * self._size + min(max(b, 0), self._size - 1))

    def _after(self, node: int, direction: int) -> int:
        return node + (self._size, 1, -self._size, -1)[direction]

    def _point(self, node: int) -> tuple[float, float]:
        a, b = node // self._size - self._size // 2, node % self._size - self._size // 2
        x, y, along, across = self._frame.tolist()
        return x + a * along - b * across, y + a * across + b * along
