"""From a robot's memory to the context that planners see."""

from __future__ import annotations

from collections.abc import Iterable

from adhoc.agents.memory import Memory
from adhoc.core.calls import Call
from adhoc.core.plans import Context
from adhoc.core.values import Capability, ObjectRecord, Observation
from adhoc.tasks.task import Task


def build_context(
    memory: Memory,
    task: Task,
    capability: Capability,
    observation: Observation,
    sub_task: Call | None,
    done: tuple[Call, ...],
    objects_shown: int = 80,
) -> Context:
    """The context of one planning event: state, capability, messages and memory (paper, Preliminaries).

    Of the objects, those that need attention, those in view and the receptacles are shown, nearest first,
    `objects_shown` at most: a house has hundreds of things that no planner asks for.
    """
    position = (observation.pose.x, observation.pose.y)
    rooms = memory.rooms_near(position)
    return Context(
        step=observation.step,
        task=task.brief(rooms),
        me=memory.me,
        pose=observation.pose,
        capability=capability,
        steps_left=observation.steps_left,
        room=memory.perception.map.room_at(*position),
        holding=observation.held,
        objects=tuple(_shown(memory, observation, objects_shown)),
        rooms=tuple(rooms),
        teammates=tuple(memory.teammates[name] for name in sorted(memory.teammates)),
        messages=tuple(memory.messages),
        history=tuple(memory.events),
        sub_task=sub_task,
        done=done,
    )


def _shown(memory: Memory, observation: Observation, limit: int) -> Iterable[ObjectRecord]:
    """Objects in the hand and in need first, then receptacles, then whatever else is in view.

    Those in need have half of the places at most, and what the robot saw itself goes before what it was
    told: teammates who make things up hide no receptacle and nothing that is there.
    """
    position = (observation.pose.x, observation.pose.y)
    in_need = sorted(memory.attention(), key=lambda record: record.source != "me")
    chosen: dict[str, ObjectRecord] = {}
    if memory.held is not None:
        chosen[memory.held.id] = memory.held
    chosen.update((record.id, record) for record in in_need[: limit // 2])
    chosen.update((record.id, record) for record, _ in memory.places_near(position))
    for label in observation.labels.values():
        if len(chosen) >= limit:
            break
        record = memory.record(label.id)
        if record is not None:
            chosen.setdefault(label.id, record)
    return list(chosen.values())[:limit]
