"""The misplaced-object detector and the reasonable-receptacle predictor (paper, 'Learning-based Policy')."""

from __future__ import annotations

from collections.abc import Mapping

from adhoc.agents.learned.layers import Array, Parameters, linear, linear_shapes, relu
from adhoc.agents.learned.vocabulary import candidate_places, object_size, situated_size


class TwoLayers:
    """Two linear layers with a rectifier between them.

    Args:
        inputs: Numbers in a row.
        outputs: Logits.
        width: Of the layer between.
    """

    def __init__(self, inputs: int, outputs: int, width: int) -> None:
        self._inputs, self._outputs, self._width = inputs, outputs, width

    @property
    def shapes(self) -> Mapping[str, tuple[int, ...]]:
        """See `layers.Network`."""
        return {
            **linear_shapes("hidden", self._inputs, self._width),
            **linear_shapes("logits", self._width, self._outputs),
        }

    def forward(self, parameters: Parameters, inputs: Array) -> Array:
        """Logits (B, outputs) of rows (B, inputs)."""
        return linear(parameters, "logits", relu(linear(parameters, "hidden", inputs)))


DETECTOR_KIND = "misplaced_detector"
"""Of the detector's checkpoints."""
PREDICTOR_KIND = "receptacle_predictor"
"""Of the predictor's."""


def detector_network() -> TwoLayers:
    """Object, receptacle and room type in (`vocabulary.situated_row`), one logit of 'misplaced' out."""
    return TwoLayers(situated_size(), 1, width=96)


def predictor_network() -> TwoLayers:
    """The type of the misplaced object in (`vocabulary.object_row`), a logit for each of the
    `vocabulary.candidate_places` out. The paper says 'linear layers'; two, as in the detector."""
    return TwoLayers(object_size(), len(candidate_places()), width=96)
