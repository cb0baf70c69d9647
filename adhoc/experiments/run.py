"""Carrying out a plan in this process."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.evaluation.records import Record
from adhoc.experiments.comparison import Comparison
from adhoc.experiments.failures import Failure
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.plan import Plan, make_plan
from adhoc.experiments.progress import SILENT, Progress, RunSummary
from adhoc.experiments.scenario_run import run_scenario


def run_comparison(comparison: Comparison, folder: RunFolder, progress: Progress = SILENT) -> RunSummary:
    """Plan and run one comparison: what `folder` does not hold yet. Raises what `run_plan` and `make_plan`
    raise."""
    return run_plan(make_plan([comparison], folder), [comparison], folder, progress)


def run_plan(
    plan: Plan, comparisons: Sequence[Comparison], folder: RunFolder, progress: Progress = SILENT
) -> RunSummary:
    """Run the units of a plan one after the other.

    Raises:
        EpisodesFailed: More episodes failed than the folder's tolerance bears.
        AdhocError: Whatever `run_scenario` raises.
    """
    counted = Counted(plan, progress)
    folder.expect(plan.to_run)
    for unit in plan.units:
        run_scenario(comparisons[unit.comparison], unit.position, folder, counted)
    return counted.summary


class Counted:
    """A `Progress` that hands on what it is told, and counts it."""

    def __init__(self, plan: Plan, progress: Progress) -> None:
        self._plan, self._progress = plan, progress
        self._run = self._failed = 0
        progress.begin(plan)

    @property
    def summary(self) -> RunSummary:
        """What was told so far."""
        return RunSummary(self._run, self._plan.done, self._failed)

    def begin(self, plan: Plan) -> None:
        """See `Progress`; the plan was told already."""

    def started(self, episode_id: str) -> None:
        """See `Progress`."""
        self._progress.started(episode_id)

    def finished(self, record: Record) -> None:
        """See `Progress`."""
        self._run += 1
        self._progress.finished(record)

    def failed(self, failure: Failure) -> None:
        """See `Progress`."""
        self._failed += 1
        self._progress.failed(failure)
