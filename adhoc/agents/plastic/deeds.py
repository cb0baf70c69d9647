"""What a teammate can be observed to do, in few words."""

from __future__ import annotations

from enum import IntEnum

from adhoc.core.calls import Call
from adhoc.core.messages import TeammateView
from adhoc.tasks.task import Task


class Heard(IntEnum):
    """What a message shows of its sender. The order is that of a behaviour model's outputs."""

    SEARCHES_HERE = 0
    """It begins to search the room that it is in, or that may be."""
    SEARCHES_ELSEWHERE = 1
    """It begins to search a room that it is not in, or goes to."""
    SEARCHES_TOGETHER = 2
    """It begins to search the room that it is in, and another teammate says that it searches there too."""
    ATTENDS = 3
    """It begins to deal with an object: the nearest to it, and nobody free is closer to the object."""
    ATTENDS_OUT_OF_TURN = 4
    """The same, although another able and free teammate is known to be closer to the object."""
    ATTENDS_PAST_NEARER = 5
    """The same, although it could take an object that is nearer to it."""
    ATTENDS_CONTESTED = 6
    """The same, although another teammate says that it deals with the object."""
    IDLES = 7
    """It has no sub-task, or one that is neither search nor work on an object."""
    STOPS = 8
    """It has stopped."""
    REPORTS = 9
    """It speaks, and goes on with what it did."""
    CONTINUES = 10
    """It has said nothing for a while, so it goes on with what it did."""


class Seen(IntEnum):
    """What two glimpses of a robot show, some steps apart."""

    STAYS = 0
    """It is where it was."""
    MOVES = 1
    """It is elsewhere, and no nearer to any object that needs attention."""
    NEARS_OBJECT = 2
    """It is nearer to the object in need that is nearest to it."""


class Doing(IntEnum):
    """What a teammate's own word says that it is at."""

    UNKNOWN = 0
    SEARCHING = 1
    ATTENDING = 2
    IDLING = 3
    STOPPED = 4


def doing(view: TeammateView | None, task: Task) -> Doing:
    """What a teammate is at, by its latest word; UNKNOWN if it has said nothing yet."""
    if view is None or view.last_heard < 0:
        return Doing.UNKNOWN
    if view.stopped:
        return Doing.STOPPED
    if attended(view, task) is not None:
        return Doing.ATTENDING
    return Doing.IDLING if searched(view.sub_task, task) is None else Doing.SEARCHING


def attended(view: TeammateView, task: Task) -> str | None:
    """The object that the teammate deals with, None if it does not."""
    if view.holding is not None:
        return view.holding
    sub_task = view.sub_task
    spec = None if sub_task is None else task.spec(sub_task.name)
    if spec is None or not spec.needs_manipulation or sub_task is None or not sub_task.args:
        return None
    return str(sub_task.args[0])


def searched(sub_task: Call | None, task: Task) -> str | None:
    """The room that a sub-task searches, None if it is no search."""
    if sub_task is None or not sub_task.args:
        return None
    room = str(sub_task.args[0])
    return room if sub_task == task.search(room) else None
