"""One question, a bounded number of repairs, everything counted."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fake_situation import CONTEXT

from adhoc.core.calls import Call
from adhoc.core.errors import ModelBusy, ModelError, PromptError, ReplyError
from adhoc.core.plans import Candidate, Prediction
from adhoc.llm.counting import CountingModel
from adhoc.llm.scripted import ScriptedModel
from adhoc.planning.evaluate import LLMEvaluator
from adhoc.planning.generate import LLMGenerator
from adhoc.planning.gpl import GPLEvaluator, GPLGenerator
from adhoc.planning.reflect import LLMReflector

GOOD = '{"sub_tasks": [{"name": "Rest", "args": []}]}'
REST = Candidate(Call("Rest"))


def test_a_bad_reply_is_shown_to_the_model_with_what_is_wrong() -> None:
    script = ScriptedModel(["I would rest.", GOOD])
    model = CountingModel(script)
    assert LLMGenerator(model).generate(CONTEXT) == (REST,)
    first, second = script.requests
    assert second.messages[: len(first.messages)] == first.messages
    assert [it.role for it in second.messages[-2:]] == ["assistant", "user"]
    assert second.messages[-2].content == "I would rest."
    assert "no JSON object" in second.messages[-1].content
    assert model.total.calls == 2
    assert model.total.outcomes == {"unreadable": 1, "repaired": 1}
    assert model.total.repaired == 1


def test_an_empty_reply_is_not_shown() -> None:
    script = ScriptedModel([ReplyError("nothing", "empty"), GOOD])
    LLMGenerator(script).generate(CONTEXT)
    assert [it.role for it in script.requests[1].messages] == ["system", "user", "user"]


@pytest.mark.parametrize("repairs", [0, 1, 3])
def test_repairs_are_bounded_and_every_failure_is_counted(repairs: int) -> None:
    model = CountingModel(ScriptedModel(['{"sub_tasks": []}'] * 9))
    with pytest.raises(ReplyError) as caught:
        LLMGenerator(model, repairs=repairs).generate(CONTEXT)
    assert caught.value.outcome == "illegal"
    assert model.stages["generate"].calls == repairs + 1
    assert model.stages["generate"].outcomes == {"illegal": repairs + 1, "invalid": 1}


@pytest.mark.parametrize("error", [ModelError("no key"), ModelBusy("later")])
def test_a_model_that_cannot_be_used_is_not_asked_again(error: ModelError) -> None:
    script = ScriptedModel([error, GOOD])
    with pytest.raises(type(error)):
        LLMGenerator(script).generate(CONTEXT)
    assert len(script.requests) == 1


def test_an_unknown_template_is_found_at_construction() -> None:
    with pytest.raises(PromptError, match="no_such"):
        LLMGenerator(ScriptedModel([]), template="no_such")


def test_n_is_in_the_prompt_and_bounds_the_candidates() -> None:
    script = ScriptedModel(['{"sub_tasks": ["Rest", "Search room|3", "Search room|4"]}'])
    assert len(LLMGenerator(script, n=2).generate(CONTEXT)) == 2
    assert "propose 2 different sub-tasks" in script.requests[0].messages[1].content


def test_a_single_candidate_is_not_sent_for_ranking() -> None:
    assert LLMEvaluator(ScriptedModel([])).rank(CONTEXT, [REST]) == (REST,)


PREDICTIONS = (Prediction("teammate_1", Call("Search", ("room|3",))),)
PREDICTED = "- teammate_1; sub-task: Search room|3; sub-skill: unknown"


def test_gpl_predicts_first_and_generates_by_it() -> None:
    script = ScriptedModel(
        ['{"predictions": [{"teammate": "teammate_1", "sub_task": "Search room|3"}]}', GOOD]
    )
    assert GPLGenerator(script).generate(CONTEXT) == (replace(REST, predictions=PREDICTIONS),)
    assert [it.stage for it in script.requests] == ["gpl_predict", "gpl_generate"]
    assert PREDICTED in script.requests[1].messages[1].content


def test_gpl_without_teammates_predicts_nothing() -> None:
    script = ScriptedModel([GOOD])
    assert GPLGenerator(script).generate(replace(CONTEXT, teammates=())) == (REST,)
    assert [it.stage for it in script.requests] == ["gpl_generate"]


def test_gpl_generates_even_without_usable_predictions() -> None:
    model = CountingModel(ScriptedModel(["no idea", "really not", GOOD]))
    assert GPLGenerator(model).generate(CONTEXT) == (REST,)
    assert model.stages["gpl_predict"].outcomes == {"unreadable": 2, "invalid": 1}


def test_gpl_scores_by_the_predictions_with_the_unscored_last() -> None:
    script = ScriptedModel(['{"scores": [{"index": 0, "score": 2}, {"index": 2, "score": 9}]}'])
    candidates = [
        Candidate(Call("Search", (room,)), predictions=PREDICTIONS) for room in ("room|2", "room|3", "room|4")
    ]
    ranked = GPLEvaluator(script).rank(CONTEXT, candidates)
    assert [(it.sub_task.args[0], it.score) for it in ranked] == [
        ("room|4", 9.0),
        ("room|2", 2.0),
        ("room|3", None),
    ]
    assert [it.stage for it in script.requests] == ["gpl_score"]
    assert script.requests[0].messages[1].content.count(PREDICTED) == 1


def test_a_verdict_carries_the_model_s_reason() -> None:
    script = ScriptedModel(['{"feasible": false, "reason": "taken"}'])
    verdict = LLMReflector(script).judge(CONTEXT, REST, ())
    assert (verdict.feasible, verdict.reason) == (False, "taken")
    assert "- nobody answered" in script.requests[0].messages[1].content
