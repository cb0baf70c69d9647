"""What a person sees of the robot's world: text, from the robot's own memory and observation alone."""

from __future__ import annotations

import math
from collections.abc import Sequence

from adhoc.agents.human.short_numbers import ShortNumbers
from adhoc.core.calls import Call
from adhoc.core.geometry import wrap_angle
from adhoc.core.messages import Message, TeammateView
from adhoc.core.plans import Context
from adhoc.core.values import ObjectRecord, Pose, RoomRecord
from adhoc.prompting.clean import name, one_line

_SIDES = ("ahead", "ahead left", "left", "behind left", "behind", "behind right", "right", "ahead right")
_TEXT = 200


class Board:
    """Draws up what the person sees.

    Args:
        numbers: Where ids get their short numbers.
        shown: Of each list, so many entries are shown, nearest first; `look` shows `shown_on_look`.
        shown_on_look: See `shown`.
    """

    def __init__(self, numbers: ShortNumbers, shown: int = 8, shown_on_look: int = 60) -> None:
        self._numbers, self._shown, self._shown_on_look = numbers, shown, shown_on_look

    def draw(
        self,
        context: Context,
        doing: str,
        happened: Sequence[str] = (),
        heard: Sequence[Message] = (),
        all_of_it: bool = False,
    ) -> str:
        """The robot's situation as lines of text; `all_of_it` for the long lists."""
        most = self._shown_on_look if all_of_it else self._shown
        in_need = [it for it in context.objects if it.misplaced and it.id != context.holding]
        receptacles = [it for it in context.objects if it.is_receptacle and not it.is_pickupable]
        others = [
            it
            for it in context.objects
            if it not in in_need and it not in receptacles and it.id != context.holding
        ]
        in_view = [it for it in others if it.last_seen == context.step and it.source == "me"]
        pose = context.pose
        lists: tuple[tuple[str, list[str], int], ...] = (
            ("needs attention", *self._objects(in_need, pose, most)),
            ("in view", *self._objects(in_view, pose, most)),
            ("rooms", [self._room(room, pose) for room in context.rooms[:most]], len(context.rooms)),
            ("receptacles", *self._objects(receptacles, pose, most)),
            ("team", [_teammate(view) for view in context.teammates], len(context.teammates)),
        )
        lines = [
            self._state(context),
            *(f"  happened: {one_line(it, _TEXT)}" for it in happened),
            *(f"  heard: {name(it.sender)}: {one_line(it.text, _TEXT)}" for it in heard),
            "  " + one_line(f"doing: {doing or 'nothing'}; sub-task: {context.sub_task or 'none'}", _TEXT),
        ]
        for title, entries, count in lists:
            more = f"; ... {count - len(entries)} more" if count > len(entries) else ""
            if entries:
                lines.append(f"  {title}: {'; '.join(entries)}{more}")
        return "\n".join(lines)

    def _state(self, context: Context) -> str:
        pose = context.pose
        room = next((it for it in context.rooms if it.id == context.room), None)
        kind = "type unknown" if room is None or room.room_type is None else room.room_type
        where = "an unknown room" if room is None else f"{self._id(room.id)} ({name(kind)})"
        holding = self._id(context.holding) if context.holding else "nothing"
        return (
            f"step {context.step}: you are in {where} at ({pose.x:.1f}, {pose.y:.1f}), heading "
            f"{math.degrees(pose.yaw):.0f}, and hold {holding}; {context.steps_left} steps of battery left"
        )

    def _objects(self, records: Sequence[ObjectRecord], pose: Pose, most: int) -> tuple[list[str], int]:
        """The nearest of them, and how many there are."""
        near = sorted(records, key=lambda it: (_distance(it.position, pose), it.id))
        return [self._object(it, pose) for it in near[:most]], len(records)

    def _object(self, record: ObjectRecord, pose: Pose) -> str:
        place = f" on {name(record.receptacle)}" if record.receptacle and not record.is_receptacle else ""
        room = f" in {name(record.room)}" if record.room else ""
        return f"{self._id(record.id)}{place}{room}, {_direction(record.position, pose)}"

    def _room(self, room: RoomRecord, pose: Pose) -> str:
        explored = "explored" if room.explored else "not explored"
        kind = name(room.room_type) if room.room_type else "type unknown"
        return f"{self._id(room.id)} ({kind}, {explored}), {_direction(room.position, pose)}"

    def _id(self, thing: str) -> str:
        return f"{self._numbers.of(thing)} {name(thing)}"


def _distance(point: Sequence[float], pose: Pose) -> float:
    return math.hypot(point[0] - pose.x, point[1] - pose.y)


def _direction(point: Sequence[float], pose: Pose) -> str:
    """How far and on which side, as a robot that looks along its heading would say it."""
    x, y = point[0] - pose.x, point[1] - pose.y
    turn = wrap_angle(math.atan2(y, x) - pose.yaw)
    return f"{_distance(point, pose):.1f} m {_SIDES[round(turn / (math.pi / 4)) % len(_SIDES)]}"


def _teammate(view: TeammateView) -> str:
    parts = [
        f"in {name(view.room)}" if view.room else "",
        f"holds {name(view.holding)}" if view.holding else "",
        "has stopped" if view.stopped else _does(view.sub_task),
        "" if view.capability is None or view.capability.can_manipulate else "cannot manipulate",
    ]
    return ", ".join([name(view.name), *filter(None, parts)])


def _does(sub_task: Call | None) -> str:
    return "" if sub_task is None else f"does {name(str(sub_task))}"
