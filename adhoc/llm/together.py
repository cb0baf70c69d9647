"""Asking several independent questions at once."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from concurrent.futures import Future, wait
from queue import Empty, SimpleQueue

from adhoc.core.errors import ReplyError
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse

MOST_AT_ONCE = 16
"""Threads of one call of `complete_together`; how many calls reach the provider is for `CallLimiter`."""
PATIENCE_S = 10.0
"""Seconds that calls in flight are given to be answered, and so be recorded, when somebody interrupts."""

Answer = LMResponse | ReplyError


def complete_together(model: LanguageModel, requests: Sequence[LMRequest]) -> list[LMResponse]:
    """The answers to requests of which none needs another's answer, in the order of the requests.

    They are asked at the same time, and the order in which answers arrive changes nothing. A model that
    could not keep that promise (`may_go_together`) is asked one by one.

    Raises:
        ModelError, BudgetReached, ...: the first of these, in the order of the requests.
        ReplyError: else, the first of these. In either case no call is under way any more, and a bad reply
            to one request keeps no other from being asked.
    """
    return [response_of(answer) for answer in ask_together(model, requests)]


def ask_together(model: LanguageModel, requests: Sequence[LMRequest]) -> list[Answer]:
    """As `complete_together`, with the ReplyError in the place of an answer of which nothing can be used.

    An interruption (Ctrl-C) waits `PATIENCE_S` for calls in flight, and not for what a provider that does
    not answer might take; requests that did not go out by then never do.
    """
    if len(requests) < 2 or not model.may_go_together(requests):
        return [_ask(model, request) for request in requests]
    asked: list[Future[Answer]] = [Future() for _ in requests]
    queue: SimpleQueue[tuple[LMRequest, Future[Answer]]] = SimpleQueue()
    for pair in zip(requests, asked):
        queue.put(pair)
    try:
        for _ in range(min(len(requests), MOST_AT_ONCE)):
            threading.Thread(target=_ask_all, args=(model, queue), name="adhoc-model", daemon=True).start()
        wait(asked)
    except BaseException:
        for one in asked:
            one.cancel()
        wait(asked, PATIENCE_S)
        raise
    return [one.result() for one in asked]


def _ask_all(model: LanguageModel, queue: SimpleQueue[tuple[LMRequest, Future[Answer]]]) -> None:
    """The life of a thread. It keeps no process from ending: a call that hangs must not hang the end."""
    while True:
        try:
            request, answer = queue.get_nowait()
        except Empty:
            return
        if not answer.set_running_or_notify_cancel():
            continue
        try:
            answer.set_result(_ask(model, request))
        except BaseException as error:  # noqa: BLE001  (raised again by the thread that waits)
            answer.set_exception(error)


def _ask(model: LanguageModel, request: LMRequest) -> Answer:
    try:
        return model.complete(request)
    except ReplyError as error:
        return error


def response_of(answer: Answer) -> LMResponse:
    """The answer, if it is one. Raises the ReplyError that it is else."""
    if isinstance(answer, ReplyError):
        raise answer
    return answer
