"""One scenario of a comparison: the team alone, then with each newcomer; each episode once."""

from __future__ import annotations

import time

from adhoc.core.errors import EpisodeError
from adhoc.evaluation.episode_key import EpisodeKey
from adhoc.evaluation.keyed_episode import models_of, run_keyed
from adhoc.evaluation.llm_field import stage_counts
from adhoc.evaluation.recording import make_record
from adhoc.evaluation.records import Record
from adhoc.experiments.comparison import Comparison
from adhoc.experiments.failures import Failure, ends_the_run
from adhoc.experiments.folder import EpisodeStore
from adhoc.experiments.progress import Progress


def run_scenario(comparison: Comparison, position: int, store: EpisodeStore, progress: Progress) -> None:
    """Run what `store` does not hold yet of one scenario.

    An episode with a newcomer is checked to share its past with the team alone (EpisodeError if not). An
    episode that raises is stored as a failure, and so are those that would need it; but for errors that end
    the run (`failures.ends_the_run`).

    Args:
        comparison: What is compared.
        position: Of the scenario in its list.
        store: Where records are and go; it raises when too many episodes failed.
        progress: Is told what happens.

    Raises:
        RecordError: The folder is damaged or belongs to another configuration.
        BudgetReached: A cap of the run was reached. What became of the episode is in `unfinished.jsonl`;
            it is run again by a later call.
    """
    scenario = comparison.scenarios[position]
    alone: Record | None = None
    for kind in comparison.kinds:
        key = EpisodeKey(scenario, kind)
        try:
            known = store.find(key)
            record = known or _run(comparison, key, alone, store, progress)
        except (Exception, SystemExit) as error:
            if ends_the_run(error):
                raise
            failure = Failure.of(key, error)
            progress.failed(failure)
            store.add_failure(failure)
            continue
        if known is None:
            progress.finished(record)
        if kind.newcomer is None:
            alone = record


def _run(
    comparison: Comparison, key: EpisodeKey, alone: Record | None, store: EpisodeStore, progress: Progress
) -> Record:
    progress.started(key.id)
    if key.kind.newcomer is not None and alone is None:
        raise EpisodeError(f"{key.id}: the episode of the team alone failed")
    started = time.perf_counter()
    result = run_keyed(comparison.world, key, alone)
    wall = time.perf_counter() - started
    record = make_record(key, result, alone, stage_counts(models_of(key)), wall)
    if result.budget is not None and result.budget.scope == "run":
        store.add_unfinished(key, record)
        raise result.budget
    for artifact in comparison.artifacts:
        artifact(key, result, record)
    store.add(key, record)
    return record
