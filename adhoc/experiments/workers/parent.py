"""The one process that owns the language model and the run folder while workers run the episodes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from multiprocessing.connection import wait
from typing import Any

from adhoc.core.errors import AdhocError, ConfigurationError, WorkerError
from adhoc.evaluation.records import Record
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.run import Progress, RunSummary
from adhoc.experiments.workers.agenda import Agenda
from adhoc.experiments.workers.calls import CallThreads
from adhoc.experiments.workers.comparison import MakeComparison
from adhoc.experiments.workers.crew import Worker
from adhoc.experiments.workers.messages import (
    AboutModel,
    AddRecord,
    BeginEpisode,
    Complete,
    CountTokens,
    FindRecord,
    Finished,
    MayGoTogether,
    ModelFacts,
    ModelQuestion,
    NextScenario,
    Note,
    Raised,
    Ready,
    Skipped,
    Started,
)
from adhoc.llm.model import LanguageModel
from adhoc.llm.together import PATIENCE_S

DEATHS = 3
"""So many workers that died in one episode end the run."""
LOOK_S = 0.5
"""Seconds after which the parent looks for trouble in its own threads, whether or not a worker asks."""


def run_in_workers(
    make: MakeComparison,
    make_model: Callable[[], LanguageModel],
    workers: int,
    folder: RunFolder,
    progress: Progress,
    calls: int = 16,
) -> RunSummary:
    """`run_comparison` in several processes; the records are the same, in the order in which they are done.

    Workers take one scenario at a time: its episode of the team alone, then that with the newcomer. Their
    language model is this process's: a call that was begun is answered, and recorded if the model records,
    whether or not the worker that asked still lives. A worker that is killed is replaced, and its scenario
    begun again.

    Args:
        make: Builds what is compared, in every worker.
        make_model: Builds the model that stands behind all workers; called when one asks for it first. The
            model must bear calls from several threads.
        workers: How many processes, at least 1.
        folder: Where records are and go.
        progress: Is told what happens, always from this thread.
        calls: How many calls of the model may be under way at once, at least 1.

    Raises:
        ConfigurationError: A number is out of range.
        WorkerError: A worker ended by itself, or `DEATHS` of them were killed in one episode.
        AdhocError: Whatever `run_comparison` raises in a worker; the other workers are stopped.
    """
    if workers < 1 or calls < 1:
        raise ConfigurationError(f"workers={workers} and calls={calls} must be at least 1")
    parent = _Parent(make, make_model, workers, folder, progress, calls)
    try:
        parent.run()
    finally:
        parent.close()
    return parent.summary


class _Parent:
    """Answers what workers ask, until there is nothing left to do."""

    def __init__(
        self,
        make: MakeComparison,
        make_model: Callable[[], LanguageModel],
        workers: int,
        folder: RunFolder,
        progress: Progress,
        calls: int,
    ) -> None:
        self._make, self._make_model, self._most = make, make_model, workers
        self._folder, self._progress = folder, progress
        self._agenda = Agenda(DEATHS)
        self._calls = CallThreads(calls)
        self._model: LanguageModel | None = None
        self._crew: dict[int, Worker] = {}
        self._started = 0
        self._stored: set[str] = set()
        self._finished: set[str] = set()
        self._skipped: set[str] = set()

    @property
    def summary(self) -> RunSummary:
        return RunSummary(len(self._finished), len(self._skipped))

    def run(self) -> None:
        self._fill_crew()
        while self._crew:
            by_connection = {worker.connection: worker for worker in self._crew.values()}
            for ready in wait(list(by_connection), LOOK_S):
                self._listen(by_connection[ready])  # type: ignore[index]
            if not self._calls.failures.empty():
                raise self._calls.failures.get()

    def close(self) -> None:
        for worker in self._crew.values():
            worker.stop()
        self._calls.close(PATIENCE_S)

    def _fill_crew(self) -> None:
        while self._agenda.has_work and len(self._crew) < self._most:
            self._crew[self._started] = Worker(self._started, self._make)
            self._started += 1

    def _listen(self, worker: Worker) -> None:
        try:
            number, question = worker.connection.recv()
        except (EOFError, OSError):  # OSError: it was killed while it said something long
            self._bury(worker)
            return
        if isinstance(question, ModelQuestion):
            if self._model is None:
                self._model = self._make_model()
            self._calls.make(partial(_ask, self._model, worker, number, question))
        else:
            worker.answer(number, self._answer(worker.number, question))

    def _bury(self, worker: Worker) -> None:
        """The worker is gone: it left, or was killed, or failed."""
        killed, death = worker.is_killed(), worker.death
        worker.stop()
        del self._crew[worker.number]
        if killed:
            self._agenda.lose(worker.number, death)
            self._fill_crew()
        elif not self._agenda.is_dismissed(worker.number):
            raise WorkerError(
                f"episode {self._agenda.episode(worker.number)!r}: its worker process ended with {death}; "
                "what it wrote before is above"
            )

    def _answer(self, worker: int, question: object) -> Any:
        match question:
            case Ready(scenarios, episodes):
                if not self._agenda.is_known:
                    self._agenda.fill(scenarios)
                    self._progress.begin(len(scenarios) * episodes)
            case NextScenario():
                return self._agenda.next(worker)
            case FindRecord(key):
                return self._folder.find(key)
            case AddRecord(key, record, True):
                self._folder.add(key, record)
                self._stored.add(key.id)
            case AddRecord(key, record, False):
                self._folder.add_unfinished(key, record)
            case Started(episode):
                self._agenda.note_episode(worker, episode)
                self._progress.started(episode)
            case Skipped(record) | Finished(record):
                self._tell(record)
            case Raised():
                raise question.error()
            case _:
                raise TypeError(f"a worker asked {question!r}")
        return None

    def _tell(self, record: Record) -> None:
        """Once for each episode: a worker that replaces another one finds again what that had found or
        finished."""
        episode = record["episode_id"]
        if episode in self._finished | self._skipped:
            return
        if episode in self._stored:
            self._finished.add(episode)
            self._progress.finished(record)
        else:
            self._skipped.add(episode)
            self._progress.skipped(record)


def _ask(model: LanguageModel, worker: Worker, number: int, question: ModelQuestion) -> None:
    try:
        answer = _answer_of(model, question)
    except AdhocError as error:
        answer = Raised.of(error)
    worker.answer(number, answer)


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
