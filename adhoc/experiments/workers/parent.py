"""The one process that owns the language model and the run folder while workers run the episodes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from multiprocessing.connection import Connection, wait
from typing import Any

from adhoc.core.errors import AdhocError, ConfigurationError, EpisodeError, WorkerError
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.plan import Plan
from adhoc.experiments.progress import Progress, RunSummary
from adhoc.experiments.run import Counted
from adhoc.experiments.workers.agenda import Agenda
from adhoc.experiments.workers.calls import CallThreads
from adhoc.experiments.workers.messages import (
    AboutModel,
    AddFailure,
    AddRecord,
    BeginEpisode,
    Complete,
    CountTokens,
    FindRecord,
    MayGoTogether,
    ModelFacts,
    ModelQuestion,
    NextUnit,
    Note,
    Raised,
    Started,
)
from adhoc.experiments.workers.wire import Wire, Worker
from adhoc.llm.model import LanguageModel
from adhoc.llm.together import PATIENCE_S

DEATHS = 3
"""So many workers that died in one episode make it a failed one."""
LOOK_S = 0.5
"""Seconds after which the parent looks for trouble in its own threads, whether or not a worker asks."""


Hire = Callable[[int], Worker]
"""Starts the worker of that number."""


def run_in_workers(
    plan: Plan,
    hire: Hire,
    make_model: Callable[[], LanguageModel],
    workers: int,
    folder: RunFolder,
    progress: Progress,
    calls: int = 16,
) -> RunSummary:
    """`run_plan` in several processes; the records are the same, in the order in which they are done.

    Workers take one unit at a time. Their language model is this process's: a call that was begun is
    answered, and recorded if the model records, whether or not the worker that asked still lives. A worker
    that is killed is replaced, and its unit begun again.

    Args:
        plan: What to run.
        hire: Starts a worker that runs `work`.
        make_model: Builds the model that stands behind all workers; called when one asks for it first. The
            model must bear calls from several threads.
        workers: How many processes, at least 1.
        folder: Where records are and go.
        progress: Is told what happens, always from this thread.
        calls: How many calls of the model may be under way at once, at least 1.

    Raises:
        ConfigurationError: A number is out of range.
        WorkerError: A worker ended by itself, or `DEATHS` of them were killed before any episode.
        AdhocError: Whatever `run_plan` raises; the other workers are stopped.
    """
    if workers < 1 or calls < 1:
        raise ConfigurationError(f"workers={workers} and calls={calls} must be at least 1")
    parent = _Parent(plan, hire, make_model, workers, folder, progress, calls)
    try:
        parent.run()
    finally:
        parent.close()
    return parent.summary


class _Parent:
    """Answers what workers ask, until there is nothing left to do."""

    def __init__(
        self,
        plan: Plan,
        hire: Hire,
        make_model: Callable[[], LanguageModel],
        workers: int,
        folder: RunFolder,
        progress: Progress,
        calls: int,
    ) -> None:
        self._hire, self._make_model, self._most = hire, make_model, workers
        self._folder, self._progress = folder, Counted(plan, progress)
        self._agenda = Agenda(plan.units, DEATHS)
        self._calls = CallThreads(calls)
        self._model: LanguageModel | None = None
        self._crew: dict[int, Worker] = {}
        self._started = 0
        folder.expect(plan.to_run)

    @property
    def summary(self) -> RunSummary:
        return self._progress.summary

    def run(self) -> None:
        self._fill_crew()
        while self._crew:
            wired = {it.wire.connection: it for it in self._crew.values() if it.wire is not None}
            if not wired and self._agenda.is_finished:
                return  # the others never began, and need not any more
            for ready in _wait(list(wired)):
                self._listen(wired[ready])
            for worker in [it for it in self._crew.values() if it.wire is None and it.has_ended()]:
                self._bury(worker)
            if not self._calls.failures.empty():
                raise self._calls.failures.get()

    def close(self) -> None:
        for worker in self._crew.values():
            worker.stop()
        self._calls.close(PATIENCE_S)

    def _fill_crew(self) -> None:
        for _ in range(min(self._most - len(self._crew), self._agenda.open_units)):
            self._crew[self._started] = self._hire(self._started)
            self._started += 1

    def _listen(self, worker: Worker) -> None:
        wire = worker.wire
        asked = None if wire is None else wire.question()
        if asked is None or wire is None:
            self._bury(worker)
            return
        number, question = asked
        if isinstance(question, ModelQuestion):
            if self._model is None:
                self._model = self._make_model()
            self._calls.make(partial(_ask, self._model, wire, number, question))
        else:
            wire.answer(number, self._answer(worker.number, question))

    def _bury(self, worker: Worker) -> None:
        """The worker is gone: it left, or was killed, or failed."""
        killed, death = worker.is_killed(), worker.death
        worker.stop()
        del self._crew[worker.number]
        if killed or self._agenda.has_begun(worker.number):
            self._agenda.lose(worker.number, death)
            self._fill_crew()
        elif not self._agenda.is_dismissed(worker.number):
            raise WorkerError(
                f"a worker process ended with {death} before its first episode; what it wrote is above"
            )

    def _answer(self, worker: int, question: object) -> Any:
        match question:
            case NextUnit():
                return self._agenda.next(worker)
            case FindRecord(key):
                why = self._agenda.given_up(key.id)
                return self._folder.find(key) if why is None else Raised.of(EpisodeError(f"{key.id}: {why}"))
            case AddRecord(key, record, True):
                self._folder.add(key, record)
                self._progress.finished(record)
            case AddRecord(key, record, False):
                self._folder.add_unfinished(key, record)
            case AddFailure(failure):
                self._progress.failed(failure)
                self._folder.add_failure(failure)
            case Started(episode):
                self._agenda.note_episode(worker, episode)
                self._progress.started(episode)
            case Raised():
                raise question.error()
            case _:
                raise TypeError(f"a worker asked {question!r}")
        return None


def _wait(connections: list[Connection]) -> list[Connection]:
    """Those on which somebody asks, or hung up, within a moment."""
    if not connections:
        time.sleep(LOOK_S)
    return [it for it in wait(connections, LOOK_S) if isinstance(it, Connection)]


def _ask(model: LanguageModel, wire: Wire, number: int, question: ModelQuestion) -> None:
    try:
        answer = _answer_of(model, question)
    except AdhocError as error:
        answer = Raised.of(error)
    wire.answer(number, answer)


def _answer_of(model: LanguageModel, question: ModelQuestion) -> Any:
    match question:
        case AboutModel():
            return ModelFacts(model.name, model.window)
        case CountTokens(messages):
            return model.count_tokens(messages)
        case BeginEpisode(episode, seed):
            return model.begin_episode(episode, seed)
        case Complete(request):
            return replace(model.complete(request), raw=None)
        case MayGoTogether(requests):
            return model.may_go_together(requests)
        case Note(stage, outcome):
            return model.note(stage, outcome)
