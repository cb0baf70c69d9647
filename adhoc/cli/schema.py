"""The structured schema of `adhoc run`: types and defaults of everything that is no component."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Optional

from hydra.core.config_store import ConfigStore
from omegaconf import MISSING

SCHEMA_NAME = "run_schema"


@dataclass
class CapsConfig:
    """Hard caps; null is none. See `llm.budget.Caps`."""

    calls: Optional[int] = None  # noqa: UP045  (omegaconf reads the annotations on Python 3.10)
    tokens: Optional[int] = None  # noqa: UP045
    """Of prompts and replies together."""
    usd: Optional[float] = None  # noqa: UP045


@dataclass
class BudgetConfig:
    """What may be spent on language models."""

    episode: CapsConfig = field(default_factory=CapsConfig)
    """An episode that would pass one ends and counts as failed."""
    run: CapsConfig = field(default_factory=CapsConfig)
    """The whole run folder, over all its sessions. A run that would pass one stops; the same command with a
    larger cap goes on."""


@dataclass
class LedgerConfig:
    """Where calls are recorded and answered from."""

    mode: str = "auto"
    """`record`; `replay`: answers come from the ledger alone; `off`; `auto`: record, but not the offline
    reasoner."""
    path: Optional[str] = None  # noqa: UP045
    """The folder; `ledger` in the run folder if null."""
    wait_for_disk: bool = False
    """Go on only when an entry is on the disk: not even a power failure loses a paid answer then."""


@dataclass
class RetryConfig:
    """Asking again what can heal."""

    attempts: int = 8
    """How often in all."""
    wait: float = 2.0
    """Seconds before the second attempt, doubled before each further one, unless the provider says."""
    max_wait: float = 60.0
    """The longest single wait in seconds."""
    total_wait: float = 300.0
    """The longest wait for one answer in seconds."""


@dataclass
class RateConfig:
    """How many calls a provider is sent."""

    concurrent: int = 8
    """At the same time."""
    per_minute: Optional[int] = None  # noqa: UP045
    """Null is no limit."""


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
    imperfections: Any = MISSING
    """What is wrong with the team and its radio."""
    llm: Any = MISSING
    """The language model, for policies that use one."""
    join_step: int = 0
    """The step at which the ad hoc robot joins."""
    out: str = "out"
    """The run folder: records, pictures, transcripts. The same command again goes on where it stopped."""
    seed: int = 0
    """Other seeds give other scenarios of the same make, or other episodes of fixed tasks; 0 gives those that
    are listed."""
    limit: Optional[int] = None  # noqa: UP045
    """Only the first so many scenarios."""
    max_steps: int = 500
    """The step limit of an episode."""
    failed_share: str = "from_joining"
    """What a failed episode counts for the newcomer's share of #AS: `from_joining` or `full`."""
    predicted_within: int = 20
    """Steps in which a teammate's next sub-task or sub-skill must come to count as predicted."""
    budget: BudgetConfig = field(default_factory=BudgetConfig)
    ledger: LedgerConfig = field(default_factory=LedgerConfig)
    retry: RetryConfig = field(default_factory=RetryConfig)
    rate: RateConfig = field(default_factory=RateConfig)
    executor: Any = MISSING
    """Where episodes are run: in this process, in several, or on a cluster."""
    workers: int = 1
    """Processes that run episodes."""
    shard: str = "1/1"
    """i/n runs the i-th of n parts, into a folder of its own in `out`; `adhoc merge` puts them together."""
    fail_on_error: Optional[float] = 0.1  # noqa: UP045
    """The run stops when more episodes failed: a share below 1, a number of them, or null for never."""
    dry_run: bool = False
    """Estimate calls, tokens and cost from a few episodes with the offline reasoner; record nothing."""
    pictures: bool = True
    """Draw every episode from above."""
    transcript: bool = True
    """Write one decision of every episode as a page to read."""


def register_schema() -> None:
    """Make the schema known to Hydra, as `run_schema`."""
    ConfigStore.instance().store(name=SCHEMA_NAME, node=RunConfig)
