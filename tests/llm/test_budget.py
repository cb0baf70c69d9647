"""Caps on calls, tokens and money; and prices."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from threading import Barrier, Lock

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import BudgetReached, ConfigurationError, ModelBusy, ModelError, ReplyError
from adhoc.core.replies import Reading, ReplyFormat
from adhoc.llm.budget import NOTHING, Account, Caps, EpisodeCapModel, RunCapModel, Spent
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage
from adhoc.llm.prices import Price, PricedModel, listed_price
from adhoc.llm.scripted import ScriptedModel
from adhoc.llm.team_model import TeamModel
from adhoc.llm.together import complete_together
from adhoc.testing.model_contract import LanguageModelContract

PRICE = Price(10.0, 30.0)
REQUEST = LMRequest((ChatMessage("user", "x" * 336),), "generate", max_tokens=100)
"""Its prompt is estimated at 336 / 3.5 + 4 = 100 tokens, so it may take 200 tokens and 0.004 dollars."""


class Metered(LanguageModel):
    """Uses what it is told to use."""

    name = "metered"

    def __init__(self, prompt: int = 90, completion: int = 10, before: Callable[[], None] = lambda: None):
        self._usage, self._before, self._lock = (prompt, completion), before, Lock()
        self.calls = 0

    def complete(self, request: LMRequest) -> LMResponse:
        with self._lock:
            self.calls += 1
        self._before()
        return LMResponse("x", self.name, Usage(*self._usage, PRICE.cost(*self._usage)), replayed=True)


class TestRunCaps(LanguageModelContract):
    def model(self) -> LanguageModel:
        return RunCapModel(ScriptedModel(["an answer"]), Caps(calls=10))


class TestEpisodeCaps(LanguageModelContract):
    def model(self) -> LanguageModel:
        return EpisodeCapModel(ScriptedModel(["an answer"]), Caps(tokens=10_000))


class TestPriced(LanguageModelContract):
    def model(self) -> LanguageModel:
        return PricedModel(ScriptedModel(["an answer"]), PRICE)


class TestTeam(LanguageModelContract):
    def model(self) -> LanguageModel:
        return TeamModel(ScriptedModel(["an answer"]))


def asked(model: LanguageModel, times: int = 100) -> int:
    """How often it answers before the budget is reached."""
    for call in range(times):
        try:
            model.complete(REQUEST)
        except BudgetReached:
            return call
    return times


@pytest.mark.parametrize(
    ("caps", "calls"),
    [
        (Caps(), 100),
        (Caps(calls=0), 0),
        (Caps(calls=3), 3),
        (Caps(tokens=199), 0),  # 200 could be passed
        (Caps(tokens=200), 1),  # then 100 are spent and 200 more would pass
        (Caps(tokens=300), 2),
        (Caps(usd=0.0039), 0),  # the worst case costs 100 * 10 + 100 * 30 millionths
        (Caps(usd=0.004), 1),  # then 0.0012 are spent
        (Caps(usd=0.0053), 2),
        (Caps(calls=5, tokens=300, usd=1.0), 2),
    ],
)
def test_calls_are_made_while_their_worst_case_fits(caps, calls):
    inner = Metered()
    assert asked(RunCapModel(inner, caps, PRICE)) == calls
    assert inner.calls == calls


def test_the_schema_of_the_reply_is_a_part_of_the_prompt():
    form = ReplyFormat("any", {"description": "y" * 16_000}, Reading)
    model = RunCapModel(Metered(), Caps(tokens=4700))
    model.complete(REQUEST)
    with pytest.raises(BudgetReached, match="the next call may take 47"):
        model.complete(replace(REQUEST, reply=form))


def test_what_was_spent_before_counts():
    assert asked(RunCapModel(Metered(), Caps(calls=5), spent=Spent(calls=3))) == 2
    assert asked(RunCapModel(Metered(), Caps(tokens=1000), spent=Spent(tokens=800))) == 1
    assert asked(RunCapModel(Metered(), Caps(usd=1.0), PRICE, Spent(usd=1.5))) == 0


def test_the_error_names_the_cap_and_the_numbers():
    model = RunCapModel(Metered(), Caps(calls=9, usd=0.005), PRICE)
    model.complete(REQUEST)
    with pytest.raises(BudgetReached) as reached:
        model.complete(REQUEST)
    assert (reached.value.scope, reached.value.cap) == ("run", "budget.run.usd")
    assert str(reached.value) == (
        "budget.run.usd=0.005: reached; 0.0012 spent, and the next call may take 0.0040"
    )


@pytest.mark.parametrize("workers", [2, 8])
def test_callers_at_once_do_not_pass_a_cap_together(workers):
    """Every answer waits until all callers have asked or were refused."""
    together = Barrier(workers)
    inner = Metered(before=lambda: together.wait(5))
    caps = Caps(tokens=200 * workers)
    model = RunCapModel(inner, caps, PRICE)
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(lambda _: model.complete(REQUEST), range(workers)))
    assert inner.calls == workers
    assert model.spent == Spent(workers, 100 * workers, pytest.approx(0.0012 * workers))

    refused = RunCapModel(Metered(before=lambda: together.wait(5)), Caps(tokens=200 * workers - 1))

    def ask(_: int) -> bool:
        try:
            refused.complete(REQUEST)
        except BudgetReached:
            together.wait(5)
            return False
        return True

    with ThreadPoolExecutor(workers) as pool:
        answers = list(pool.map(ask, range(workers)))
    assert sum(answers) == workers - 1


def test_many_callers_spend_no_more_than_the_cap():
    inner = Metered(prompt=100, completion=100)
    model = RunCapModel(inner, Caps(calls=57, usd=1.0), PRICE)
    with ThreadPoolExecutor(16) as pool:
        list(pool.map(lambda _: asked(model, 10), range(16)))
    assert inner.calls == 57
    assert model.spent.calls == 57


def test_a_reply_of_no_use_was_paid_and_a_call_without_a_reply_was_not():
    script = ScriptedModel([ReplyError("cut", "truncated"), ModelBusy("later"), ModelError("no key"), "yes"])
    model = RunCapModel(script, Caps(calls=9), PRICE)
    with pytest.raises(ReplyError):
        model.complete(REQUEST)
    worst = Spent(1, 200, PRICE.cost(100, 100))
    assert model.spent == worst
    for _ in range(2):
        with pytest.raises(ModelError):
            model.complete(REQUEST)
    assert model.spent == worst
    model.complete(REQUEST)
    assert model.spent.calls == 2


def test_what_a_reply_of_no_use_took_is_booked_where_it_is_known():
    cut = LMResponse("", "m", Usage(80, 100))
    priced = PricedModel(ScriptedModel([ReplyError("cut", "truncated", cut)]), PRICE)
    capped = RunCapModel(priced, Caps(calls=9), PRICE)
    counting = CountingModel(capped)
    with pytest.raises(ReplyError):
        counting.complete(REQUEST)
    assert capped.spent == Spent(1, 180, PRICE.cost(80, 100))
    total = counting.total
    assert (total.calls, total.prompt_tokens, total.cost_usd) == (1, 80, PRICE.cost(80, 100))


def test_an_endpoint_that_tells_no_usage_is_booked_at_the_worst_case():
    model = RunCapModel(Metered(prompt=0, completion=0), Caps(tokens=500))
    assert asked(model) == 2


def test_caps_of_an_episode_begin_anew_and_count_replayed_answers():
    model = EpisodeCapModel(Metered(), Caps(calls=2))
    for episode in ("a", "b", "b"):
        model.begin_episode(episode, 0)
        assert asked(model) == 2
    with pytest.raises(BudgetReached, match=r"budget\.episode\.calls=2: reached; 2 spent") as reached:
        model.complete(REQUEST)
    assert (reached.value.scope, reached.value.cap) == ("episode", "budget.episode.calls")


def test_a_call_that_a_budget_refuses_is_not_counted():
    model = CountingModel(EpisodeCapModel(Metered(), Caps(calls=2)))
    assert asked(model) == 2
    assert model.total.calls == 2


@pytest.mark.parametrize("calls", [1, 2, 3, 4, 11, 12, 15])
def test_which_calls_are_made_does_not_depend_on_the_order_of_answers(calls):
    """Three questions at once under every cap around them: the first ones are asked, or all."""
    wanted = [replace(REQUEST, sample=sample) for sample in range(3)]
    seen: list[int] = []

    class Listener(Metered):
        def complete(self, request: LMRequest) -> LMResponse:
            seen.append(request.sample)
            return super().complete(request)

    model = EpisodeCapModel(Listener(), Caps(calls=calls))
    try:
        complete_together(model, wanted)
    except BudgetReached:
        assert seen == [0, 1, 2][:calls]
    else:
        assert sorted(seen) == [0, 1, 2]
        assert model.may_go_together(wanted) == (calls >= 3 + 12)


@pytest.mark.parametrize(
    ("caps", "told"),
    [
        ({"calls": -1}, "calls=-1: must be at least 0"),
        ({"tokens": 1.5}, "tokens=1.5: must be a whole number"),
        ({"calls": True}, "calls=True: must be a whole number"),
        ({"usd": -0.5}, "usd=-0.5: must be at least 0"),
        ({"usd": math.nan}, "usd=nan: must be at least 0"),
        ({"usd": math.inf}, "usd=inf: must be at least 0"),
        ({"usd": "5"}, "usd='5': must be a number of US dollars"),
    ],
)
def test_caps_that_are_none(caps, told):
    with pytest.raises(ConfigurationError, match=told):
        Caps(**caps)


def test_no_cap_is_false():
    assert not Caps()
    assert Caps(calls=0)


@pytest.mark.parametrize("order", [(0.1, 0.2, 0.3), (0.3, 0.2, 0.1), (0.2, 0.3, 0.1)])
def test_the_order_in_which_prices_are_added_up_decides_nothing(order):
    account = Account(Caps(usd=0.6))
    for usd in order:
        account.settle(NOTHING, Spent(1, 1, usd))
    assert account.has_room(Spent(1, 1, 0.0))
    assert not account.has_room(Spent(1, 1, 1e-6))


def test_amounts_add_up():
    assert Spent(1, 2, 3.0) + Spent(4, 5, 6.0) - Spent(4, 5, 6.0) == Spent(1, 2, 3.0)
    assert NOTHING + NOTHING == NOTHING


class TestPrices:
    def test_the_models_of_the_paper_are_listed_without_litellm(self):
        assert listed_price("gpt-4-1106-preview") == Price(10.0, 30.0)
        assert listed_price("openai/gpt-3.5-turbo-1106") == Price(1.0, 2.0)

    def test_litellm_is_asked_if_it_is_loaded(self, monkeypatch):
        class Fake:
            model_cost = {  # noqa: RUF012
                "some-model": {"input_cost_per_token": 2e-6, "output_cost_per_token": 8e-6},
                "an-image-model": {"mode": "image_generation"},
            }

        monkeypatch.setitem(__import__("sys").modules, "litellm", Fake)
        price = listed_price("provider/some-model")
        assert price is not None
        assert (price.prompt, price.completion) == pytest.approx((2.0, 8.0))
        assert listed_price("an-image-model") is None
        assert listed_price("unheard-of") is None

    def test_a_price_makes_the_cost(self):
        response = PricedModel(ScriptedModel(["two words"]), PRICE).complete(REQUEST)
        assert response.usage == Usage(1, 2, pytest.approx(70e-6))

    @pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, "5", True])
    def test_a_price_is_a_number(self, value):
        with pytest.raises(ConfigurationError, match=r"llm\.price\.completion="):
            Price(1.0, value)


def test_the_teams_stages_have_names_of_their_own():
    model = CountingModel(ScriptedModel(["a", "b"]))
    model.complete(REQUEST)
    team = TeamModel(model)
    team.complete(REQUEST)
    team.note("generate", "valid")
    assert {stage: counts.calls for stage, counts in model.stages.items()} == {
        "generate": 1,
        "team generate": 1,
    }
    assert model.stages["team generate"].outcomes == {"valid": 1}
