"""Jobs of one step whose questions go out together."""

from __future__ import annotations

import threading
import time

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import BudgetReached, ModelError, ReplyError
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper
from adhoc.llm.side_by_side import GatheringModel, side_by_side

PATIENCE_S = 5.0


def ask(model: LanguageModel, text: str) -> str:
    return model.complete(LMRequest((ChatMessage("user", text),), "sub_skill")).text


class Echo(LanguageModel):
    """Answers with the question, or raises the error that it is to; notes what it was asked, in order."""

    name = "echo"

    def __init__(self, errors: dict[str, BaseException] | None = None) -> None:
        self.errors = errors or {}
        self.asked: list[str] = []

    def complete(self, request: LMRequest) -> LMResponse:
        text = request.messages[0].content
        self.asked.append(text)
        if text in self.errors:
            raise self.errors[text]
        return LMResponse(text.upper(), self.name)


class Meeting(Echo):
    """Answers when `count` questions are there at the same time, the last one first."""

    def __init__(self, count: int) -> None:
        super().__init__()
        self.barrier = threading.Barrier(count)

    def complete(self, request: LMRequest) -> LMResponse:
        self.barrier.wait(PATIENCE_S)
        time.sleep(0.02 * (3 - int(request.messages[0].content[0])))
        return super().complete(request)


class OneByOne(Wrapper):
    def may_go_together(self, requests: object) -> bool:
        return False


def asking(model: LanguageModel, *questions: str, log: list[str] | None = None):
    def job() -> list[str]:
        answers = []
        for question in questions:
            answers.append(ask(model, question))
            if log is not None:
                log.append(answers[-1])
        return answers

    return job


def test_questions_of_one_moment_go_out_together_and_their_order_of_arrival_changes_nothing():
    inner, log = Meeting(3), []
    model = GatheringModel(inner)
    answers = side_by_side([asking(model, f"{n}a", f"{n}b", log=log) for n in range(3)])
    assert answers == [["0A", "0B"], ["1A", "1B"], ["2A", "2B"]]
    assert log == ["0A", "1A", "2A", "0B", "1B", "2B"]


def test_jobs_may_ask_differently_often():
    inner = Echo()
    model = GatheringModel(inner)
    jobs = [asking(model), asking(model, "a", "b"), asking(model, "c")]
    assert side_by_side(jobs) == [[], ["A", "B"], ["C"]]
    assert sorted(inner.asked[:2]) == ["a", "c"]
    assert inner.asked[2] == "b"


def test_only_one_job_runs_at_a_time():
    model, inside = GatheringModel(Echo()), []

    def job(name: str) -> str:
        for number in range(3):
            assert not inside
            inside.append(name)
            time.sleep(0.005)
            inside.remove(name)
            ask(model, f"{name}{number}")
        return name

    assert side_by_side([lambda: job("a"), lambda: job("b")]) == ["a", "b"]


def test_a_model_that_may_not_is_asked_one_by_one_in_the_order_of_the_jobs():
    inner = Echo()
    model = GatheringModel(OneByOne(inner))
    side_by_side([asking(model, "c"), asking(model, "b"), asking(model, "a")])
    assert inner.asked == ["c", "b", "a"]


def test_outside_of_jobs_the_model_is_asked_at_once():
    assert ask(GatheringModel(Echo()), "a") == "A"


def test_a_single_job_runs_in_the_thread_of_the_caller():
    assert side_by_side([threading.get_ident]) == [threading.get_ident()]
    assert side_by_side([]) == []


def test_two_models_are_asked_each_for_itself():
    first, second = Echo(), Echo()
    jobs = [asking(GatheringModel(first), "a"), asking(GatheringModel(second), "b")]
    assert side_by_side(jobs) == [["A"], ["B"]]
    assert (first.asked, second.asked) == (["a"], ["b"])


def test_a_reply_of_no_use_is_the_business_of_the_job_that_asked():
    model = GatheringModel(Echo({"a": ReplyError("nothing")}))

    def lenient() -> str:
        try:
            return ask(model, "a")
        except ReplyError as error:
            return str(error)

    assert side_by_side([lenient, asking(model, "b")]) == ["nothing", ["B"]]


@pytest.mark.parametrize("error", [BudgetReached("over", "episode", "cap"), ModelError("no key")])
def test_an_error_of_the_model_ends_all_jobs(error):
    model = GatheringModel(OneByOne(Echo({"b": error})))
    ended: list[str] = []

    def job(question: str) -> None:
        try:
            ask(model, question)
            ended.append(f"{question} answered")
        finally:
            ended.append(question)

    before = threading.active_count()
    with pytest.raises(type(error)):
        side_by_side([lambda: job("a"), lambda: job("b"), lambda: job("c")])
    assert ended == ["a", "b", "c"]
    assert threading.active_count() == before


def test_an_error_of_a_job_is_raised_and_those_after_it_do_not_begin():
    model, begun = GatheringModel(Echo()), []

    def failing() -> None:
        begun.append("failing")
        raise ValueError("mine")

    with pytest.raises(ValueError, match="mine"):
        side_by_side([asking(model, "a"), failing, lambda: begun.append("late")])
    assert begun == ["failing"]


def test_a_job_that_is_given_up_asks_nothing_more():
    inner = Echo({"b": ModelError("gone")})
    model = GatheringModel(OneByOne(inner))

    def stubborn() -> None:
        try:
            ask(model, "a")
        finally:
            ask(model, "again")

    with pytest.raises(ModelError):
        side_by_side([stubborn, asking(model, "b")])
    assert inner.asked == ["a", "b"]
