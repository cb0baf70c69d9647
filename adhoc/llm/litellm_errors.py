"""What litellm's exceptions mean for somebody who has to do something about them."""

from __future__ import annotations

import os
import re
import time
from dataclasses import dataclass
from email.utils import parsedate_to_datetime
from types import ModuleType

from adhoc.core.errors import AdhocError, ModelBusy, ModelError, ReplyError
from adhoc.llm.structured_output import FormRefused

_NO_CONNECTION = {
    "ConnectError",
    "ConnectTimeout",
    "ConnectionRefusedError",
    "UnsupportedProtocol",
    "InvalidURL",
}
_BROKEN_CONNECTION = {"TransportError", "OSError"}
"""Errors of httpx and Python, by the names of their classes."""
_SHOWN = 300
_HIDDEN = "[key]"
_SECRET = re.compile(r"(?i)\b(?:sk|pk|key|bearer|api[-_]?key)[-_:= ]+[\w*.…-]{8,}")


@dataclass(frozen=True)
class Endpoint:
    """Who was asked, for the sentences that errors say."""

    model: str
    api_base: str | None
    key_variable: str
    """The environment variable that the key comes from."""
    has_answered: bool
    """Whether it ever gave a proper answer: then trouble with the connection is an outage, which passes."""


def meaning(litellm: ModuleType, error: Exception, asked: Endpoint) -> AdhocError:
    """The error to raise instead of litellm's: it says what to do, and its type whether to ask again.

    `ModelError`: nothing will help but a change of configuration. `ModelBusy`: later may work.
    `ReplyError`: the provider will not answer this prompt.
    """
    kinds, status = litellm.exceptions, getattr(error, "status_code", None)
    if isinstance(error, kinds.ContextWindowExceededError):
        return _hopeless(asked, error, "the prompt exceeds the model's context window; set llm.window to it")
    if isinstance(error, kinds.ContentPolicyViolationError):
        return ReplyError(
            f"{asked.model}: the provider's filter refused the prompt: {_said(error, asked)}", "empty"
        )
    if status == 402 or "insufficient_quota" in _codes(error):
        return _hopeless(asked, error, "the account's quota is used up; add credit, or use another model")
    if status in (401, 403):
        return _hopeless(
            asked, error, f"the key was refused; put one that this provider issued into {asked.key_variable}"
        )
    if isinstance(error, kinds.NotFoundError):
        return _hopeless(asked, error, "the endpoint does not know it; check llm.model and llm.api_base")
    if isinstance(error, kinds.RateLimitError):
        return ModelBusy(
            f"{asked.model}: rate limit reached; try again later: {_said(error, asked)}",
            _retry_after(error),
            True,
        )
    if isinstance(error, (kinds.BadRequestError, kinds.UnprocessableEntityError)):
        what_to_do = "check llm.model, llm.structured and llm.temperature (null leaves it away)"
        return FormRefused(f"{asked.model}: the request was refused; {what_to_do}: {_said(error, asked)}")
    return _trouble(error, isinstance(error, kinds.Timeout), asked)


def _trouble(error: Exception, is_late: bool, asked: Endpoint) -> AdhocError:
    """litellm reports alike: nobody there, an answer in no known form, and a passing fault."""
    kinds = {kind.__name__ for cause in _causes(error) for kind in type(cause).__mro__}
    endpoint = asked.api_base or "the provider"
    if kinds & _NO_CONNECTION and not asked.has_answered:
        return _hopeless(
            asked,
            error,
            f"{endpoint} cannot be reached; check llm.api_base, the network, and that a local server runs",
        )
    if is_late:
        return ModelBusy(
            f"{asked.model}: no answer in time; raise llm.timeout, or try later: {_said(error, asked)}"
        )
    if asked.has_answered or kinds & _BROKEN_CONNECTION or _server_fault(error):
        said = _said(error, asked)
        return ModelBusy(
            f"{asked.model}: {endpoint} has a fault; try again later: {said}", _retry_after(error)
        )
    return _hopeless(
        asked,
        error,
        f"{endpoint} answers, but not with chat completions; check llm.api_base (most end in /v1)",
    )


def _hopeless(asked: Endpoint, error: Exception, what_to_do: str) -> ModelError:
    return ModelError(f"{asked.model}: {what_to_do}: {_said(error, asked)}")


def _said(error: Exception, asked: Endpoint) -> str:
    """The provider's words in one short line, without keys."""
    said = " ".join(str(error).split())
    secret = os.environ.get(asked.key_variable)
    if secret:
        said = said.replace(secret, _HIDDEN)
    return _SECRET.sub(_HIDDEN, said)[:_SHOWN]


def _codes(error: Exception) -> set[str]:
    """The provider's short names of what is wrong."""
    return {str(getattr(cause, "code", None)) for cause in _causes(error)}


def _server_fault(error: Exception) -> bool:
    """Whether the server itself said so; litellm's own exceptions carry a status even without an answer."""
    answers = [
        getattr(cause, "response", None)
        for cause in _causes(error)
        if type(cause).__name__.endswith("HTTPStatusError")
    ]
    return any(getattr(answer, "status_code", 0) >= 500 for answer in answers)


def _retry_after(error: Exception) -> float | None:
    """Seconds that the provider asks to wait, from its header in either form; None if it says nothing."""
    for cause in _causes(error):
        said = getattr(getattr(cause, "response", None), "headers", {}).get("retry-after")
        if said is None:
            continue
        try:
            return max(0.0, float(said))
        except ValueError:
            return _seconds_until(said)
    return None


def _seconds_until(date: str) -> float | None:
    try:
        return max(0.0, parsedate_to_datetime(date).timestamp() - time.time())
    except ValueError:
        return None


def _causes(error: BaseException) -> list[BaseException]:
    """The error and what led to it, in order."""
    chain: list[BaseException] = []
    current: BaseException | None = error
    while current is not None and current not in chain:
        chain.append(current)
        current = current.__cause__ or current.__context__
    return chain
