"""What litellm's exceptions mean for somebody who has to do something about them."""

from __future__ import annotations

from types import ModuleType

from adhoc.core.errors import AdhocError, ModelBusy, ModelError, ReplyError

_UNREACHABLE = ("ConnectError", "ConnectionRefusedError", "gaierror")
_SHOWN = 300


def meaning(litellm: ModuleType, error: Exception, model: str, api_base: str | None) -> AdhocError:
    """The error to raise instead of litellm's: it says what to do, and its type whether to ask again.

    `ModelError`: nothing will help but a change of configuration. `ModelBusy`: later may work.
    `ReplyError`: the model cannot answer this prompt, or answered in no known form.
    """
    kinds = litellm.exceptions
    said = " ".join(str(error).split())[:_SHOWN]
    if isinstance(error, kinds.ContextWindowExceededError):
        return ReplyError(f"{model}: the prompt exceeds the context window: {said}", "truncated")
    if isinstance(error, kinds.AuthenticationError) or getattr(error, "status_code", None) == 403:
        return ModelError(f"{model}: the key was refused; set a valid one: {said}")
    if isinstance(error, kinds.NotFoundError):
        return ModelError(f"{model}: the endpoint does not know it; check `model` and `api_base`: {said}")
    if isinstance(error, kinds.RateLimitError):
        if "insufficient_quota" in str(error):
            return ModelError(f"{model}: the account's quota is used up: {said}")
        return ModelBusy(f"{model}: rate limit reached; try again later: {said}")
    if isinstance(error, kinds.Timeout):
        return ModelBusy(f"{model}: no answer in time; raise `timeout`, or try again later: {said}")
    if isinstance(error, kinds.BadRequestError):
        return ModelError(f"{model}: the request was refused; check `model` and `json_mode`: {said}")
    return _server_trouble(error, model, api_base or "the provider", said)


def _server_trouble(error: Exception, model: str, endpoint: str, said: str) -> AdhocError:
    """litellm reports alike: nobody there, an answer in no known form, and a passing fault."""
    causes = _causes(error)
    if any(type(cause).__name__ in _UNREACHABLE for cause in causes):
        return ModelError(
            f"{model}: {endpoint} cannot be reached; check `api_base`, the network, and that a local server "
            f"runs: {said}"
        )
    if any(isinstance(cause, (ValueError, TypeError, AttributeError)) for cause in causes):
        return ReplyError(f"{model}: {endpoint} answered with no chat completion: {said}")
    return ModelBusy(f"{model}: {endpoint} has a fault; try again later: {said}")


def _causes(error: BaseException) -> list[BaseException]:
    """The error and what led to it, in order."""
    chain: list[BaseException] = []
    current: BaseException | None = error
    while current is not None and current not in chain:
        chain.append(current)
        current = current.__cause__ or current.__context__
    return chain
