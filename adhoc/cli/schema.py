"""The structured schema of `adhoc run`: types and defaults of everything that is no component."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from hydra.core.config_store import ConfigStore
from omegaconf import MISSING

SCHEMA_NAME = "run_schema"


@dataclass
class RunConfig:
    """One run: which policies, where, and when the ad hoc robot joins. Groups are chosen in `run.yaml`."""

    policy: Any = MISSING
    """The ad hoc robot."""
    team: Any = MISSING
    task: Any = MISSING
    world: Any = MISSING
    benchmark: Any = MISSING
    """Houses and scenarios."""
    llm: Any = MISSING
    """The language model, for policies that use one."""
    join_step: int = 0
    """The step at which the ad hoc robot joins."""
    out: str = "out"
    """The run folder: records, pictures, transcripts. The same command again goes on where it stopped."""
    seed: int = 0
    """Other seeds give other scenarios of the same make, or other episodes of fixed tasks; 0 gives those that
    are listed."""
    limit: Optional[int] = None  # noqa: UP045  (omegaconf reads the annotation on Python 3.10)
    """Only the first so many scenarios."""
    max_steps: int = 500
    """The step limit of an episode."""
    failed_share: str = "from_joining"
    """What a failed episode counts for the newcomer's share of #AS: `from_joining` or `full`."""
    pictures: bool = True
    """Draw every episode from above."""
    transcript: bool = True
    """Write one decision of every episode as a page to read."""


def register_schema() -> None:
    """Make the schema known to Hydra, as `run_schema`."""
    ConfigStore.instance().store(name=SCHEMA_NAME, node=RunConfig)
