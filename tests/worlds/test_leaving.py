from __future__ import annotations

import pytest

from adhoc.core.errors import WorldError
from adhoc.core.values import ActionName, Capability, Pose
from adhoc.testing.world_contract import DOWN, act, contract_house
from adhoc.worlds.placement import PlacementRules
from adhoc.worlds.pybullet_world import PyBulletWorld


def test_where_nothing_can_lie_a_robot_that_holds_something_cannot_leave():
    world = PyBulletWorld(image_size=64, placement=PlacementRules(most_moved=-1.0))
    world.reset(contract_house(), 0)
    world.add_agent("robot", Capability(), Pose(2.0, 2.0, 0.0, DOWN))
    other = world.add_agent("other", Capability(), Pose(1.0, 2.0))
    act(world, ActionName.PICK_UP, "apple")
    before = world.fingerprint()
    with pytest.raises(WorldError, match="no floor has a place for 'apple'"):
        world.remove_agent("robot")
    assert world.fingerprint() == before
    assert set(world.agents()) == {"robot", "other"}
    assert not world.is_free(Pose(2.0, 2.0))
    assert "robot" in {label.id for label in other.labels.values()}
    assert "robot" in {label.id for label in world.observe("other").labels.values()}
    world.close()
