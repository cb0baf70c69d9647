"""What robots say to each other (paper, section Communication)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from adhoc.core.calls import Call
from adhoc.core.values import Capability


class MessageKind(str, Enum):
    """The kinds of messages of the paper, and `TEAM` for what an original team says to itself."""

    JOIN = "join"
    """A newcomer's state and capability, broadcast when it joins."""
    REFLECTED = "reflected"
    """A teammate's state and capability, sent back to a newcomer."""
    INTENTION = "intention"
    """The sub-task that the sender is about to choose; teammates are expected to reply."""
    REPLY = "reply"
    """Answer to an intention: detected objects, explored rooms, the replier's current sub-task."""
    TASK_STATE = "task_state"
    """The sender began or finished a sub-task or a sub-skill, or stopped."""
    DETECTION = "detection"
    """Key detections: misplaced objects and candidate receptacles, explored rooms."""
    TEAM = "team"
    """A team's private format; a newcomer may ignore it."""


@dataclass(frozen=True)
class Message:
    """One message. `recipient` None means everybody. `payload` holds JSON values only.

    The channel, not the sender, writes `sender` and `step`.
    """

    kind: MessageKind
    text: str
    payload: Mapping[str, Any] = field(default_factory=dict)
    recipient: str | None = None
    sender: str = ""
    step: int = -1


@dataclass(frozen=True)
class TeammateView:
    """What a robot knows of one teammate, from messages alone."""

    name: str
    capability: Capability | None = None
    position: tuple[float, float] | None = None
    room: str | None = None
    holding: str | None = None
    sub_task: Call | None = None
    sub_skill: Call | None = None
    steps_left: int | None = None
    """Actions that its battery still paid for when it last said so."""
    explored_rooms: tuple[str, ...] = ()
    stopped: bool = False
    last_heard: int = -1
