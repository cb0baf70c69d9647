"""litellm itself: imported late and tamed, and what it knows about names and keys."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import lru_cache
from types import ModuleType
from typing import Any

from adhoc.core.errors import MissingDependency, ModelError


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
    litellm.disable_hf_tokenizer_download = True
    module: ModuleType = litellm
    return module


def any_error() -> type[Exception]:
    """The base of every error that litellm raises for a call."""
    import openai

    return openai.OpenAIError


def check_usable(litellm: ModuleType, model: str) -> None:
    """Raise ModelError where a hosted model has no known provider or lacks its key.

    Without a key, litellm fails like a broken server, which looks as if trying again would help.
    """
    try:
        litellm.get_llm_provider(model)
    except litellm.exceptions.BadRequestError as error:
        raise ModelError(
            f"model {model!r}: litellm knows no provider of this name; write PROVIDER/NAME, "
            "e.g. openai/gpt-4o, or give `api_base`"
        ) from error
    missing = missing_keys(litellm, model)
    if missing:
        raise ModelError(
            f"model {model!r} needs the environment variable {' and '.join(missing)}; set it, or "
            "use the offline reasoner (llm=offline), which needs no key"
        )


def missing_keys(litellm: ModuleType, model: str) -> list[str]:
    """The environment variables that the provider's key would be in, if none is set; an empty one is not."""
    found: Mapping[str, Any] = litellm.validate_environment(model)
    if not found["keys_in_environment"]:
        return [str(key) for key in found["missing_keys"]]
    usual = key_variable(litellm, model)
    return [usual] if os.environ.get(usual, "set").strip() == "" else []


def key_variable(litellm: ModuleType, model: str) -> str:
    """The environment variable that a provider's key usually comes from."""
    try:
        provider = litellm.get_llm_provider(model)[1]
    except litellm.exceptions.BadRequestError:
        provider = "openai"
    return f"{provider.upper()}_API_KEY"


def context_window(litellm: ModuleType, model: str) -> int | None:
    """The longest prompt in tokens by litellm's list; None where the model is not in it."""
    try:
        found = litellm.get_model_info(model)["max_input_tokens"]
    except litellm.exceptions.ModelNotMappedError:
        return None
    return None if found is None else int(found)


def price(litellm: ModuleType, response: Any, model: str) -> float:
    """US dollars by litellm's price list; 0 where the model is not in it."""
    try:
        short, provider, *_ = litellm.get_llm_provider(model)
    except litellm.exceptions.BadRequestError:
        return 0.0
    if not {model, short, f"{provider}/{short}"} & litellm.model_cost.keys():
        return 0.0
    return float(litellm.completion_cost(completion_response=response, model=model))
