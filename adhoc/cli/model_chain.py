"""The chain of models around a backend, from the configuration of a run.

Outer to inner: gathering, counting, caps of the episode, transcript | ledger, caps of the run, retries,
backend. What is left of the bar belongs to whoever runs episodes; what is right of it exists once in a run,
whatever the number of workers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf

from adhoc.cli.build import TARGET, Offer, build
from adhoc.cli.shards import folder_of
from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.exchanges import TranscribingModel
from adhoc.llm.budget import NOTHING, Caps, EpisodeCapModel, RunCapModel, Spent
from adhoc.llm.counting import CountingModel
from adhoc.llm.episode_model import EpisodeModel
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.ledger.replaying import ReplayModel
from adhoc.llm.ledger.spending import spent
from adhoc.llm.limiting import CallLimiter
from adhoc.llm.model import LanguageModel
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.llm.prices import FREE, Price, PricedModel, listed_price
from adhoc.llm.retrying import RetryingModel
from adhoc.llm.side_by_side import GatheringModel
from adhoc.tasks.placement import placement_table

LLM_OFFERS: Mapping[str, Offer] = {"places": placement_table}
"""What language models that are none may ask for: general knowledge of where things belong."""
NO_ARGUMENTS = ("name", "price")
"""Keys of the group `llm` that are not the backend's."""
INDIFFERENT = ("price", "timeout", "api_base", "path", "threads", "at_once", "gpu_layers")
"""Keys that decide no answer: where a model is, how fast, and for how much. A run may go on with others."""
NAMED_BY_CALLS = ("name", TARGET, "model", "window")
"""Keys that every recorded call tells by its model's name or its messages."""


class LedgerMode(str, Enum):
    """What becomes of the calls of a run."""

    AUTO = "auto"
    """Record, unless the model is the offline reasoner, which costs nothing and answers the same again."""
    RECORD = "record"
    REPLAY = "replay"
    OFF = "off"


@dataclass(frozen=True)
class OuterModel:
    """The model as planners see it, and its transcript."""

    model: LanguageModel
    """To ask."""
    counting: CountingModel
    """To read what was asked."""
    transcriber: TranscribingModel


def outer_model(config: DictConfig, llm: Mapping[str, Any], provider: LanguageModel) -> OuterModel:
    """What one process puts around `provider` to run episodes. Raises ConfigurationError for bad caps."""
    transcriber = TranscribingModel(provider)
    caps = caps_of(config, "episode")
    inner = EpisodeCapModel(transcriber, caps, _price_for(caps, llm, "episode")) if caps else transcriber
    counting = CountingModel(EpisodeModel(inner))
    return OuterModel(GatheringModel(counting), counting, transcriber)


def provider_model(config: DictConfig, llm: Mapping[str, Any]) -> LanguageModel:
    """What answers all episodes of a run: the backend, and what stands between it and their questions.

    Raises:
        ConfigurationError: a value does not fit, or the price of a model is needed and not known.
        LedgerError: the ledger is damaged, foreign or of another version, or there is none to replay.
    """
    backend: LanguageModel = build(_without(llm, *NO_ARGUMENTS), "llm", LLM_OFFERS, LanguageModel)
    mode, folder = _ledger_mode(config, backend), ledger_folder(config)
    settings = _without(llm, *INDIFFERENT, *NAMED_BY_CALLS)
    if mode is LedgerMode.REPLAY:
        return ReplayModel(folder, backend.name, settings, counts_like=backend)
    price = _configured_price(llm)
    model = backend if price is None else PricedModel(backend, price)
    model = _retrying(config, model)
    caps = caps_of(config, "run")
    if caps:
        before = spent_before(folder) if mode is LedgerMode.RECORD else NOTHING
        model = RunCapModel(model, caps, _price_for(caps, llm, "run"), before)
    if mode is LedgerMode.RECORD:
        model = LedgerModel(model, folder, settings, config.ledger.wait_for_disk)
    return model


def hashed_settings(config: DictConfig, llm: Mapping[str, Any]) -> dict[str, Any]:
    """What of the model and its caps decides an episode, as JSON values."""
    settings: dict[str, Any] = {"llm": _without(llm, *INDIFFERENT)}
    if caps_of(config, "episode"):
        settings["budget"] = {"episode": OmegaConf.to_container(config.budget.episode)}
    return settings


