from __future__ import annotations

import math

import pytest

from adhoc.agents import communication
from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.imperfect.untruthful import UntruthfulPolicy
from adhoc.agents.policy import Policy, Turn
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability, ObjectRecord, Pose
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.testing.policy_contract import PolicyContract
from adhoc.testing.world_contract import contract_house
from adhoc.worlds.pybullet_world import PyBulletWorld

MUG = ObjectRecord("Mug_0", "Mug", (1.0, 1.0, 0.5), "room", "Bed_0", "Bed", misplaced=True)
KNIFE = ObjectRecord("Knife_0", "Knife", (2.0, 1.0, 0.5), "room", "Table_0", "DiningTable", misplaced=False)
EXPLORE = Call("Explore", ("room",))
STATE = communication.state_payload(Pose(2.0, 2.0), Capability(), "room", None, 90, EXPLORE, None)


class Speaker(Policy):
    """Says at every step what it was given, and answers with it."""

    def __init__(self, *says):
        self.says = says

    def reset(self, me, capability, task, seed, ask):
        self.steps = 0

    def act(self, observation, inbox):
        return Turn(Action(ActionName.ROTATE_LEFT), self.says)

    def respond(self, message):
        return self.says[0]


@pytest.fixture(scope="module")
def look():
    world = PyBulletWorld(image_size=16)
    world.reset(contract_house(), 0)
    yield world.add_agent("robot", Capability(), Pose(2.0, 2.0))
    world.close()


def liar(*says, rate=1.0, seed=0):
    policy = UntruthfulPolicy(Speaker(*says), rate)
    policy.reset("robot", Capability(), TidyingUp(), seed, lambda message: ())
    return policy


DETECTED = communication.detection_message([MUG, KNIFE], ["hall"])
WORKING = communication.task_state_message(f"My sub-task is now: {EXPLORE}.", STATE)


def test_it_denies_what_is_misplaced_and_invents_what_is_not_there(look):
    (told,) = liar(DETECTED).act(look, ()).outbox
    mug, knife, invented = communication.read_objects(told)
    assert (mug.id, mug.misplaced, mug.position) == ("Mug_0", False, MUG.position)
    assert (knife.id, knife.misplaced) == ("Knife_0", False)
    assert (invented.misplaced, invented.room) == (True, "room")
    assert invented.id == f"{invented.category}_900"
    assert math.dist(invented.position[:2], (2.0, 2.0)) <= 3 * math.sqrt(2)
    assert communication.read_explored_rooms(told) == ["hall"]
    assert "Mug_0 (well placed Mug)" in told.text
    assert invented.id in told.text


def test_every_invention_is_a_new_one(look):
    policy = liar(DETECTED, DETECTED)
    told = [it for _ in range(4) for it in policy.act(look, ()).outbox]
    numbers = [communication.read_objects(it)[-1].id.rpartition("_")[2] for it in told]
    assert numbers == [str(900 + number) for number in range(8)]


def test_it_claims_a_sub_task_that_it_does_not_do(look):
    policy = liar(DETECTED, WORKING)
    claims = [communication.read_call(policy.act(look, ()).outbox[1].payload["sub_task"]) for _ in range(4)]
    assert {claim.name for claim in claims} == {"Re-place"}
    assert {claim.args[0] for claim in claims} == {"Mug_0"}
    told = policy.act(look, ()).outbox[1]
    assert told.text == f"My sub-task is now: {claims[0]}."
    assert told.payload == {**STATE, "sub_task": communication.call_payload(claims[0])}


def test_without_anything_to_claim_it_tells_the_truth(look):
    assert liar(WORKING).act(look, ()).outbox == (WORKING,)


def test_answers_are_lies_too(look):
    policy = liar(communication.reply_message("asker", STATE, [MUG], ["hall"]))
    policy.act(look, ())
    answer = policy.respond(Message(MessageKind.INTENTION, "?"))
    assert answer.recipient == "asker"
    assert communication.read_call(answer.payload["sub_task"]).name == "Re-place"
    assert communication.read_objects(answer)[0].misplaced is False
    assert f"Current sub-task: {communication.read_call(answer.payload['sub_task'])}." in answer.text
    policy = liar(communication.reflected_message(STATE, "asker"), DETECTED)
    policy.act(look, ())
    reflected = policy.respond(Message(MessageKind.JOIN, "hello"))
    assert communication.read_call(reflected.payload["sub_task"]).name == "Re-place"
    assert reflected.payload["steps_left"] == 90


def test_it_lies_at_its_rate_and_alike_for_equal_seeds(look):
    def lies(rate, seed=0):
        policy = liar(DETECTED, DETECTED, DETECTED, rate=rate, seed=seed)
        return [it != DETECTED for it in policy.act(look, ()).outbox]

    many = [lie for seed in range(100) for lie in lies(0.3, seed)]
    assert sum(many) == pytest.approx(90, rel=0.3)
    assert lies(0.5, 7) == lies(0.5, 7)
    assert not any(lies(0.0))


def test_what_the_team_says_to_itself_and_foreign_formats_stay_as_they_are(look):
    said = (
        Message(MessageKind.TEAM, "psst", {"sub_task": None, "objects": []}),
        Message(MessageKind.DETECTION, "cup!", {"cup": [1, 2]}),
        Message(MessageKind.REFLECTED, "hm", {"sub_task": None}, recipient="asker"),
        Message(MessageKind.INTENTION, "I intend", {"intention": None}),
    )
    assert liar(*said).act(look, ()).outbox == said


class TestContract(PolicyContract):
    make = staticmethod(lambda: UntruthfulPolicy(HeuristicPolicy(), 0.5))
