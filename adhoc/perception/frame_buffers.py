"""What is measured in one frame, before it is believed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Label, Observation
from adhoc.perception.object_table import ObjectTable
from adhoc.perception.semantic_points import LOCAL

_GONE_AT_ONCE = 64


class FrameBuffers:
    """Buffers for one frame, reused by every observation of a robot.

    All but `slot_of` and `gone` have one row per instance of the frame; see `voxels.voxelize` and
    `tracking.merge_instances`, which fill them.
    """

    def __init__(self) -> None:
        self.slot_of: NDArray[np.int32] = np.full(256, -1, np.int32)
        self.slots: NDArray[np.int64] = np.zeros(LOCAL, np.int64)
        self.boxes: NDArray[np.float64] = np.zeros((LOCAL, 6))
        self.votes: NDArray[np.int64] = np.zeros((LOCAL, LOCAL), np.int64)
        self.codes: NDArray[np.uint8] = np.zeros(LOCAL, np.uint8)
        self.room_changed: NDArray[np.uint8] = np.zeros(LOCAL, np.uint8)
        self.old_boxes: NDArray[np.float64] = np.zeros((LOCAL, 6))
        self.old_rooms: NDArray[np.int64] = np.zeros(LOCAL, np.int64)
        self.old_holders: NDArray[np.int64] = np.zeros(LOCAL, np.int64)
        self.gone: NDArray[np.int64] = np.zeros(_GONE_AT_ONCE, np.int64)
        self._labels: dict[int, Label] = {}
        self._held: str | None = None

    def read_labels(self, observation: Observation, table: ObjectTable) -> None:
        """Fill `slot_of`, the slot of each instance number of the frame (-1 for those without a label).

        Only labels that differ from the last frame's are looked up; the object in the hand gets no slot.
        """
        if observation.held != self._held:
            self.slot_of[:] = -1
            self._labels, self._held = {}, observation.held
        before, self._labels = self._labels, dict(observation.labels)
        for key in before.keys() - self._labels.keys():
            self.slot_of[key] = -1
        for key, label in self._labels.items():
            if before.get(key) is not label:
                self._set_slot(key, -1 if label.id == self._held else table.slot(label))

    def _set_slot(self, key: int, slot: int) -> None:
        if key >= len(self.slot_of):
            grown = np.full(2 * key, -1, np.int32)
            grown[: len(self.slot_of)] = self.slot_of
            self.slot_of = grown
        self.slot_of[key] = slot
