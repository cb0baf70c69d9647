"""A policy that speaks a dialect does what it does without, and says it in other words."""

from __future__ import annotations

import pytest

from adhoc.agents import communication
from adhoc.agents.dialects.codes import Codes
from adhoc.agents.dialects.known import DIALECTS, dialect_named
from adhoc.agents.dialects.sentences import Sentences
from adhoc.agents.dialects.speaking import Speaking
from adhoc.agents.dialects.structured import Silent, Structured
from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.policy import Policy, Turn
from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability
from adhoc.testing.policy_contract import PolicyContract

TALK = Message(MessageKind.TEAM, "P:1,2", {"x": 1})
REPORT = communication.task_state_message("I go.", {"room": "room|1", "stopped": False})


class Parrot(Policy):
    """Keeps what it hears, and asks, says and answers the same at every step."""

    acts_apart = True

    def reset(self, me, capability, task, seed, ask) -> None:
        self.ask, self.heard, self.answers, self.asked = ask, [], [], []

    def confer(self, observation, inbox) -> None:
        self.heard += inbox
        self.answers += self.ask(communication.intention_message(Call("Explore", ("room|1",))))

    def act(self, observation, inbox) -> Turn:
        self.heard += inbox
        return Turn(Action(ActionName.STOP), (REPORT, TALK), {"said": 2})

    def respond(self, message) -> Message | None:
        self.asked.append(message)
        return REPORT


def speaking(dialect) -> tuple[Parrot, Speaking, list[Message]]:
    parrot, questions = Parrot(), []

    def ask(message: Message) -> list[Message]:
        questions.append(message)
        return [Message(MessageKind.REPLY, "R:room|5", {}, "me", "teammate_2", 0)]

    robot = Speaking(parrot, dialect)
    robot.reset("me", Capability(), None, 0, ask)
    return parrot, robot, questions


def test_what_it_says_is_in_its_dialect_and_its_teams_talk_is_not() -> None:
    parrot, robot, questions = speaking(Codes())
    robot.confer(None, ())
    turn = robot.act(None, ())
    assert [it.text for it in turn.outbox] == ["X:- R:room|1", "P:1,2"]
    assert turn.outbox[1] is TALK
    assert turn.trace == {"said": 2}
    assert [it.text for it in questions] == ["I:Explore,room|1"]
    assert robot.respond(Message(MessageKind.JOIN, "hi")).text == "X:- R:room|1"
    assert robot.acts_apart
    assert parrot.answers[0].payload == {"room": "room|5"}


def test_what_it_hears_is_in_the_librarys_format() -> None:
    parrot, robot, _ = speaking(Sentences())
    inbox = (Message(MessageKind.DETECTION, "R:room|2", {}, None, "t", 1), TALK)
    robot.confer(None, inbox)
    robot.act(None, inbox)
    robot.respond(Message(MessageKind.INTENTION, "I:Explore,room|3", {}, None, "t", 1))
    assert [it.payload for it in parrot.heard] == [{"room": "room|2"}, {"x": 1}] * 2
    assert parrot.asked[0].payload == {"intention": {"name": "Explore", "args": ["room|3"]}}


def test_the_silent_neither_report_nor_ask_nor_answer_but_talk_to_their_team() -> None:
    parrot, robot, questions = speaking(Silent())
    robot.confer(None, ())
    assert robot.act(None, ()).outbox == (TALK,)
    assert robot.respond(Message(MessageKind.JOIN, "hi")) is None
    assert (questions, parrot.answers) == ([], [])
    assert parrot.asked, "it hears questions nevertheless"


def test_the_structured_say_what_they_said() -> None:
    _, robot, _ = speaking(Structured())
    assert robot.act(None, ()).outbox == (REPORT, TALK)


@pytest.mark.parametrize("name", list(DIALECTS))
def test_dialects_have_names(name: str) -> None:
    assert dialect_named(name).name == name


@pytest.mark.parametrize("name", ["esperanto", None, 3, "Codes"])
def test_an_unknown_name_is_an_error_that_says_which_there_are(name) -> None:
    with pytest.raises(ConfigurationError, match="must be one of structured, codes, sentences, silent"):
        dialect_named(name)


class TestSpeakingCodes(PolicyContract):
    make = staticmethod(lambda: Speaking(HeuristicPolicy(), Codes()))


class TestSpeakingNothing(PolicyContract):
    make = staticmethod(lambda: Speaking(HeuristicPolicy(member=False), Silent()))
