"""Work of several robots in one step, whose questions to language models go out together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextvars import ContextVar
from itertools import groupby
from threading import Semaphore, Thread
from typing import Generic, TypeVar

from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper
from adhoc.llm.together import Answer, ask_together, response_of

T = TypeVar("T")


class GatheringModel(Wrapper):
    """A language model that is otherwise `inner`, whose questions wait within `side_by_side` for those of
    the other jobs. All that such jobs ask should go through one such model: it is asked for them together."""

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`."""
        job = _current.get()
        return self._inner.complete(request) if job is None else job.ask(self._inner, request)


def side_by_side(jobs: Sequence[Callable[[], T]]) -> list[T]:
    """What independent jobs return, in their order.

    Only one of them runs at a time, in their order, each until it asks a `GatheringModel` something or ends;
    then the questions of all go out together (see `ask_together`), and the jobs go on with the answers, in
    their order. So what comes of them does not depend on the order in which answers arrive.

    Raises:
        What the first job raises, in their order; or what asking for them raises. Jobs that are still waiting
        for an answer then are given up.
    """
    if len(jobs) < 2:
        return [job() for job in jobs]
    running = [_Job(job) for job in jobs]
    try:
        waiting = _go_on(running)
        while waiting:
            _answer(waiting)
            waiting = _go_on(waiting)
    finally:
        for job in running:
            job.give_up()
    return [job.result() for job in running]


class _Job(Generic[T]):
    """A job in a thread of its own, which runs only while `go_on` waits for it."""

    def __init__(self, work: Callable[[], T]) -> None:
        self._work = work
        self._turn, self._yielded = Semaphore(0), Semaphore(0)
        self._thread = Thread(target=self._run, name="adhoc-job", daemon=True)
        self._given_up = False
        self._results: list[T] = []
        self.error: BaseException | None = None
        self.question: tuple[LanguageModel, LMRequest] | None = None
        self.answer: Answer | None = None

    def go_on(self) -> bool:
        """Run until the job asks (True) or ends (False)."""
        self.question = None
        if self._thread.ident is None:
            self._thread.start()
        self._turn.release()
        self._yielded.acquire()
        return self.question is not None

    def ask(self, model: LanguageModel, request: LMRequest) -> LMResponse:
        """Called by the job: hand over a question and wait for its answer."""
        if self._given_up:
            raise _GivenUp
        self.question = (model, request)
        self._yielded.release()
        self._turn.acquire()
        if self._given_up or self.answer is None:
            raise _GivenUp
        return response_of(self.answer)

    def give_up(self) -> None:
        """End a job that waits for an answer, or as soon as it would; nothing for one that has ended."""
        self._given_up = True
        if self.question is not None:
            self.go_on()
        if self._results or self.error is not None:
            self._thread.join()

    def result(self) -> T:
        """What the job returned. Raises what it raised."""
        if self.error is not None:
            raise self.error
        return self._results[0]

    def _run(self) -> None:
        self._turn.acquire()
        _current.set(self)  # type: ignore[arg-type]
        try:
            self._results.append(self._work())
        except BaseException as error:  # noqa: BLE001  (raised again by the thread that waits)
            self.error = error
        self._yielded.release()


class _GivenUp(BaseException):
    """Ends a job whose question nobody will answer any more."""


_current: ContextVar[_Job[object] | None] = ContextVar("adhoc_job", default=None)


def _go_on(jobs: Sequence[_Job[T]]) -> list[_Job[T]]:
    """Let each run on; those that ask. Raises the first error of one, before the jobs after it go on."""
    waiting = []
    for job in jobs:
        if job.go_on():
            waiting.append(job)
        elif job.error is not None:
            raise job.error
    return waiting


def _answer(jobs: Sequence[_Job[T]]) -> None:
    """Ask for all; neighbours that ask the same model together."""
    asked = [(job, *job.question) for job in jobs if job.question is not None]
    for _, group in groupby(asked, key=lambda entry: id(entry[1])):
        together = list(group)
        answers = ask_together(together[0][1], [request for _, _, request in together])
        for (job, _, _), answer in zip(together, answers):
            job.answer = answer
