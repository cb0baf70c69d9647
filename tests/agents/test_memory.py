"""What a robot's memory makes of observations and messages."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from adhoc.agents.communication import detection_message, state_payload, task_state_message
from adhoc.agents.memory import Memory
from adhoc.agents.news import merge_news
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability, ObjectRecord, Pose
from adhoc.houses.samples import sample_house
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.worlds.pybullet_world import PyBulletWorld

FORK = ObjectRecord(
    "Fork|1", "Fork", (1.0, 1.0, 0.5), "room|2", "Sofa|2|0", "Sofa", True, is_pickupable=True, last_seen=3
)


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld()
    yield world
    world.close()


def memory() -> Memory:
    return Memory("robot", TidyingUp(), messages_kept=5, events_kept=4)


def said(message: Message, step: int = 3, sender: str = "teammate_1") -> Message:
    return replace(message, sender=sender, step=step)


def state_of(sub_task: Call | None = None, **changes) -> dict:
    pose, capability = Pose(1.0, 1.0), Capability()
    return {**state_payload(pose, capability, "room|2", None, 100, sub_task, None), **changes}


class TestHearing:
    def test_a_told_misplaced_object_needs_attention_once(self):
        robot = memory()
        message = said(detection_message([FORK], ["room|9"]))
        assert robot.hear([message]).told == ("Fork|1",)
        assert robot.hear([message]).told == ()
        assert [record.id for record in robot.attention()] == ["Fork|1"]

    def test_what_a_teammate_put_right_needs_none_any_more(self):
        robot = memory()
        robot.hear([said(detection_message([FORK], []))])
        put = replace(FORK, receptacle="CounterTop|1", receptacle_category="CounterTop", misplaced=False)
        assert robot.hear([said(detection_message([put], []), step=9)]).settled == ("Fork|1",)
        assert list(robot.attention()) == []

    def test_an_object_is_claimed_by_who_works_on_it_or_holds_it(self):
        robot = memory()
        assert robot.claimed("Fork|1") is None
        sub_task = Call("Re-place", ("Fork|1", "CounterTop", "Kitchen"))
        robot.hear([said(task_state_message("", state_of(sub_task)))])
        assert robot.claimed("Fork|1") == "teammate_1"
        robot.hear([said(task_state_message("", state_of(None)))])
        assert robot.claimed("Fork|1") is None
        robot.hear([said(task_state_message("", state_of(None, holding="Fork|1")))])
        assert robot.claimed("Fork|1") == "teammate_1"

    def test_the_claim_of_a_silent_teammate_is_void_after_a_while(self):
        robot = Memory("robot", TidyingUp(), claims_kept=20)
        sub_task = Call("Re-place", ("Fork|1", "CounterTop", "Kitchen"))
        robot.hear([said(task_state_message("", state_of(sub_task)), step=3)])
        for step, claimant in ((23, "teammate_1"), (24, None)):
            robot._step = step
            assert robot.claimed("Fork|1") == claimant

    def test_a_teammate_stops_once(self):
        robot = memory()
        message = said(task_state_message("I stop.", state_of(stopped=True)))
        assert robot.hear([message]).stopped == ("teammate_1",)
        assert robot.hear([message]).stopped == ()

    def test_team_talk_is_noise(self):
        robot = memory()
        robot.hear([said(Message(MessageKind.TEAM, "psst", {"objects": [{"id": "X"}]}))])
        assert not robot.messages
        assert not robot.teammates

    def test_what_is_kept_is_bounded_and_the_earliest_goes_first(self):
        robot = memory()
        for step in range(9):
            robot.hear([said(Message(MessageKind.TASK_STATE, str(step)), step=step)])
            robot.note(f"event {step}")
        assert [message.text for message in robot.messages] == ["4", "5", "6", "7", "8"]
        assert [event.text for event in robot.events] == ["event 5", "event 6", "event 7", "event 8"]


class TestSeeing:
    def start(self, world: PyBulletWorld):
        """A robot that looks at a desk on which a candle was put, where no candle belongs."""
        house = sample_house("one_room")
        world.reset(house, 0)
        assert world.displace("Candle|2|0", "Desk|2|0", 0)
        x, y, _ = house.object("Desk|2|0").position
        observation = world.add_agent("robot", Capability(), Pose(x - 1.0, y, 0.0, math.pi / 6))
        robot = memory()
        _, first = robot.observe(observation)
        assert first.misplaced == ()
        turns = (ActionName.ROTATE_LEFT, ActionName.ROTATE_RIGHT)
        later = [robot.observe(world.step({"robot": Action(turn)})["robot"])[1] for turn in turns]
        return robot, merge_news(*later)

    def test_it_judges_what_it_sees_and_knows_nothing_else(self, world):
        robot, news = self.start(world)
        assert news.misplaced == ("Candle|2|0",)
        assert robot.record("Candle|2|0").receptacle == "Desk|2|0"
        assert robot.record("Laptop|2|0").misplaced is not True
        assert robot.record("Book|2|1") is None
        assert len(robot.perception.objects) < 0.6 * len(sample_house("one_room").objects)

    def test_the_hand_is_remembered_and_what_leaves_it_is_placed(self, world):
        robot, _ = self.start(world)
        observation = world.step({"robot": Action(ActionName.PICK_UP, "Candle|2|0")})["robot"]
        assert observation.last_result.ok, observation.last_result
        robot.observe(observation)
        assert robot.held.category == "Candle"
        assert robot.record("Candle|2|0") == robot.held
        observation = world.step({"robot": Action(ActionName.PUT_DOWN, "Desk|2|0")})["robot"]
        assert observation.last_result.ok, observation.last_result
        _, news = robot.observe(observation)
        assert news.placed == ("Candle|2|0",)
        assert robot.held is None
        assert robot.record("Candle|2|0").receptacle == "Desk|2|0"
