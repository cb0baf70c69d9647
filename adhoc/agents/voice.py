"""What our robots say, and when (paper, section Communication); shared by all policies that talk."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import islice
from typing import Any

from adhoc.agents import communication
from adhoc.agents.memory import Memory
from adhoc.agents.news import News
from adhoc.agents.policy import Ask
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Capability, ObjectRecord, Observation


class Voice:
    """Composes one robot's messages from its memory.

    Args:
        memory: What the robot knows.
        capability: What it can do.
        ask: Broadcasts a question and returns the answers within the step.
        objects_told: The most detections in one message.
    """

    def __init__(self, memory: Memory, capability: Capability, ask: Ask, objects_told: int = 12) -> None:
        self._memory = memory
        self._capability = capability
        self._ask = ask
        self._objects_told = objects_told

    def join(self, state: dict[str, Any]) -> News:
        """Broadcast state and capability, and take in the reflected messages; what they taught."""
        return self._memory.hear(self._question(communication.join_message(self._memory.me, state)))

    def consult(self, sub_task: Call) -> tuple[tuple[Message, ...], News]:
        """Share an intention, and take in the replies; they, and what they taught."""
        replies = tuple(self._question(communication.intention_message(sub_task)))
        return replies, self._memory.hear(replies)

    def _question(self, message: Message) -> Sequence[Message]:
        self._memory.remember_sent([message])
        return self._memory.understand(self._ask(message))

    def state(
        self, observation: Observation, sub_task: Call | None, sub_skill: Call | None, stopped: bool
    ) -> dict[str, Any]:
        """The robot's state and capability, as `communication.state_payload` lays it out."""
        pose = observation.pose
        return communication.state_payload(
            pose,
            self._capability,
            self._memory.perception.map.room_at(pose.x, pose.y),
            observation.held,
            observation.steps_left,
            sub_task,
            sub_skill,
            self._memory.explored_rooms(),
            stopped,
        )

    def report(self, news: News, in_need: Iterable[ObjectRecord]) -> Message | None:
        """The key detections of a step, None if there are none.

        They are misplaced objects, what was just put down, receptacles where an object `in_need` belongs, and
        newly explored rooms.
        """
        names = (*news.misplaced, *news.placed)
        records = [record for record in map(self._memory.record, names) if record is not None]
        records += self._memory.fitting(news.receptacles, in_need) if news.receptacles else []
        if not records and not news.explored:
            return None
        return communication.detection_message(records[: self._objects_told], news.explored)

    def answer(self, message: Message, state: dict[str, Any]) -> Message | None:
        """A newcomer's `join` is answered by the own state, an `intention` by what is known.

        Whatever else is asked stays unanswered. The question itself is remembered.
        """
        self._memory.hear([message])
        if message.kind is MessageKind.JOIN:
            return communication.reflected_message(state, message.sender)
        if message.kind is MessageKind.INTENTION:
            records = islice(self._memory.attention(), self._objects_told)
            return communication.reply_message(message.sender, state, records, self._memory.explored_rooms())
        return None
