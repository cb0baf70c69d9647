"""Common sense that was learned: what is misplaced, and where it belongs."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.learned import vocabulary
from adhoc.agents.learned.checkpoint import load_checkpoint
from adhoc.agents.learned.placement_networks import (
    DETECTOR_KIND,
    PREDICTOR_KIND,
    detector_network,
    predictor_network,
)
from adhoc.core.values import Place
from adhoc.tasks.common_sense import CommonSense, Triple

Weights = Mapping[str, NDArray[np.float32]]


class LearnedCommonSense(CommonSense):
    """Answers by the two networks instead of by the placement table.

    Args:
        detector: Parameters of the misplaced-object detector.
        predictor: Parameters of the reasonable-receptacle predictor.
        reasonable_above: A place belongs to an object when its predicted probability is above this.
    """

    def __init__(self, detector: Weights, predictor: Weights, reasonable_above: float = 0.5) -> None:
        self._detector, self._predictor = detector, predictor
        self._reasonable_above = reasonable_above
        self._least_logit = float(np.log(reasonable_above / (1.0 - reasonable_above)))
        self._misplaced: dict[Triple, bool] = {}
        self._places: dict[str, tuple[Place, ...]] = {}

    @classmethod
    def load(cls, detector: str | Path, predictor: str | Path) -> LearnedCommonSense:
        """From two checkpoints. Raises CheckpointError."""
        return cls(
            load_checkpoint(detector, DETECTOR_KIND, detector_network().shapes).tensors,
            load_checkpoint(predictor, PREDICTOR_KIND, predictor_network().shapes).tensors,
        )

    @cached_property
    def fingerprint(self) -> str:
        """See `CommonSense`: of all parameters."""
        digest = hashlib.sha256(repr(self._reasonable_above).encode())
        for weights in (self._detector, self._predictor):
            for name, value in sorted(weights.items()):
                digest.update(f"{name} {value.dtype} {value.shape}".encode() + value.tobytes())
        return digest.hexdigest()[:16]

    def is_misplaced(self, category: str, receptacle: str, room_type: str) -> bool:
        """See `CommonSense`. What the detector has no word for is misplaced, as by the placement table:
        it belongs nowhere, and robots leave it alone."""
        key = (category, receptacle, room_type)
        if key not in self._misplaced:
            self._misplaced[key] = self._detect(key)
        return self._misplaced[key]

    def places_for(self, category: str) -> Sequence[Place]:
        """See `CommonSense`; empty for a category that the predictor has no word for."""
        if category not in self._places:
            self._places[category] = self._predict(category)
        return self._places[category]

    def _detect(self, triple: Triple) -> bool:
        try:
            row = vocabulary.situated_row(*triple)
        except KeyError:
            return True
        return bool(detector_network().forward(self._detector, row[None])[0, 0] > 0.0)

    def _predict(self, category: str) -> tuple[Place, ...]:
        try:
            row = vocabulary.object_row(category)
        except KeyError:
            return ()
        (logits,) = predictor_network().forward(self._predictor, row[None])
        order = np.argsort(-logits, kind="stable")
        candidates = vocabulary.candidate_places()
        return tuple(candidates[position] for position in order if logits[position] > self._least_logit)
