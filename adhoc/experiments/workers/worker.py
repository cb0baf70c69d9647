"""The life of a worker process: build everything once, then run one scenario after the other."""

from __future__ import annotations

from functools import partial
from multiprocessing.connection import Connection

from adhoc.core.errors import AdhocError
from adhoc.evaluation.lazy_scenarios import scenario_ids
from adhoc.experiments.run import check_ids
from adhoc.experiments.workers.comparison import Comparison, MakeComparison
from adhoc.experiments.workers.line import Line
from adhoc.experiments.workers.messages import NextScenario, Raised, Ready
from adhoc.experiments.workers.remote import RemoteFolder, RemoteModel, RemoteProgress


def work(connection: Connection, make: MakeComparison) -> None:
    """Run the scenarios that the parent names, until it names none.

    An AdhocError is told to the parent and ends the worker; anything else ends it with a trace.
    """
    line = Line(connection)
    try:
        comparison = make(RemoteModel(line))
        try:
            _run_scenarios(comparison, line)
        finally:
            comparison.world.close()
    except AdhocError as error:
        line.ask(Raised.of(error))


def _run_scenarios(comparison: Comparison, line: Line) -> None:
    ids = tuple(scenario_ids(comparison.scenarios))
    check_ids(ids)
    line.ask(Ready(ids, comparison.episodes))
    folder, progress = RemoteFolder(line), RemoteProgress(line)
    for position in iter(partial(line.ask, NextScenario()), None):
        comparison.run(folder, progress, position)
