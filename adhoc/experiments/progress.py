"""What is told while a plan is carried out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from adhoc.evaluation.records import Record
from adhoc.experiments.failures import Failure
from adhoc.experiments.plan import Plan


class Progress(Protocol):
    """Is told what happens to episodes, always from one thread."""

    def begin(self, plan: Plan) -> None:
        """This will be run."""

    def started(self, episode_id: str) -> None:
        """An episode is being run."""

    def finished(self, record: Record) -> None:
        """It is done, and its record stored."""

    def failed(self, failure: Failure) -> None:
        """It failed, and that is stored."""


class Silent:
    """A `Progress` that tells nobody."""

    def begin(self, plan: Plan) -> None:
        """See `Progress`."""

    def started(self, episode_id: str) -> None:
        """See `Progress`."""

    def finished(self, record: Record) -> None:
        """See `Progress`."""

    def failed(self, failure: Failure) -> None:
        """See `Progress`."""


SILENT = Silent()


@dataclass(frozen=True)
class RunSummary:
    """What one call did."""

    run: int
    """Episodes that were recorded."""
    recorded: int
    """Episodes of the plan that had been recorded before."""
    failed: int = 0
