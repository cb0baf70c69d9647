"""What a record tells about the language model."""

from __future__ import annotations

from itertools import permutations
from random import Random

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ReplyError
from adhoc.core.replies import Fault, Reading, ReplyFormat
from adhoc.evaluation.llm_field import llm_field, stage_counts
from adhoc.llm.counting import CountingModel, Counts
from adhoc.llm.model import LMRequest
from adhoc.llm.prices import Price
from adhoc.llm.scripted import ScriptedModel
from adhoc.llm.validating import ValidatingModel


def read(text: str) -> Reading:
    """`usable`, with what comes before it as faults."""
    *faults, last = text.split(", ")
    if last != "usable":
        raise ReplyError("no", last)
    return Reading(last, tuple(Fault(outcome, "") for outcome in faults))


def ask(model: CountingModel, stage: str) -> None:
    request = LMRequest((ChatMessage("user", "a b c"),), stage, reply=ReplyFormat("form", {}, read))
    ValidatingModel(model).complete(request)


def test_every_stage_tells_how_its_replies_were_judged() -> None:
    first = CountingModel(ScriptedModel(["usable", "illegal, unknown id, usable", "truncated", "usable"]))
    second = CountingModel(ScriptedModel(["duplicate", "unreadable"]))
    ask(first, "generate")
    ask(first, "generate")
    ask(first, "reflect")
    with pytest.raises(ReplyError):
        ask(second, "reflect")
    field = llm_field(stage_counts([first, second]))
    assert field["calls"] == 6
    assert (field["repaired"], field["invalid"], field["replayed"]) == (1, 1, 0)
    generate, reflect = field["stages"]["generate"], field["stages"]["reflect"]
    judged = ("valid", "repaired", "invalid", "illegal", "duplicate", "unknown_id", "truncated", "unreadable")
    assert [generate[it] for it in judged] == [2, 0, 0, 1, 0, 1, 0, 0]
    assert [reflect[it] for it in judged] == [0, 1, 1, 0, 1, 0, 1, 1]
    assert (generate["calls"], generate["prompt_tokens"], generate["completion_tokens"]) == (2, 6, 5)
    assert "replayed" not in generate
    assert sum(stage["calls"] for stage in field["stages"].values()) == field["calls"]


def test_without_a_model_nothing_is_told() -> None:
    field = llm_field(stage_counts([]))
    assert (field["calls"], field["outcomes"], field["stages"]) == (0, {}, {})


def test_the_cost_does_not_depend_on_the_order_of_arrival() -> None:
    """Samples of one question go out together, and odd numbers of tokens end in half a millionth."""
    price, chance = Price(2.5, 10.0), Random(7)
    for _ in range(500):
        costs = [price.cost(chance.randint(500, 9000), chance.randint(20, 400)) for _ in range(4)]
        told = set()
        for order in permutations(costs):
            counts = Counts()
            for cost in order:
                counts.add(Counts(calls=1, cost_usd=cost))
            told.add(llm_field({"generate": counts})["cost_usd"])
        assert len(told) == 1