def caps_of(config: DictConfig, scope: str) -> Caps:
    """The caps of `episode` or `run`. Raises ConfigurationError if one is negative."""
    try:
        return Caps(**config.budget[scope])
    except ConfigurationError as error:
        raise ConfigurationError(f"budget.{scope}.{error}") from error


def price_of(llm: Mapping[str, Any], look_up: bool = True) -> Price | None:
    """What a token costs: `llm.price`, else the list; None if neither says. With `look_up`, litellm's list is
    loaded for it where need be."""
    configured = _configured_price(llm)
    name = llm.get("model")
    if configured is not None or not isinstance(name, str):
        return configured
    listed = listed_price(name)
    if listed is None and look_up:
        from adhoc.llm.litellm_access import load_litellm

        load_litellm()
        listed = listed_price(name)
    return listed


def check_values(config: DictConfig) -> None:
    """Raise ConfigurationError for a cap, a ledger mode, a retry or a rate that does not fit, also where no
    model is going to be asked."""
    for scope in ("episode", "run"):
        caps_of(config, scope)
    nobody = OfflineReasoner({})
    _ledger_mode(config, nobody)
    ledger_folder(config)
    _retrying(config, nobody)


def is_offline(llm: Mapping[str, Any]) -> bool:
    """Whether the group `llm` names the offline reasoner, which costs nothing and answers the same again."""
    return llm.get(TARGET) == f"{OfflineReasoner.__module__}.{OfflineReasoner.__qualname__}"


def ledger_folder(config: DictConfig) -> Path:
    """Where calls are recorded, or replayed from. Raises ConfigurationError if it has no name, or is the run
    folder, whose records are no calls."""
    if config.ledger.path is None:
        return folder_of(config) / "ledger"
    if not config.ledger.path.strip():
        raise ConfigurationError("ledger.path=: must name a folder, or be null for OUT/ledger")
    path = Path(config.ledger.path)
    if path.resolve() == Path(config.out).resolve():
        raise ConfigurationError(
            f"ledger.path={path}: is the run folder (out); name another one, e.g. {path / 'ledger'}"
        )
    return path


def spent_before(folder: Path) -> Spent:
    """What earlier sessions spent by their ledger. What a call used whose answer was lost is not known; it
    counts as much as the other calls did on average."""
    known = spent(folder)
    answered = known.calls - known.pending
    share = known.calls / answered if answered else 1.0
    tokens = known.prompt_tokens + known.completion_tokens
    return Spent(known.calls, round(share * tokens), share * known.cost_usd)


def _ledger_mode(config: DictConfig, backend: LanguageModel) -> LedgerMode:
    try:
        mode = LedgerMode(config.ledger.mode)
    except ValueError as error:
        known = ", ".join(mode.value for mode in LedgerMode)
        raise ConfigurationError(f"ledger.mode={config.ledger.mode}: must be one of {known}") from error
    if mode is not LedgerMode.AUTO:
        return mode
    return LedgerMode.OFF if isinstance(backend, OfflineReasoner) else LedgerMode.RECORD


def _retrying(config: DictConfig, model: LanguageModel) -> LanguageModel:
    retry, rate = config.retry, config.rate
    try:
        limiter = CallLimiter(rate.concurrent, rate.per_minute)
    except ConfigurationError as error:
        raise ConfigurationError(f"rate: {error}") from error
    try:
        return RetryingModel(model, **retry, limiter=limiter)
    except ConfigurationError as error:
        raise ConfigurationError(f"retry: {error}") from error


def _price_for(caps: Caps, llm: Mapping[str, Any], scope: str) -> Price:
    """The price by which calls are weighed against caps; a cap on money cannot be kept without one."""
    if caps.usd is None:
        return FREE
    price = price_of(llm)
    if price is None:
        model = llm.get("model") or llm[TARGET]
        raise ConfigurationError(
            f"budget.{scope}.usd={caps.usd}: the price of {model} is not known; "
            "give 'llm.price={prompt: P, completion: C}' in US dollars for a million tokens, or cap calls or "
            "tokens instead"
        )
    return price


def _configured_price(llm: Mapping[str, Any]) -> Price | None:
    given = llm.get("price")
    if given is None:
        return None
    if not isinstance(given, Mapping) or set(given) != {"prompt", "completion"}:
        raise ConfigurationError(
            f"llm.price={given!r}: must be {{prompt: P, completion: C}}, in US dollars for a million tokens"
        )
    return Price(given["prompt"], given["completion"])


def _without(llm: Mapping[str, Any], *names: str) -> dict[str, Any]:
    return {name: value for name, value in llm.items() if name not in names}
