"""A heuristic robot says when it is out of order, while it still can."""

from __future__ import annotations

from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.core.messages import MessageKind
from adhoc.core.values import Capability
from adhoc.houses.samples import sample_house
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.worlds.pybullet_world import PyBulletWorld


def test_the_last_step_of_battery_is_announced():
    world = PyBulletWorld(image_size=64)
    world.reset(sample_house("one_room"), 0)
    observation = world.add_agent("robot", Capability(max_steps=4), world.free_poses(1, 5)[0])
    robot = HeuristicPolicy()
    robot.reset("robot", Capability(max_steps=4), TidyingUp(), 0, lambda message: ())
    stopped = []
    for _ in range(4):
        turn = robot.act(observation, ())
        stopped.append({it.kind: it.payload.get("stopped") for it in turn.outbox})
        observation = world.step({"robot": turn.action})["robot"]
    world.close()
    assert [said[MessageKind.TEAM] for said in stopped] == [False, False, False, True]
    assert stopped[-1][MessageKind.TASK_STATE] is True
