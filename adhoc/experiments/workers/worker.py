"""The life of a worker process: run one unit after the other, and build what they need."""

from __future__ import annotations

from functools import partial
from multiprocessing.connection import Connection

from adhoc.core.errors import AdhocError
from adhoc.experiments.comparison import Comparisons, MakeComparisons
from adhoc.experiments.scenario_run import run_scenario
from adhoc.experiments.workers.line import Line
from adhoc.experiments.workers.messages import NextUnit, Raised
from adhoc.experiments.workers.remote import RemoteFolder, RemoteModel, RemoteProgress


def work(connection: Connection, make: MakeComparisons) -> None:
    """Run the units that the parent names, until it names none.

    An AdhocError is told to the parent and ends the worker; anything else ends it with a trace.
    """
    serve(Line(connection), make)


def serve(line: Line, make: MakeComparisons) -> None:
    """The same over a line that is there already."""
    try:
        comparisons = make(RemoteModel(line))
        try:
            _run_units(comparisons, line)
        finally:
            comparisons.close()
    except AdhocError as error:
        line.ask(Raised.of(error))


def _run_units(comparisons: Comparisons, line: Line) -> None:
    folder, progress = RemoteFolder(line), RemoteProgress(line)
    for unit in iter(partial(line.ask, NextUnit()), None):
        run_scenario(comparisons[unit.comparison], unit.position, folder, progress)
