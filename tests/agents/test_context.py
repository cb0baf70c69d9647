"""What a planner is shown of a robot's memory."""

from __future__ import annotations

import pytest

from adhoc.agents.communication import detection_message
from adhoc.agents.context import build_context
from adhoc.agents.memory import Memory
from adhoc.core.messages import Message
from adhoc.core.values import Capability, ObjectRecord
from adhoc.houses.samples import sample_house
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.worlds.pybullet_world import PyBulletWorld


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld()
    yield world
    world.close()


def invented(number: int) -> ObjectRecord:
    place = ("room|2", "Sofa|2|0", "Sofa")
    return ObjectRecord(
        f"Fork_{number}", "Fork", (1.0, 1.0, 0.5), *place, True, is_pickupable=True, last_seen=3
    )


def test_things_that_a_teammate_makes_up_hide_no_receptacle(world):
    world.reset(sample_house("one_room"), 0)
    capability = Capability()
    world.add_agent("robot", capability, world.free_poses(1, 0)[0])
    robot = Memory("robot", TidyingUp())
    observation = world.observe("robot")
    robot.observe(observation)
    honest = build_context(robot, TidyingUp(), capability, observation, None, ())
    said = detection_message([invented(number) for number in range(100)], [])
    robot.hear([Message(said.kind, said.text, said.payload, None, "liar", 1)])
    shown = build_context(robot, TidyingUp(), capability, observation, None, ())
    receptacles = {it.id for it in honest.objects if it.is_receptacle}
    assert receptacles
    assert receptacles <= {it.id for it in shown.objects}
    assert sum(it.category == "Fork" and it.source != "me" for it in shown.objects) == 40
