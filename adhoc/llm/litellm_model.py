"""Any hosted or local chat model, by way of litellm: one HTTP call per request."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import ModuleType
from typing import Any

from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.llm.litellm_access import (
    any_error,
    check_usable,
    context_window,
    key_variable,
    load_litellm,
    missing_keys,
    price,
)
from adhoc.llm.litellm_errors import Endpoint, meaning
from adhoc.llm.model import ChatMessage, LanguageModel, LMRequest, LMResponse, Usage
from adhoc.llm.structured_output import AUTO, FormRefused, StructuredOutput, response_format

_PLACEHOLDER_KEY = "not-needed"
"""Sent to an endpoint of one's own where no key is set; litellm insists on some key."""
_SEEDS = 2**31


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
        structured: How replies are held to their form: `schema`, `json`, `text`, or `auto`, which asks for
            the strictest that the model takes (see `structured_output`).
        window: The longest prompt in tokens; None: by litellm's list, if the model is in it.
        name: What records say; `model` by default.

    Raises:
        ConfigurationError: a number is out of range, or `structured` is unknown.
    """

    def __init__(
        self,
        model: str,
        temperature: float | None = 0.3,
        timeout: float = 60.0,
        max_tokens: int | None = None,
        api_base: str | None = None,
        structured: str = AUTO,
        window: int | None = None,
        name: str | None = None,
    ) -> None:
        if timeout <= 0 or min(max_tokens or 1, window or 1) < 1 or 0 in (max_tokens, window):
            raise ConfigurationError(
                f"LiteLLMModel: timeout={timeout} must be positive, max_tokens={max_tokens} and "
                f"window={window} at least 1"
            )
        self._model, self._temperature, self._timeout = model, temperature, timeout
        self._max_tokens, self._api_base, self._window = max_tokens, api_base, window
        self._structured = StructuredOutput(structured)
        self._name = name or model
        self._usable: set[str] = set()
        self._has_answered = False

    @property
    def name(self) -> str:
        """The name given at construction, else litellm's name of the model."""
        return self._name

    @property
    def window(self) -> int | None:
        """See `LanguageModel`; as configured, else by litellm's list."""
        return self._window or context_window(load_litellm(), self._model)

    def count_tokens(self, messages: Sequence[ChatMessage]) -> int:
        """See `LanguageModel`; by litellm's tokenizers that need no network, near enough for any model."""
        return int(load_litellm().token_counter(model=self._model, messages=_plain(messages)))

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`.

        `sample` is added to the seed, so that repeated samples are not all the same.

        Raises:
            ModelError: no key, key refused, quota used up, model unknown, endpoint unreachable or no model's,
                prompt longer than the context window, request refused.
            ModelBusy: rate limit, server fault, time-out; and an unreachable endpoint that answered before.
            ReplyError: `empty` without content; `truncated` if cut off at the token limit. Its `response` is
                what was paid for.
            MissingDependency: litellm is not installed.
        """
        litellm, model = load_litellm(), request.model or self._model
        if self._api_base is None and model not in self._usable:
            check_usable(litellm, model)
            self._usable.add(model)
        started = time.monotonic()
        answer = self._ask(litellm, model, request)
        response = LMResponse(
            text="",
            model=request.model or self._name,
            usage=_usage(litellm, answer, model),
            latency_s=time.monotonic() - started,
            raw=json.loads(answer.model_dump_json()),
        )
        self._has_answered = True
        return self._filled(response, answer, request)

    def _filled(self, response: LMResponse, answer: Any, request: LMRequest) -> LMResponse:
        """The response with the text of the answer. Raises ReplyError if there is none to be used."""
        if not answer.choices:
            raise ReplyError(f"{response.model}: the reply has no choices", "empty", response)
        choice = answer.choices[0]
        response = replace(
            response, text=choice.message.content or "", finish_reason=choice.finish_reason or "stop"
        )
        if response.finish_reason == "length":
            raise ReplyError(
                f"{response.model}: the reply was cut off at {self._limit(request)} tokens",
                "truncated",
                response,
            )
        if not response.text:
            raise ReplyError(
                f"{response.model}: the reply has no content (finish reason {response.finish_reason})",
                "empty",
                response,
            )
        return response

    def _ask(self, litellm: ModuleType, model: str, request: LMRequest) -> Any:
        """litellm's answer, in the strictest form that the endpoint takes."""
        arguments = self._arguments(litellm, model, request)
        if request.reply is None:
            return self._send(litellm, arguments)
        *stricter, freest = self._structured.forms(litellm, model, self._api_base is not None)
        for form in stricter:
            try:
                answer = self._send(litellm, {**arguments, **response_format(form, request.reply)})
            except FormRefused:
                continue
            self._structured.accept(model, form)
            return answer
        answer = self._send(litellm, {**arguments, **response_format(freest, request.reply)})
        self._structured.accept(model, freest)
        return answer

    def _send(self, litellm: ModuleType, arguments: Mapping[str, Any]) -> Any:
        """One HTTP call."""
        try:
            return litellm.completion(**arguments)
        except any_error() as error:
            model = arguments["model"]
            endpoint = Endpoint(model, self._api_base, key_variable(litellm, model), self._has_answered)
            raise meaning(litellm, error, endpoint) from error

    def _arguments(self, litellm: ModuleType, model: str, request: LMRequest) -> dict[str, Any]:
        """What is sent, but for the form of the reply."""
        temperature = self._temperature if request.temperature is None else request.temperature
        optional = {"temperature": temperature, "api_base": self._api_base}
        if request.seed is not None and "seed" in (litellm.get_supported_openai_params(model) or ()):
            optional["seed"] = (request.seed + request.sample) % _SEEDS
        if self._api_base is not None and missing_keys(litellm, model):
            optional["api_key"] = _PLACEHOLDER_KEY
        return {
            "model": model,
            "messages": _plain(request.messages),
            "max_tokens": self._limit(request),
            "timeout": self._timeout,
            "max_retries": 0,
            **{key: value for key, value in optional.items() if value is not None},
        }

    def _limit(self, request: LMRequest) -> int:
        return request.max_tokens if self._max_tokens is None else min(request.max_tokens, self._max_tokens)


def _plain(messages: Sequence[ChatMessage]) -> list[dict[str, str]]:
    return [{"role": message.role, "content": message.content} for message in messages]


def _usage(litellm: ModuleType, answer: Any, model: str) -> Usage:
    usage = getattr(answer, "usage", None)
    return Usage(
        int(getattr(usage, "prompt_tokens", 0) or 0),
        int(getattr(usage, "completion_tokens", 0) or 0),
        price(litellm, answer, model),
    )
