"""A language model in this process: a GGUF file, run by llama.cpp by way of xllamacpp."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from threading import Lock
from typing import Any

from adhoc.core.errors import ConfigurationError, MissingDependency, ModelError, ReplyError
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage
from adhoc.llm.structured_output import FORMS, SCHEMA, response_format

_MAGIC = b"GGUF"
_QUIET = -1
_SEEDS = 2**31


class LocalModel(LanguageModel):
    """A model file on this machine. No key, no network; it costs nothing but time.

    The file is loaded at the first request, so that a recorded run can be replayed without it. Replies are
    held to their schema token by token, so that they have the right form, whatever they say.

    Small models plan badly: one of 135 million parameters does no better than chance. Use such a one to see
    whether everything is wired up, never for a result.

    Args:
        path: The GGUF file.
        temperature: The paper's is 0.3. None leaves it to llama.cpp.
        max_tokens: The longest reply, where a request asks for more. None: what the request asks for.
        structured: How replies are held to their form: `schema`, `json` (any JSON object), or `text`.
        window: The longest prompt in tokens, the reply included; memory grows with it.
        threads: Of the processor; None leaves it to llama.cpp. One is fastest on a machine that is busy.
        at_once: How many requests are answered at the same time, each with a window of its own.
        gpu_layers: How many layers go to a graphics card, where xllamacpp was built for one; None leaves it
            to llama.cpp.
        name: What records say; the file's name by default.

    Raises:
        ConfigurationError: a number is out of range, or `structured` is unknown.
    """

    def __init__(
        self,
        path: str | Path,
        temperature: float | None = 0.3,
        max_tokens: int | None = None,
        structured: str = SCHEMA,
        window: int = 8192,
        threads: int | None = None,
        at_once: int = 1,
        gpu_layers: int | None = None,
        name: str | None = None,
    ) -> None:
        counts = {"max_tokens": max_tokens, "window": window, "threads": threads, "at_once": at_once}
        for field, value in counts.items():
            if value is not None and value < 1:
                raise ConfigurationError(f"LocalModel: {field} is {value}, it must be at least 1")
        if structured not in FORMS:
            raise ConfigurationError(
                f"LocalModel: structured={structured!r}: must be one of {', '.join(FORMS)}"
            )
        self._path, self._temperature, self._max_tokens = Path(path), temperature, max_tokens
        self._structured, self._window = structured, window
        self._threads, self._at_once, self._gpu_layers = threads, at_once, gpu_layers
        self._name = name or self._path.name
        self._loading = Lock()
        self._server: Any = None

    @property
    def name(self) -> str:
        """The name given at construction, else that of the file."""
        return self._name

    @property
    def window(self) -> int:
        """See `LanguageModel`; as configured."""
        return self._window

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. `sample` is added to the seed, so that repeated samples are not all the same.

        Raises:
            ModelError: no such file, none of a model, a prompt longer than the window, a schema that cannot
                be kept to.
            ReplyError: `empty` without content; `truncated` if cut off at the token limit.
            MissingDependency: xllamacpp is not installed.
        """
        started = time.monotonic()
        answer = self._ask(request)
        choice, usage = answer["choices"][0], answer["usage"]
        response = LMResponse(
            choice["message"]["content"] or "",
            self._name,
            Usage(usage["prompt_tokens"], usage["completion_tokens"]),
            choice["finish_reason"],
            time.monotonic() - started,
            {**answer, "model": self._name},
        )
        if response.finish_reason == "length":
            limit = self._limit(request)
            raise ReplyError(f"{self._name}: the reply was cut off at {limit} tokens", "truncated", response)
        if not response.text:
            raise ReplyError(f"{self._name}: the reply has no content", "empty", response)
        return response

    def _ask(self, request: LMRequest) -> Mapping[str, Any]:
        """The answer in OpenAI's form."""
        temperature = self._temperature if request.temperature is None else request.temperature
        seed = None if request.seed is None else (request.seed + request.sample) % _SEEDS
        optional = {"temperature": temperature, "seed": seed}
        asked = {
            "messages": [{"role": it.role, "content": it.content} for it in request.messages],
            "max_tokens": self._limit(request),
            **{name: value for name, value in optional.items() if value is not None},
            **({} if request.reply is None else response_format(self._structured, request.reply)),
        }
        try:
            answer: Mapping[str, Any] = self._loaded().handle_chat_completions(asked)
        except ValueError as error:
            raise ModelError(
                f"{self._name}: the request was refused; try llm.structured=json: {error}"
            ) from error
        if "error" in answer:
            raise self._meaning(answer["error"])
        return answer

    def _meaning(self, error: Mapping[str, Any]) -> ModelError:
        if error.get("type") == "exceed_context_size_error":
            return ModelError(
                f"{self._name}: a prompt of {error.get('n_prompt_tokens')} tokens exceeds the window of "
                f"{self._window}; raise llm.window, as far as the model was trained for it"
            )
        return ModelError(f"{self._name}: {error.get('message')}")

    def _loaded(self) -> Any:
        """xllamacpp's server, whose own functions are called, not its address."""
        with self._loading:
            if self._server is None:
                self._server = self._load()
            return self._server

    def _load(self) -> Any:
        try:
            import xllamacpp
        except ImportError as error:
            raise MissingDependency('llm=local needs xllamacpp: pip install "adhoc[local]"') from error
        _check_file(self._path)
        params = xllamacpp.CommonParams()
        params.model.path = str(self._path)
        params.n_ctx = self._window * self._at_once
        params.n_parallel = self._at_once
        params.verbosity = _QUIET
        if self._threads is not None:
            params.cpuparams.n_threads = self._threads
        if self._gpu_layers is not None:
            params.n_gpu_layers = self._gpu_layers
        try:
            return xllamacpp.Server(params)
        except RuntimeError as error:
            raise ModelError(
                f"llm.path={self._path}: llama.cpp cannot load it; check that the file is whole and that "
                f"window={self._window} times at_once={self._at_once} fits into memory: {error}"
            ) from error

    def _limit(self, request: LMRequest) -> int:
        return request.max_tokens if self._max_tokens is None else min(request.max_tokens, self._max_tokens)


def _check_file(path: Path) -> None:
    try:
        with path.open("rb") as file:
            magic = file.read(len(_MAGIC))
    except OSError as error:
        raise ModelError(f"llm.path={path}: cannot be read: {error.strerror}") from error
    if magic != _MAGIC:
        raise ModelError(f"llm.path={path}: is no GGUF file; it begins with {magic!r}")
