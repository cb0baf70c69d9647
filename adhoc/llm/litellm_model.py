"""Any hosted or local chat model, by way of litellm: one HTTP call per request."""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Mapping
from functools import lru_cache
from types import ModuleType
from typing import Any

from adhoc.core.errors import ConfigurationError, MissingDependency, ModelError, ReplyError
from adhoc.llm.litellm_errors import meaning
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage

_PLACEHOLDER_KEY = "not-needed"
"""Sent to an endpoint of one's own where no key is set; litellm insists on some key."""


class LiteLLMModel(LanguageModel):
    """A chat model that litellm knows how to reach.

    Keys come from the provider's usual environment variable (`OPENAI_API_KEY`, ...). There is no retry here:
    wrap the model in `RetryingModel` for that.

    Args:
        model: litellm's name, e.g. `gpt-4-1106-preview` (the paper's) or `openai/NAME` with `api_base`.
        temperature: The paper's is 0.3. None leaves it to the provider; some models refuse any other.
        timeout: Seconds for one call.
        max_tokens: The longest reply, where a request asks for more. None: what the request asks for.
        api_base: Address of an OpenAI-compatible endpoint, e.g. `http://127.0.0.1:8080/v1`.
        json_mode: Ask the provider for a JSON object (`response_format` of type `json_object`, the one that
            the paper's models understand). False for endpoints that refuse it.
        name: What records say; `model` by default.

    Raises:
        ConfigurationError: a number is out of range.
    """

    def __init__(
        self,
        model: str,
        temperature: float | None = 0.3,
        timeout: float = 60.0,
        max_tokens: int | None = None,
        api_base: str | None = None,
        json_mode: bool = True,
        name: str | None = None,
    ) -> None:
        if timeout <= 0 or (max_tokens is not None and max_tokens < 1):
            raise ConfigurationError(
                f"LiteLLMModel: timeout={timeout} must be positive and max_tokens={max_tokens} at least 1"
            )
        self._model, self._temperature, self._timeout = model, temperature, timeout
        self._max_tokens, self._api_base, self._json_mode = max_tokens, api_base, json_mode
        self._name = name or model
        self._is_ready = False

    @property
    def name(self) -> str:
        """The name given at construction, else litellm's name of the model."""
        return self._name

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`.

        Raises:
            ModelError: no key, key refused, model unknown, endpoint unreachable, request refused.
            ModelBusy: rate limit, server fault, time-out.
            ReplyError: `empty` without content; `truncated` if cut off at the token limit or if the prompt
                exceeds the model's context window; `unreadable` if the answer is no chat completion
                (where litellm tells it from a fault of the server).
            MissingDependency: litellm is not installed.
        """
        litellm = load_litellm()
        self._check_key(litellm)
        response = self._call(litellm, request)
        text, finish_reason = _first_choice(response, self._model)
        if finish_reason == "length":
            raise ReplyError(
                f"{self._model}: the reply was cut off at {self._limit(request)} tokens", "truncated"
            )
        if not text:
            raise ReplyError(
                f"{self._model}: the reply has no content (finish reason {finish_reason})", "empty"
            )
        return LMResponse(text, self._name, self._usage(litellm, response), finish_reason)

    def _call(self, litellm: ModuleType, request: LMRequest) -> Any:
        optional: dict[str, Any] = {"temperature": self._temperature, "api_base": self._api_base}
        if self._json_mode:
            optional["response_format"] = {"type": "json_object"}
        if self._api_base is not None and not _has_key(litellm, self._model):
            optional["api_key"] = _PLACEHOLDER_KEY
        try:
            return litellm.completion(
                model=self._model,
                messages=[{"role": it.role, "content": it.content} for it in request.messages],
                max_tokens=self._limit(request),
                timeout=self._timeout,
                max_retries=0,
                **{key: value for key, value in optional.items() if value is not None},
            )
        except _any_error() as error:
            raise meaning(litellm, error, self._model, self._api_base) from error

    def _check_key(self, litellm: ModuleType) -> None:
        """Without a key, litellm fails like a broken server, which looks as if trying again would help."""
        if self._is_ready or self._api_base is not None:
            return
        try:
            with _quiet():
                litellm.get_llm_provider(self._model)
        except litellm.exceptions.BadRequestError as error:
            raise ModelError(
                f"model {self._model!r}: litellm knows no provider of this name; write PROVIDER/NAME, "
                "e.g. openai/gpt-4o, or give `api_base`"
            ) from error
        missing = _missing_keys(litellm, self._model)
        if missing:
            raise ModelError(
                f"model {self._model!r} needs the environment variable {' and '.join(missing)}; set it, or "
                "use the offline reasoner (llm=offline), which needs no key"
            )
        self._is_ready = True

    def _limit(self, request: LMRequest) -> int:
        return request.max_tokens if self._max_tokens is None else min(request.max_tokens, self._max_tokens)

    def _usage(self, litellm: ModuleType, response: Any) -> Usage:
        usage = getattr(response, "usage", None)
        return Usage(
            int(getattr(usage, "prompt_tokens", 0) or 0),
            int(getattr(usage, "completion_tokens", 0) or 0),
            _cost(litellm, response, self._model),
        )


@lru_cache(maxsize=1)
def load_litellm() -> ModuleType:
    """litellm, imported without touching the network and without reading a stray `.env` file.

    Raises:
        MissingDependency: it is not installed.
    """
    os.environ.setdefault("LITELLM_LOCAL_MODEL_COST_MAP", "True")
    os.environ.setdefault("LITELLM_MODE", "PRODUCTION")
    try:
        import litellm
    except ImportError as error:
        raise MissingDependency("a hosted or local model needs litellm: pip install litellm") from error
    litellm.suppress_debug_info = True
    litellm.telemetry = False
    litellm.num_retries = 0
    module: ModuleType = litellm
    return module


def _any_error() -> type[Exception]:
    """The base of every error that litellm raises for a call."""
    import openai

    return openai.OpenAIError


def _missing_keys(litellm: ModuleType, model: str) -> list[str]:
    with _quiet():
        found: Mapping[str, Any] = litellm.validate_environment(model)
    return [] if found["keys_in_environment"] else [str(key) for key in found["missing_keys"]]


def _has_key(litellm: ModuleType, model: str) -> bool:
    return not _missing_keys(litellm, model)


def _first_choice(response: Any, model: str) -> tuple[str, str]:
    choices = getattr(response, "choices", None)
    if not choices:
        raise ReplyError(f"{model}: the reply has no choices", "empty")
    return choices[0].message.content or "", choices[0].finish_reason or "stop"


def _cost(litellm: ModuleType, response: Any, model: str) -> float:
    """US dollars by litellm's price list; 0 where the model is not in it."""
    with _quiet():
        try:
            short, provider, *_ = litellm.get_llm_provider(model)
        except litellm.exceptions.BadRequestError:
            return 0.0
        if not {model, short, f"{provider}/{short}"} & litellm.model_cost.keys():
            return 0.0
        return float(litellm.completion_cost(completion_response=response, model=model))


def _quiet() -> contextlib.AbstractContextManager[Any]:
    """litellm prints hints; a library does not."""
    return contextlib.redirect_stdout(io.StringIO())
