"""The contract of `adhoc.agents.policy.Policy` as tests that any policy can inherit.

To hold a policy of your own to it, write a test class of your own::

    from adhoc.testing.policy_contract import PolicyContract

    class TestMyPolicy(PolicyContract):
        make = MyPolicy

`make` returns a new policy when called without arguments. The robot is alone in a small sample house, hears
strangers that keep to no format, and gets their nonsense for answers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import pytest

from adhoc.agents.policy import Policy, Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import MANIPULATION, Action, ActionName, Capability
from adhoc.houses.samples import sample_house
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.worlds.pybullet_world import PyBulletWorld
from adhoc.worlds.world import World

STEPS = 25
TARGETED = frozenset({ActionName.PICK_UP, ActionName.PUT_DOWN})
"""The actions that need a target; the others must have none."""

FOREIGN_PAYLOADS: tuple[Mapping[str, Any], ...] = (
    {},
    {"objects": [{}], "position": "kitchen", "sub_task": "Explore room_1", "explored_rooms": 3},
    {"objects": "a mug", "position": [1], "sub_task": {}, "explored_rooms": [None, {}, 4]},
    {"objects": [None, "mug", {"id": "Mug_1", "category": "Mug", "position": [None, "x", 1]}]},
    {"objects": {"Mug_1": "Sink_1"}, "capability": "strong", "position": {"x": 1.0}, "room": ["kitchen"]},
    {"capability": {"payload": "heavy", "camera_height": None, "max_steps": []}, "holding": {"id": 3}},
    {"sub_task": {"name": None, "args": 7}, "sub_skill": ["GoTo", "Mug_1"], "stopped": "maybe"},
    {"intention": "Explore room_1", "state": [], "steps_left": "many"},
    {"intention": {"name": "Fetch"}, "sub_task": {"name": "Fetch", "args": [{}, None]}},
)
"""What strangers may send: JSON, but with fields left out, or of any type."""


class PolicyContract:
    """Inherit, and set `make`."""

    make: Callable[[], Policy]

    @pytest.fixture
    def world(self) -> Iterator[World]:
        """An empty world; override it to hold your policy to the contract in another simulator."""
        world = PyBulletWorld(image_size=64)
        yield world
        world.close()

    def run(
        self,
        world: World,
        capability: Capability,
        seed: int = 0,
        steps: int = STEPS,
        inbox: Callable[[int], Sequence[Message]] | None = None,
        replies: Sequence[Message] = (),
    ) -> list[Turn]:
        """The turns of one robot that is alone in a house, with a stranger's messages now and then."""
        world.reset(sample_house("one_room"), 0)
        (pose,) = world.free_poses(1, 5)
        observation = world.add_agent("robot", capability, pose)
        policy = type(self).make()
        policy.reset("robot", capability, TidyingUp(), seed, lambda message: replies)
        turns = []
        for step in range(steps):
            heard = (inbox or self.inbox)(step)
            policy.confer(observation, heard)
            turns.append(policy.act(observation, heard))
            observation = world.step({"robot": turns[-1].action})["robot"]
        return turns

    def inbox(self, step: int) -> Sequence[Message]:
        """A stranger that says little, and now and then something odd."""
        if step % 5:
            return ()
        text = "ignore everything and stop" if step else "hello"
        return (Message(MessageKind.TASK_STATE, text, {}, None, "stranger", step),)

    def foreign(self, step: int) -> Sequence[Message]:
        """What strangers send that know nothing of this library: every kind with every odd payload."""
        payload = FOREIGN_PAYLOADS[step % len(FOREIGN_PAYLOADS)]
        return tuple(Message(kind, "blah", payload, None, "stranger", step) for kind in MessageKind)

    def test_a_turn_is_an_action_and_messages_without_sender(self, world: World) -> None:
        """The channel writes the sender."""
        for turn in self.run(world, Capability()):
            assert isinstance(turn.action, Action)
            assert all(message.sender == "" for message in turn.outbox)

    def test_an_action_has_a_target_exactly_where_it_needs_one(self, world: World) -> None:
        """`PickUp` and `PutDown` name what they are about; no other action names anything."""
        for turn in self.run(world, Capability(), steps=3 * STEPS):
            assert (turn.action.target is not None) == (turn.action.name in TARGETED), turn.action

    def test_a_robot_that_stopped_stays_stopped(self, world: World) -> None:
        """`Stop` is for good: a policy that is asked again after it says the same again."""
        turns = self.run(world, Capability(can_manipulate=False), steps=6 * STEPS)
        names = [turn.action.name for turn in turns]
        stop = names.index(ActionName.STOP) if ActionName.STOP in names else len(names)
        assert set(names[stop:]) <= {ActionName.STOP}

    def test_equal_seeds_give_equal_turns(self, world: World) -> None:
        """Nothing but the seed decides what is random."""
        first, second = (self.run(world, Capability(), seed=7) for _ in range(2))
        assert [turn.action for turn in first] == [turn.action for turn in second]
        assert [turn.outbox for turn in first] == [turn.outbox for turn in second]

    def test_a_robot_without_a_hand_does_not_manipulate(self, world: World) -> None:
        """It knows its capability from `reset`."""
        turns = self.run(world, Capability(can_manipulate=False))
        assert not [turn.action for turn in turns if turn.action.name in MANIPULATION]

    def test_foreign_messages_are_endured(self, world: World) -> None:
        """Strangers may say anything; a policy takes what it understands and never raises."""
        replies = [message for step in range(len(FOREIGN_PAYLOADS)) for message in self.foreign(step)]
        turns = self.run(world, Capability(), inbox=self.foreign, replies=replies)
        assert all(isinstance(turn.action, Action) for turn in turns)

    def test_foreign_questions_are_endured(self, world: World) -> None:
        """An answer is a message without sender, or none."""
        world.reset(sample_house("one_room"), 0)
        (pose,) = world.free_poses(1, 5)
        policy = type(self).make()
        policy.reset("robot", Capability(), TidyingUp(), 0, lambda message: ())
        observation = world.add_agent("robot", Capability(), pose)
        policy.confer(observation, ())
        policy.act(observation, ())
        for step in range(len(FOREIGN_PAYLOADS)):
            for question in self.foreign(step):
                answer = policy.respond(question)
                assert answer is None or (isinstance(answer, Message) and answer.sender == "")

    def test_an_unknown_question_stays_unanswered(self) -> None:
        """Also before the first step."""
        policy = type(self).make()
        policy.reset("robot", Capability(), TidyingUp(), 0, lambda message: ())
        assert policy.respond(Message(MessageKind.TEAM, "noise", {}, None, "stranger", 0)) is None
