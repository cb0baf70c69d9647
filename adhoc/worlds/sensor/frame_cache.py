"""A bounded store of pictures of the static layer."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable

from adhoc.worlds.sensor.sensor import Frame


class FrameCache:
    """Frames by key, at most `capacity_bytes` of picture data; the least recently used goes first.

    A capacity of 0 stores nothing.
    """

    def __init__(self, capacity_bytes: int) -> None:
        self._capacity = capacity_bytes
        self._frames: OrderedDict[Hashable, Frame] = OrderedDict()
        self.used_bytes = 0
        self.hits = 0
        self.misses = 0

    def __len__(self) -> int:
        return len(self._frames)

    def get(self, key: Hashable) -> Frame | None:
        """The frame of that key, now the most recently used; None if it is not stored."""
        frame = self._frames.get(key)
        if frame is None:
            self.misses += 1
            return None
        self._frames.move_to_end(key)
        self.hits += 1
        return frame

    def put(self, key: Hashable, frame: Frame) -> None:
        """Store a frame under a new key, dropping old ones until it fits."""
        size = _size(frame)
        if size > self._capacity:
            return
        while self.used_bytes + size > self._capacity:
            _, oldest = self._frames.popitem(last=False)
            self.used_bytes -= _size(oldest)
        self._frames[key] = frame
        self.used_bytes += size

    def drop_showing(self, instance: int) -> None:
        """Drop the frames in which the instance is visible; the others stay right without it."""
        stale = [key for key, frame in self._frames.items() if instance in frame.visible]
        for key in stale:
            self.used_bytes -= _size(self._frames.pop(key))


def _size(frame: Frame) -> int:
    return int(frame.depth.nbytes + frame.instances.nbytes)
