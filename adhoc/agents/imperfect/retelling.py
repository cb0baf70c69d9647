"""A robot's report told anew: with other objects, or another sub-task."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from adhoc.agents import communication
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import ObjectRecord

_IN_REFLECTED = frozenset({"capability", "room", "position", "steps_left"})
"""What `communication.reflected_message` puts into words."""


def told_with_objects(report: Message, records: Iterable[ObjectRecord]) -> Message:
    """The same report of other detections, in text and payload; a report that has none stays as it is."""
    if "objects" not in report.payload:
        return report
    rooms = communication.read_explored_rooms(report)
    if report.kind is MessageKind.DETECTION:
        return communication.detection_message(records, rooms)
    if report.kind is MessageKind.REPLY and report.recipient is not None:
        return communication.reply_message(report.recipient, report.payload, records, rooms)
    return report


def told_with_sub_task(report: Message, sub_task: Call) -> Message:
    """The same report with another current sub-task, in text and payload; a report that has none stays as it
    is."""
    if "sub_task" not in report.payload:
        return report
    state: dict[str, Any] = {**report.payload, "sub_task": communication.call_payload(sub_task)}
    if report.kind is MessageKind.TASK_STATE:
        return communication.task_state_message(f"My sub-task is now: {sub_task}.", state)
    if report.recipient is None:
        return report
    if report.kind is MessageKind.REFLECTED and state.keys() >= _IN_REFLECTED:
        return communication.reflected_message(state, report.recipient)
    if report.kind is MessageKind.REPLY:
        rooms = communication.read_explored_rooms(report)
        return communication.reply_message(report.recipient, state, communication.read_objects(report), rooms)
    return report
