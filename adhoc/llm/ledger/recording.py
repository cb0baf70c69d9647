"""Recording every call of a language model, and asking nothing twice."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path
from threading import Lock
from typing import Any

from adhoc import __version__
from adhoc.core.errors import AdhocError, ReplyError
from adhoc.llm.ledger.entry import FORMAT, VERSION, Answer, Failure, Header
from adhoc.llm.ledger.index import open_ledger
from adhoc.llm.ledger.key import CallKeys
from adhoc.llm.ledger.storable import storable, without_keys
from adhoc.llm.ledger.translation import answer_entry, call_entry, given, refusal_entry, texts_of, utc_now
from adhoc.llm.ledger.writer import LedgerWriter
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper


class LedgerModel(Wrapper):
    """Answers from a ledger what was asked before, and records everything else that `inner` is asked.

    A call is in a file before it is made, and its answer before anybody sees it. Requests that are equal
    (see `CallKeys`) are one call, also while it is in flight: the second waits for the first. An answer that
    is of no use (`ReplyError`) was paid, so it is recorded and raised again; any other error is recorded,
    and the call made again when it is asked for again. Keys of providers are taken out of answers and errors.

    Args:
        inner: The model that is asked; with retries and caps, one call is one answer.
        folder: Where the ledger is and goes; this model writes one new file there.
        settings: How the model is set up, where that decides answers and requests do not say it, e.g.
            its temperature: a part of every key.
        wait_for_disk: Go on only when an entry is on the disk, so that not even a power failure loses
            anything; that takes some milliseconds a call. Otherwise what was written just before is lost
            then, and only then: not when the process is killed.

    Raises:
        LedgerError: the folder holds a ledger that is damaged, foreign or of another version. Nothing is
            asked and nothing written then.
    """

    def __init__(
        self,
        inner: LanguageModel,
        folder: str | Path,
        settings: Mapping[str, Any] | None = None,
        wait_for_disk: bool = False,
    ) -> None:
        super().__init__(inner)
        self._settings = {} if settings is None else storable(settings)
        self._ledger = open_ledger(folder)
        self._writer = LedgerWriter(folder, self._header, wait_for_disk)
        self._keys = CallKeys(self.name, self._settings)
        self._in_flight: dict[str, Future[Answer]] = {}
        self._lock = Lock()

    def begin_episode(self, episode: str, seed: int) -> None:
        """See `LanguageModel`. Equal requests of the episode are counted from 0, so that an episode that
        begins again is given the same answers."""
        self._keys.begin_episode(episode)
        super().begin_episode(episode, seed)

    def may_go_together(self, requests: Sequence[LMRequest]) -> bool:
        """See `LanguageModel`. Not equal requests of one robot, which only their order tells apart."""
        return self._keys.are_different(requests) and super().may_go_together(requests)

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. Raises LedgerError if a call cannot be recorded; before it is made, if so."""
        key, repeat = self._keys.next(request)
        with self._lock:
            known = self._ledger.find(key)
            flight = self._in_flight.get(key)
            if known is None and flight is None:
                mine = self._in_flight[key] = Future()
        if known is not None:
            return given(known)
        if flight is not None:
            return given(flight.result())
        return self._land(mine, key, repeat, request)

    def _land(self, flight: Future[Answer], key: str, repeat: int, request: LMRequest) -> LMResponse:
        """Make the call; whoever waits for it gets what comes of it, also an error."""
        try:
            answer = self._call(key, repeat, request)
        except BaseException as error:
            with self._lock:
                del self._in_flight[key]
            flight.set_exception(error)
            raise
        flight.set_result(answer)
        return given(answer, replayed=False)

    def _call(self, key: str, repeat: int, request: LMRequest) -> Answer:
        call = call_entry(key, repeat, request, request.model or self.name)
        self._writer.append(call, texts_of(request))
        started = time.perf_counter()
        try:
            response = self._inner.complete(request)
        except ReplyError as error:
            answer = refusal_entry(key, error, time.perf_counter() - started)
        except AdhocError as error:
            self._writer.append(Failure(key, type(error).__name__, without_keys(str(error)), utc_now()))
            raise
        else:
            answer = answer_entry(key, response, time.perf_counter() - started)
        place = self._writer.append(answer)
        with self._lock:
            self._ledger.add(key, *place)
            del self._in_flight[key]
        return answer

    def _header(self) -> Header:
        return Header(FORMAT, VERSION, __version__, self.name, self.window, self._settings, utc_now())
