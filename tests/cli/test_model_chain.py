"""The chain of models of a run, as its configuration says."""

from __future__ import annotations

import pytest
from hydra import compose, initialize_config_dir
from paid_model import PaidReasoner

from adhoc.cli.contestants import Components
from adhoc.cli.model_chain import price_of, spent_before
from adhoc.cli.replaced import drop_foreign_settings
from adhoc.cli.schema import register_schema
from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, LedgerError, ModelBusy
from adhoc.core.resources import data_dir
from adhoc.llm.budget import Spent
from adhoc.llm.ledger.disk_sync import DiskSync
from adhoc.llm.model import LanguageModel, LMRequest, Wrapper
from adhoc.llm.prices import FREE, Price

PAID = "llm._target_=paid_model.PaidReasoner"
REQUEST = LMRequest((ChatMessage("user", "hello"),), "generate")


@pytest.fixture(autouse=True)
def _fresh(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(PaidReasoner, "calls", [])


def components(*overrides: str) -> Components:
    register_schema()
    with initialize_config_dir(str(data_dir("configs")), version_base="1.3"):
        config = compose("run", ["out=results", *overrides])
    drop_foreign_settings(config, overrides)
    return Components(config)


def chain(*overrides: str) -> list[str]:
    """The classes from outer to inner."""
    model: LanguageModel = components(*overrides).newcomer.model
    names = [type(model).__name__]
    while isinstance(model, Wrapper):
        model = model._inner
        names.append(type(model).__name__)
    return names


OUTER = ["CountingModel", "EpisodeModel"]


@pytest.mark.parametrize(
    ("overrides", "classes"),
    [
        ([], [*OUTER, "TranscribingModel", "PricedModel", "OfflineReasoner"]),
        ([PAID, "ledger.mode=off"], [*OUTER, "TranscribingModel", "PricedModel", "PaidReasoner"]),
        ([PAID], [*OUTER, "TranscribingModel", "LedgerModel", "PricedModel", "PaidReasoner"]),
        (
            ["ledger.mode=record"],
            [*OUTER, "TranscribingModel", "LedgerModel", "PricedModel", "OfflineReasoner"],
        ),
        (
            ["llm=litellm", "llm.model=m", "budget.episode.calls=3", "budget.run.calls=3"],
            [*OUTER, "EpisodeCapModel", "TranscribingModel", "LedgerModel", "RunCapModel", "LiteLLMModel"],
        ),
    ],
)
def test_every_wrapper_has_its_place(overrides, classes):
    assert [name for name in chain(*overrides) if name != "RetryingModel"] == classes
    made = chain(*overrides)
    assert made.index("RetryingModel") > made.index("TranscribingModel")


def test_a_given_provider_stands_for_all_below_the_boundary():
    config = components(PAID, "budget.run.calls=3")._config
    provider = PaidReasoner({})
    model = Components(config, provider).newcomer.model
    while isinstance(model, Wrapper):
        model = model._inner
    assert model is provider


def test_a_ledger_that_is_not_there_cannot_be_replayed():
    with pytest.raises(LedgerError, match="results/ledger"):
        chain(PAID, "ledger.mode=replay")


@pytest.mark.parametrize("waits", [False, True])
def test_a_ledger_waits_for_the_disk_if_it_shall(monkeypatch, waits):
    synced = []
    monkeypatch.setattr(DiskSync, "wait", lambda self: synced.append(self))
    model = components(PAID, f"ledger.wait_for_disk={waits}").newcomer.model
    model.begin_episode("e", 7)
    model.complete(REQUEST)
    assert len(synced) == (2 if waits else 0)


def test_what_was_recorded_is_replayed_without_the_model():
    asked = components(PAID).newcomer.model
    asked.begin_episode("e", 7)
    text = asked.complete(REQUEST).text
    assert (PaidReasoner.calls[0].episode, PaidReasoner.calls[0].seed) == ("e", 7)
    replayed = components(PAID, "ledger.mode=replay").newcomer.model
    replayed.begin_episode("e", 7)
    assert replayed.complete(REQUEST).text == text
    assert replayed.name == "paid"
    assert len(PaidReasoner.calls) == 1
    replayed.begin_episode("e", 8)
    with pytest.raises(LedgerError):
        replayed.complete(REQUEST)


def test_a_replay_of_a_model_that_was_set_up_otherwise_is_refused():
    components("ledger.mode=record").newcomer.model.complete(REQUEST)
    with pytest.raises(LedgerError, match=r"other settings: seed \(0 there, 3 here\)"):
        components("ledger.mode=replay", "llm.seed=3").newcomer  # noqa: B018


class Busy(LanguageModel):
    name = "busy"

    def complete(self, request: LMRequest):
        raise ModelBusy("later")


def test_retries_are_as_configured():
    busy = "llm._target_=test_model_chain.Busy"
    model = components(busy, "retry.attempts=3", "retry.wait=0", "ledger.mode=off").newcomer.model
    with pytest.raises(ModelBusy, match="asked 3 times"):
        model.complete(REQUEST)


@pytest.mark.parametrize(
    "override",
    [
        "budget.run.calls=5", "ledger.mode=record", "ledger.path=elsewhere", "workers=4", "retry.attempts=2",
        "rate.concurrent=2", "llm.price={prompt: 1, completion: 2}",
    ],
)  # fmt: skip
def test_what_decides_no_result_does_not_tell_folders_apart(override):
    assert components(override).newcomer.settings == components().newcomer.settings


@pytest.mark.parametrize("override", ["budget.episode.calls=5", "llm.seed=3"])
def test_what_decides_results_tells_folders_apart(override):
    assert components(override).newcomer.settings != components().newcomer.settings
    assert components(override).conditions.settings == components().conditions.settings


def test_an_address_does_not_tell_folders_apart():
    hosted = ["llm=litellm", "llm.model=m"]
    moved = components(*hosted, "llm.api_base=http://127.0.0.1:1/v1", "llm.timeout=5").newcomer.settings
    assert moved == components(*hosted).newcomer.settings


def test_what_earlier_sessions_spent_is_read_from_the_ledger(tmp_path):
    assert spent_before(tmp_path / "nothing") == Spent()
    model = components(PAID).newcomer.model
    used = [model.complete(LMRequest(REQUEST.messages, "generate", sample=sample)).usage for sample in (0, 1)]
    tokens = sum(usage.prompt_tokens + usage.completion_tokens for usage in used)
    known = spent_before(tmp_path / "results" / "ledger")
    assert (known.calls, known.tokens) == (2, tokens)
    assert known.usd == pytest.approx(sum(usage.cost_usd for usage in used))


class TestPrice:
    def test_what_is_configured_goes_first(self):
        assert price_of({"model": "gpt-4-1106-preview", "price": {"prompt": 1, "completion": 2}}) == Price(
            1, 2
        )
        assert price_of({"model": "gpt-4-1106-preview", "price": None}) == Price(10.0, 30.0)
        assert price_of({"price": {"prompt": 0.0, "completion": 0.0}}) == FREE

    def test_a_model_without_a_name_has_no_price(self):
        assert price_of({}) is None

    def test_litellm_is_loaded_for_other_names_only_if_asked(self, monkeypatch):
        loaded = []
        monkeypatch.setattr("adhoc.llm.litellm_access.load_litellm", lambda: loaded.append(1))
        monkeypatch.setattr(
            "adhoc.llm.prices._price_of_litellm", lambda name: Price(7, 8) if loaded else None
        )
        assert price_of({"model": "other"}, look_up=False) is None
        assert price_of({"model": "other"}) == Price(7, 8)

    def test_money_cannot_be_capped_without_one(self, monkeypatch):
        monkeypatch.setattr("adhoc.llm.litellm_access.load_litellm", lambda: None)
        with pytest.raises(
            ConfigurationError, match=r"budget\.episode\.usd=1\.0: the price of m is not known"
        ):
            components("llm=litellm", "llm.model=m", "budget.episode.usd=1").newcomer  # noqa: B018
