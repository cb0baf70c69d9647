"""One question, a bounded number of repairs, and every reply's fate noted once."""

from __future__ import annotations

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import BudgetReached, ConfigurationError, ModelBusy, ModelError, ReplyError
from adhoc.core.replies import Fault, Reading, ReplyFormat
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LanguageModel, LMRequest
from adhoc.llm.scripted import ScriptedModel
from adhoc.llm.validating import MAX_SHOWN_PROBLEM, MAX_SHOWN_REPLY, ValidatingModel
from adhoc.testing.model_contract import LanguageModelContract


def read_number(text: str) -> Reading:
    """Numbers, perhaps after words that are faults."""
    *words, last = text.split() or [""]
    if not last.isdigit():
        raise ReplyError(f"{text!r} is no number", "unreadable")
    return Reading(int(last), tuple(Fault("illegal", word) for word in words))


FORM = ReplyFormat("number", {"type": "number"}, read_number)
PROMPT = (ChatMessage("system", "Count."), ChatMessage("user", "How many?"))
QUESTION = LMRequest(PROMPT, "counting", reply=FORM, agent="me", template="t")


class TestValidating(LanguageModelContract):
    def model(self) -> LanguageModel:
        return ValidatingModel(ScriptedModel(["an answer"]))


class Narrow(ScriptedModel):
    """Has room for 100 tokens."""

    window = 100

    def count_tokens(self, messages: object) -> int:
        return sum(len(it.content) for it in messages)


def asked(*replies: str | Exception) -> tuple[CountingModel, ScriptedModel]:
    script = ScriptedModel(replies)
    return CountingModel(script), script


def test_a_good_reply_is_read() -> None:
    model, script = asked("7")
    response = ValidatingModel(model).complete(QUESTION)
    assert (response.parsed, response.text) == (7, "7")
    assert script.requests == [QUESTION]
    assert model.stages["counting"].outcomes == {"valid": 1}


def test_a_request_without_a_form_passes_as_it_is() -> None:
    model, _ = asked("whatever")
    assert ValidatingModel(model).complete(LMRequest(PROMPT, "free")).parsed is None
    assert model.total.outcomes == {}


def test_what_a_usable_reply_lost_is_noted() -> None:
    model, _ = asked("some say 7")
    assert ValidatingModel(model).complete(QUESTION).parsed == 7
    assert model.total.outcomes == {"valid": 1, "illegal": 2}


def test_a_bad_reply_is_shown_with_what_is_wrong() -> None:
    model, script = asked("seven", "about 7")
    assert ValidatingModel(model).complete(QUESTION).parsed == 7
    first, second = script.requests
    assert first == QUESTION
    assert second.messages[:2] == PROMPT
    assert second.messages[2] == ChatMessage("assistant", "seven")
    assert second.messages[3].role == "user"
    assert "(unreadable): 'seven' is no number" in second.messages[3].content
    assert (second.stage, second.agent, second.template, second.reply) == ("counting", "me", "t", FORM)
    assert model.total.outcomes == {"unreadable": 1, "repaired": 1, "illegal": 1}


@pytest.mark.parametrize("repairs", [0, 1, 3])
def test_the_last_error_stands_when_all_repairs_fail(repairs: int) -> None:
    model, script = asked(*(f"no{i}" for i in range(9)))
    with pytest.raises(ReplyError, match=f"no{repairs}"):
        ValidatingModel(model, repairs).complete(QUESTION)
    assert len(script.requests) == repairs + 1
    assert model.total.outcomes == {"unreadable": repairs + 1, "invalid": 1}


def test_a_model_that_gives_no_text_is_asked_again_without_showing_any() -> None:
    model, script = asked(ReplyError("cut off", "truncated"), "7")
    assert ValidatingModel(model).complete(QUESTION).parsed == 7
    assert [it.role for it in script.requests[1].messages] == ["system", "user", "user"]
    assert model.total.outcomes == {"truncated": 1, "repaired": 1}


@pytest.mark.parametrize("error", [ModelError("no key"), ModelBusy("later"), BudgetReached("enough")])
def test_other_errors_pass_at_once(error: Exception) -> None:
    model, script = asked(error, "7")
    with pytest.raises(type(error)):
        ValidatingModel(model).complete(QUESTION)
    assert len(script.requests) == 1
    assert model.total.outcomes == {}


def test_a_huge_reply_is_shown_in_part_and_can_be_sent() -> None:
    def refuse(text: str) -> Reading:
        raise ReplyError(text * 3, "unreadable")

    _, script = asked("\ud800" + "x" * 1_000_000, "")
    question = LMRequest(PROMPT, "counting", reply=ReplyFormat("number", {}, refuse))
    with pytest.raises(ReplyError):
        ValidatingModel(script).complete(question)
    shown, problem = script.requests[1].messages[2:]
    assert len(shown.content.encode("utf-8")) <= MAX_SHOWN_REPLY + 3
    assert len(problem.content) < MAX_SHOWN_PROBLEM + 300


def test_a_repair_that_does_not_fit_into_the_window_is_not_asked_for() -> None:
    script = Narrow(["seven", "7"])
    with pytest.raises(ReplyError, match="seven"):
        ValidatingModel(script).complete(LMRequest(PROMPT, "counting", 50, reply=FORM))
    assert len(script.requests) == 1


def test_a_negative_number_of_repairs_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="repairs=-1"):
        ValidatingModel(ScriptedModel([]), -1)
