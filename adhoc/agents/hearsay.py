"""What is believed to exist on teammates' words alone: a bounded number of things."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace

from adhoc.agents.communication import read_explored_rooms, read_objects
from adhoc.core.messages import Message
from adhoc.core.values import ObjectRecord


class Hearsay:
    """The objects and rooms that messages tell of, of each sender as many as a large house may have.

    Whoever makes up more is not listened to, and the others are all the same: what a robot knows, and the
    time that a step takes, stay bounded.

    Args:
        objects: The most different objects of one sender.
        rooms: The most different rooms of one sender.
    """

    def __init__(self, objects: int = 1000, rooms: int = 100) -> None:
        self._most_objects, self._most_rooms = objects, rooms
        self._objects: dict[str, set[str]] = defaultdict(set)
        self._rooms: dict[str, set[str]] = defaultdict(set)

    def objects(self, message: Message) -> Iterator[ObjectRecord]:
        """The detections that a message reports; the room of one is unknown if it is one too many."""
        objects, rooms = self._objects[message.sender], self._rooms[message.sender]
        for record in read_objects(message):
            if _admit(record.id, objects, self._most_objects):
                known = record.room is not None and _admit(record.room, rooms, self._most_rooms)
                yield record if known else replace(record, room=None)

    def explored_rooms(self, message: Message) -> list[str]:
        """The rooms that a message reports as explored."""
        rooms = self._rooms[message.sender]
        return [it for it in read_explored_rooms(message) if _admit(it, rooms, self._most_rooms)]


def _admit(name: str, told: set[str], most: int) -> bool:
    if len(told) < most:
        told.add(name)
    return name in told
