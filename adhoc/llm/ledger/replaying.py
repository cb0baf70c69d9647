"""Replaying a run from its ledger alone: no key, no model, no network."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import LedgerError
from adhoc.llm.ledger.entry import Header
from adhoc.llm.ledger.index import open_ledger
from adhoc.llm.ledger.key import CallKeys
from adhoc.llm.ledger.nearest import nearest_difference
from adhoc.llm.ledger.reader import existing_files
from adhoc.llm.ledger.storable import storable
from adhoc.llm.ledger.translation import call_entry, given
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse


class ReplayModel(LanguageModel):
    """Gives the recorded answers, and nothing else: it stands in for `LedgerModel` and all that is inside.

    Name, window and settings are those of the recorded model.

    Args:
        path: The ledger: a folder, or a single file.
        model: The name of the recorded model; needed only where the ledger holds several.
        settings: How the recorded model was set up, as `LedgerModel` was told; None takes the only settings
            there are. Others than those that were recorded are an error, since they would have decided
            other answers.
        counts_like: Counts tokens as the recorded model did, which decides what a prompt leaves out when
            the window is full; it is never asked anything. None estimates from the number of characters.

    Raises:
        LedgerError: there is no ledger, it is damaged, or it does not hold exactly one such model.
    """

    def __init__(
        self,
        path: str | Path,
        model: str | None = None,
        settings: Mapping[str, Any] | None = None,
        counts_like: LanguageModel | None = None,
    ) -> None:
        existing_files(path)
        self._path, self._counts_like = Path(path), counts_like
        self._ledger = open_ledger(path)
        self._header = _only_header(_of_model(self._ledger.headers, model, self._path), settings, self._path)
        self._keys = CallKeys(self._header.model, self._header.settings)

    @property
    def name(self) -> str:
        """The recorded model's name."""
        return self._header.model

    @property
    def window(self) -> int | None:
        """The recorded model's longest prompt, in tokens."""
        return self._header.window

    def count_tokens(self, messages: Sequence[ChatMessage]) -> int:
        """See `LanguageModel`."""
        if self._counts_like is not None:
            return self._counts_like.count_tokens(messages)
        return super().count_tokens(messages)

    def begin_episode(self, episode: str, seed: int) -> None:
        """See `LanguageModel`."""
        self._keys.begin_episode(episode)

    def may_go_together(self, requests: Sequence[LMRequest]) -> bool:
        """See `LanguageModel`. Not equal requests of one robot, which only their order tells apart."""
        return self._keys.are_different(requests)

    def complete(self, request: LMRequest) -> LMResponse:
        """The recorded answer.

        Raises:
            ReplyError: it was of no use, as recorded.
            LedgerError: there is none; the text says who asked, and how the nearest recorded call differs.
        """
        key, repeat = self._keys.next(request)
        answer = self._ledger.find(key)
        if answer is not None:
            return given(answer)
        asked = call_entry(key, repeat, request, request.model or self.name)
        raise LedgerError(
            f"{self._path}: holds no answer to a call of stage {asked.stage!r}, agent {asked.agent!r} and "
            f"episode {asked.episode!r} (key {key}); {nearest_difference(self._path, asked, request)}"
        )


def _of_model(headers: Sequence[Header], model: str | None, path: Path) -> list[Header]:
    """The headers of the one recorded model that is meant."""
    found = [header for header in headers if model in (None, header.model)]
    names = ", ".join(map(repr, sorted({header.model for header in headers})))
    if not found:
        raise LedgerError(f"{path}: holds no calls of model {model!r}, but of {names}")
    if len({header.model for header in found}) > 1:
        raise LedgerError(f"{path}: holds calls of several models: say which of {names}")
    return found


def _only_header(headers: Sequence[Header], settings: Mapping[str, Any] | None, path: Path) -> Header:
    """The last header with these settings of one model."""
    last = headers[-1]
    if settings is not None:
        wanted = storable(settings)
        fitting = [header for header in headers if header.settings == wanted]
        if not fitting:
            raise LedgerError(
                f"{path}: holds calls of {last.model!r} with other settings: {_apart(last.settings, wanted)}"
            )
        return fitting[-1]
    different = next((it for it in headers if it.settings != last.settings), None)
    if different is not None:
        raise LedgerError(
            f"{path}: holds calls of {last.model!r} with several settings, {different.settings} and "
            f"{last.settings}: say which"
        )
    return last


def _apart(there: Mapping[str, Any], here: Mapping[str, Any]) -> str:
    names = sorted(name for name in {*there, *here} if there.get(name) != here.get(name))
    return "; ".join(f"{name} ({there.get(name)!r} there, {here.get(name)!r} here)" for name in names)
