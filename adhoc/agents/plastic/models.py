"""What a type of team is known by: how its members behave, and what did work beside them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.learned.checkpoint import load_checkpoint
from adhoc.agents.learned.decision import DecisionModule, DecisionNetwork
from adhoc.agents.learned.layers import Array, Network, Parameters, linear, linear_shapes, relu, softmax
from adhoc.agents.plastic.deeds import Heard, Seen
from adhoc.agents.plastic.situation import FEATURES
from adhoc.agents.plastic.watching import Behaviour

KIND = "plastic_type"
"""Of its checkpoints."""
HEARD, SEEN, DECISION = "heard", "seen", "decision"
"""The parts of a type: two models of behaviour, and the policy. Names of tensors begin with them."""


class BehaviourNetwork:
    """From a teammate's situation to what it does: one hidden layer. See `learned.layers.Network`.

    Args:
        classes: How many deeds there are.
        width: Of the hidden layer.
    """

    def __init__(self, classes: int, width: int = 24) -> None:
        self.classes, self.width = classes, width

    @property
    def shapes(self) -> Mapping[str, tuple[int, ...]]:
        """See `learned.layers.Network`."""
        hidden = linear_shapes("hidden", len(FEATURES), self.width)
        return {**hidden, **linear_shapes("logits", self.width, self.classes)}

    def forward(self, parameters: Parameters, inputs: Array) -> Array:
        """Logits (B, classes) of rows of features (B, len(FEATURES))."""
        return linear(parameters, "logits", relu(linear(parameters, "hidden", inputs)))


BEHAVIOUR_NETWORKS: Mapping[str, BehaviourNetwork] = {
    HEARD: BehaviourNetwork(len(Heard)),
    SEEN: BehaviourNetwork(len(Seen)),
}
NETWORKS: Mapping[str, Network] = {**BEHAVIOUR_NETWORKS, DECISION: DecisionNetwork()}
"""Of all parts of a type."""


class TypeModel:
    """One known type of team.

    Args:
        name: Of the type.
        tensors: The parameters of all three parts, see `type_shapes`.
        card: The model card of its checkpoint.
    """

    def __init__(
        self, name: str, tensors: Mapping[str, NDArray[np.float32]], card: Mapping[str, Any] | None = None
    ) -> None:
        self.name = name
        self.card = card or {}
        self.policy = DecisionModule(part_of(tensors, DECISION))
        """Chooses the kind of sub-skill as did work beside such a team."""
        self._behaviour = {part: part_of(tensors, part) for part in BEHAVIOUR_NETWORKS}

    @classmethod
    def load(cls, path: str | Path) -> TypeModel:
        """From a checkpoint, which is named like the type. Raises CheckpointError."""
        checkpoint = load_checkpoint(path, KIND, type_shapes())
        return cls(Path(path).stem, checkpoint.tensors, checkpoint.card)

    def probability(self, behaviour: Behaviour) -> float:
        """How probable a member of such a team does that in its situation."""
        part = HEARD if isinstance(behaviour.deed, Heard) else SEEN
        row = behaviour.features.astype(np.float32).reshape(1, -1)
        (chances,) = softmax(BEHAVIOUR_NETWORKS[part].forward(self._behaviour[part], row))
        return float(chances[behaviour.deed])


def type_shapes() -> dict[str, tuple[int, ...]]:
    """The shapes of the tensors of a type's checkpoint."""
    return {
        f"{part}.{name}": shape
        for part, network in NETWORKS.items()
        for name, shape in network.shapes.items()
    }


def whole_of(parts: Mapping[str, Mapping[str, NDArray[np.float32]]]) -> dict[str, NDArray[np.float32]]:
    """The tensors of a type from those of its parts; `part_of` is the inverse."""
    return {f"{part}.{name}": value for part, tensors in parts.items() for name, value in tensors.items()}


def part_of(tensors: Mapping[str, NDArray[np.float32]], part: str) -> dict[str, NDArray[np.float32]]:
    """The tensors of one part, without its name."""
    beginning = f"{part}."
    return {
        name.removeprefix(beginning): value for name, value in tensors.items() if name.startswith(beginning)
    }
