"""The checkpoints that come with the library."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from adhoc.agents.learned.checkpoint import digest_of
from adhoc.agents.learned.common_sense import LearnedCommonSense
from adhoc.agents.learned.decision import DecisionModule, SubSkillKind
from adhoc.agents.learned.situation import Situation
from adhoc.core.errors import CheckpointError

SHIPPED = Path(__file__).parent / "checkpoints"
"""The folder."""
DETECTOR_FILE = "misplaced_detector.safetensors"
PREDICTOR_FILE = "receptacle_predictor.safetensors"
DECISION_FILE = "sub_skill_decision.safetensors"

Decide = Callable[[Situation], SubSkillKind]
"""Chooses the kind of the next sub-skill."""


def common_sense_in(folder: str | Path | None = None) -> LearnedCommonSense:
    """Detector and predictor of a folder; of the shipped ones if None. Raises CheckpointError."""
    return _common_sense(SHIPPED if folder is None else Path(folder))


def decision_in(folder: str | Path | None = None) -> Decide:
    """The decision module of a folder; the shipped one if None. Raises CheckpointError."""
    return _decision(SHIPPED if folder is None else Path(folder)).decide


@cache
def fingerprint_of(folder: str | Path | None = None) -> str:
    """A hash of the checkpoints in a folder; of the shipped ones if None."""
    return digest_of(SHIPPED if folder is None else Path(folder))


@cache
def _common_sense(folder: Path) -> LearnedCommonSense:
    with _saying_how_to_make(folder):
        return LearnedCommonSense.load(folder / DETECTOR_FILE, folder / PREDICTOR_FILE)


@cache
def _decision(folder: Path) -> DecisionModule:
    with _saying_how_to_make(folder):
        return DecisionModule.load(folder / DECISION_FILE)


@contextmanager
def _saying_how_to_make(folder: Path) -> Iterator[None]:
    """Where there is no checkpoint, the error names the command that makes one."""
    try:
        yield
    except CheckpointError as error:
        if isinstance(error.__cause__, FileNotFoundError):
            raise CheckpointError(f"{error}; `adhoc train team --out {folder}` makes it") from error
        raise
