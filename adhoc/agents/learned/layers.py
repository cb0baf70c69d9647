"""Layers of small networks, written once for two array libraries.

A network is its tensors' `shapes` and a `forward` that computes with what numpy arrays and torch tensors have
in common: `@`, `+`, `*`, indexing, `reshape`, `sum` and `clip`. Training runs it on torch tensors, robots
on numpy arrays: they need no torch, start no threads, and take a tenth of a millisecond for a decision.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = Any
"""A numpy array or a torch tensor, float32."""
Parameters = Mapping[str, Array]


class Network(Protocol):
    """A classifier over rows of numbers."""

    @property
    def shapes(self) -> Mapping[str, tuple[int, ...]]:
        """The shape of each parameter by name."""

    def forward(self, parameters: Parameters, inputs: Array) -> Array:
        """Logits (B, classes) of `inputs` (B, features)."""


def linear_shapes(name: str, inputs: int, outputs: int) -> dict[str, tuple[int, ...]]:
    """The shapes of the parameters of `linear`."""
    return {f"{name}.weight": (inputs, outputs), f"{name}.bias": (outputs,)}


def linear(parameters: Parameters, name: str, inputs: Array) -> Array:
    """`inputs @ weight + bias`, over the last axis."""
    return inputs @ parameters[f"{name}.weight"] + parameters[f"{name}.bias"]


def relu(values: Array) -> Array:
    """Negative numbers become 0."""
    return values.clip(min=0)


def largest(values: Array) -> Array:
    """The maximum over axis 1 of (B, N, F): (B, F)."""
    pooled = values[:, 0]
    for position in range(1, values.shape[1]):
        pooled = pooled + relu(values[:, position] - pooled)
    return pooled


def initial_parameters(
    shapes: Mapping[str, tuple[int, ...]], generator: np.random.Generator
) -> dict[str, NDArray[np.float32]]:
    """Where training begins: weights from He's normal distribution, biases 0."""
    return {
        name: (
            generator.normal(0.0, np.sqrt(2.0 / shape[0]), shape) if len(shape) > 1 else np.zeros(shape)
        ).astype(np.float32)
        for name, shape in shapes.items()
    }


def softmax(logits: NDArray[np.float32]) -> NDArray[np.float64]:
    """Probabilities over the last axis."""
    shifted = np.exp(logits.astype(np.float64) - logits.max(axis=-1, keepdims=True))
    return np.asarray(shifted / shifted.sum(axis=-1, keepdims=True))
