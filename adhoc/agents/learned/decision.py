"""The sub-skill decision module (paper, appendix 'Learning-based Policy')."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.learned.checkpoint import load_checkpoint
from adhoc.agents.learned.features import (
    DETECTION_SIZE,
    DETECTION_SLOTS,
    FEATURE_SIZE,
    OTHER_SIZE,
    OTHER_SLOTS,
    OWN_SIZE,
    encode,
)
from adhoc.agents.learned.layers import Array, Parameters, largest, linear, linear_shapes, relu, softmax
from adhoc.agents.learned.situation import OwnState, Situation


class SubSkillKind(str, Enum):
    """The candidate sub-skills of the learned team, as the paper lists them."""

    EXPLORE = "Explore"
    PICKUP_OBJECT = "PickupObject"
    PUT_OBJECT = "PutObject"
    STOP = "Stop"


KINDS = tuple(SubSkillKind)
"""In the order of the network's outputs."""


class DecisionNetwork:
    """Own state, detections and others are encoded, pooled and fused, and one of `classes` is predicted.

    Every detection goes through one layer and the largest and the sum of each number over all of them
    make the detection embedding; it is fused with that of abilities and own state into the robot's state
    feature. The others go through a layer of their own in the same way, and their pooled features are fused
    with the state feature. The paper names these parts and no sizes.

    Args:
        classes: How many kinds of sub-skills there are.
        width: Of every layer.
    """

    def __init__(self, classes: int = len(KINDS), width: int = 64) -> None:
        self.classes, self.width = classes, width

    @property
    def shapes(self) -> Mapping[str, tuple[int, ...]]:
        """See `layers.Network`."""
        return {
            **linear_shapes("own", OWN_SIZE, self.width),
            **linear_shapes("detection", DETECTION_SIZE, self.width),
            **linear_shapes("other", OTHER_SIZE, self.width),
            **linear_shapes("state", self.width, self.width),
            "state.largest_detection": (self.width, self.width),
            "state.all_detections": (self.width, self.width),
            **linear_shapes("fusion", self.width, self.width),
            "fusion.largest_other": (self.width, self.width),
            "fusion.all_others": (self.width, self.width),
            **linear_shapes("logits", self.width, self.classes),
        }

    def forward(self, parameters: Parameters, inputs: Array) -> Array:
        """Logits (B, classes) of rows of features (B, `FEATURE_SIZE`)."""
        after_detections = OWN_SIZE + DETECTION_SLOTS * DETECTION_SIZE
        detections = inputs[:, OWN_SIZE:after_detections].reshape(-1, DETECTION_SLOTS, DETECTION_SIZE)
        others = inputs[:, after_detections:].reshape(-1, OTHER_SLOTS, OTHER_SIZE)
        own = relu(linear(parameters, "own", inputs[:, :OWN_SIZE]))
        seen = _embed(parameters, "detection", detections)
        state = relu(
            linear(parameters, "state", own)
            + largest(seen) @ parameters["state.largest_detection"]
            + seen.sum(1) @ parameters["state.all_detections"]
        )
        told = _embed(parameters, "other", others)
        fused = relu(
            linear(parameters, "fusion", state)
            + largest(told) @ parameters["fusion.largest_other"]
            + told.sum(1) @ parameters["fusion.all_others"]
        )
        return linear(parameters, "logits", fused)


def _embed(parameters: Parameters, name: str, slots: Array) -> Array:
    """(B, N, width): each slot's embedding, zero where the slot is empty."""
    return relu(linear(parameters, name, slots)) * slots[:, :, :1]


class DecisionModule:
    """Chooses the kind of the next sub-skill.

    Args:
        parameters: Of a `DecisionNetwork`.
    """

    KIND = "sub_skill_decision"
    """Of its checkpoints."""

    def __init__(self, parameters: Mapping[str, NDArray[np.float32]]) -> None:
        self._network = DecisionNetwork()
        self._parameters = parameters

    @classmethod
    def load(cls, path: str | Path) -> DecisionModule:
        """From a checkpoint. Raises CheckpointError."""
        return cls(load_checkpoint(path, cls.KIND, DecisionNetwork().shapes).tensors)

    def probabilities(self, situation: Situation) -> Mapping[SubSkillKind, float]:
        """Of every kind."""
        row = encode(situation).reshape(1, FEATURE_SIZE)
        (chances,) = softmax(self._network.forward(self._parameters, row))
        return dict(zip(KINDS, chances.tolist()))

    def decide(self, situation: Situation) -> SubSkillKind:
        """The likeliest of the kinds that the robot's body is capable of at all."""
        chances = self.probabilities(situation)
        return max((kind for kind in KINDS if is_possible(kind, situation.own)), key=chances.__getitem__)


def is_possible(kind: SubSkillKind, own: OwnState) -> bool:
    """Whether hand and abilities allow it: nothing is put with an empty hand, or taken with a full one."""
    if kind is SubSkillKind.PICKUP_OBJECT:
        return own.capability.can_manipulate and not own.holding
    return kind is not SubSkillKind.PUT_OBJECT or own.holding
