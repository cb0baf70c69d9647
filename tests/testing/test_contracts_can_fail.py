"""Each test of the contract of policies fails for a policy that breaks it."""

from __future__ import annotations

import pytest

from adhoc.agents.policy import Policy, Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName
from adhoc.testing.policy_contract import PolicyContract
from adhoc.worlds.pybullet_world import PyBulletWorld

MOVE = Action(ActionName.MOVE_AHEAD)


class Fixed(Policy):
    """Says and does what it is told to, at every step."""

    action, outbox = MOVE, ()

    def reset(self, me, capability, task, seed, ask):
        self.step = 0

    def act(self, observation, inbox):
        self.step += 1
        return Turn(self.action, self.outbox)


class Restless(Fixed):
    def act(self, observation, inbox):
        super().act(observation, inbox)
        return Turn(Action(ActionName.STOP) if self.step == 3 else MOVE)


class Aimless(Fixed):
    action = Action(ActionName.PICK_UP)


class Pointing(Fixed):
    action = Action(ActionName.MOVE_AHEAD, "Mug_1")


class Impostor(Fixed):
    outbox = (Message(MessageKind.TEAM, "hello", sender="somebody else"),)


class Dictator(Fixed):
    def act(self, observation, inbox):
        return Turn("MoveAhead")


class Credulous(Fixed):
    def act(self, observation, inbox):
        for message in inbox:
            [entry["id"] for entry in message.payload.get("objects", ())]
        return Turn(MOVE)


class Trusting(Fixed):
    def reset(self, me, capability, task, seed, ask):
        self.ask = ask

    def act(self, observation, inbox):
        for reply in self.ask(Message(MessageKind.JOIN, "hello")):
            reply.payload["position"]
        return Turn(MOVE)


class Talkative(Fixed):
    def respond(self, message):
        return Message(MessageKind.REPLY, "yes")


class Literal(Fixed):
    def respond(self, message):
        return None if message.kind is MessageKind.TEAM else message.payload["intention"]["name"]


class Moody(Fixed):
    seeds = iter(range(100))

    def act(self, observation, inbox):
        return Turn(Action(list(ActionName)[next(self.seeds) % 8]))


@pytest.fixture
def world():
    world = PyBulletWorld(image_size=16)
    yield world
    world.close()


def contract(policy):
    return type("Contract", (PolicyContract,), {"make": policy})()


CHECKS = sorted(name for name in vars(PolicyContract) if name.startswith("test_"))
BREACHES = [
    (Restless, "test_a_robot_that_stopped_stays_stopped"),
    (Aimless, "test_an_action_has_a_target_exactly_where_it_needs_one"),
    (Pointing, "test_an_action_has_a_target_exactly_where_it_needs_one"),
    (Aimless, "test_a_robot_without_a_hand_does_not_manipulate"),
    (Impostor, "test_a_turn_is_an_action_and_messages_without_sender"),
    (Dictator, "test_a_turn_is_an_action_and_messages_without_sender"),
    (Credulous, "test_foreign_messages_are_endured"),
    (Trusting, "test_foreign_messages_are_endured"),
    (Literal, "test_foreign_questions_are_endured"),
    (Talkative, "test_an_unknown_question_stays_unanswered"),
    (Moody, "test_equal_seeds_give_equal_turns"),
]


def check(policy, name, world):
    arguments = () if name == "test_an_unknown_question_stays_unanswered" else (world,)
    getattr(contract(policy), name)(*arguments)


@pytest.mark.parametrize(("policy", "name"), BREACHES)
def test_a_breach_is_found(policy, name, world):
    with pytest.raises((AssertionError, AttributeError, KeyError, TypeError)):
        check(policy, name, world)


@pytest.mark.parametrize("name", CHECKS)
def test_a_policy_without_fault_passes(name, world):
    check(Fixed, name, world)


def test_every_check_has_a_breach():
    assert {name for _, name in BREACHES} == set(CHECKS)
