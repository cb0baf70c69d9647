from __future__ import annotations

import math

import pytest
from box_rooms import item, room_house, shell, table

from adhoc.core.values import Action, ActionName, Capability, Failure, Pose
from adhoc.houses.house import FLOOR
from adhoc.houses.solids import Box, Solid, SolidKind, Surface
from adhoc.worlds.bullet import Bullet
from adhoc.worlds.placement import PlacementRules
from adhoc.worlds.pybullet_world import PyBulletWorld

DOWN = math.pi / 6


@pytest.fixture
def build():
    """Builds a world from solids in a room of 4 x 4 m, with `robot` looking down along +x."""
    worlds = []

    def _build(*solids, pose=None, robot=True, **options):
        world = PyBulletWorld(solids_of=lambda house: [*shell(4.0), *solids], **options)
        worlds.append(world)
        world.reset(room_house(4.0), 0)
        if robot:
            world.add_agent("robot", Capability(), pose or Pose(2.0, 2.0, 0.0, DOWN))
        return world

    yield _build
    for world in worlds:
        world.close()


def act(world, name, target=None):
    return world.step({"robot": Action(name, target)})["robot"]


def shelf(clearance):
    """Two boards 0.6 m wide and 0.3 m deep, at heights 0.5 and 0.5 + clearance, on a back wall."""
    upper = 0.5 + clearance + 0.02
    boards = [Box((2.85, 2.0, height - 0.01), (0.15, 0.3, 0.01)) for height in (0.5, upper)]
    back = Box((3.01, 2.0, upper / 2), (0.01, 0.3, upper / 2))
    surfaces = (
        Surface((2.85, 2.0, 0.5), (0.15, 0.3), 0.0, clearance),
        Surface((2.85, 2.0, upper), (0.15, 0.3), 0.0, math.inf),
    )
    return Solid("shelf", "Shelf", SolidKind.FURNITURE, (*boards, back), surfaces)


CUP = item("cup", (2.4, 2.6, 0.45), (0.05, 0.05, 0.1))
STAND = table("stand", (2.4, 2.6), (0.1, 0.1), 0.349)


def test_a_tall_thing_goes_only_where_the_clearance_allows(build):
    world = build(shelf(clearance=0.19), STAND, CUP)
    assert act(world, ActionName.PICK_UP, "cup").held == "cup"
    assert act(world, ActionName.PUT_DOWN, "shelf").last_result.ok
    assert world.truth()["cup"].position[2] == pytest.approx(0.5 + 0.19 + 0.02 + 0.1, abs=0.005)


def test_a_thing_goes_into_the_shelf_where_it_fits(build):
    world = build(shelf(clearance=0.25), STAND, CUP)
    act(world, ActionName.PICK_UP, "cup")
    assert act(world, ActionName.PUT_DOWN, "shelf").last_result.ok
    truth = world.truth()["cup"]
    assert truth.receptacle == "shelf"
    # Both boards have a place at x = 2.75 and y = 2.0; of equally near places the first board's is taken.
    assert truth.position == pytest.approx((2.75, 2.0, 0.6), abs=0.005)


def test_the_nearest_place_is_taken_first(build):
    plate = table("plate", (2.9, 2.0), (0.5, 0.5), 0.5)
    world = build(plate, item("cup", (2.5, 2.0, 0.551), (0.05, 0.05, 0.05)))
    act(world, ActionName.PICK_UP, "cup")
    act(world, ActionName.PUT_DOWN, "plate")
    # The surface reaches to x = 2.4; half the cup's width is 0.05; the grid of 0.05 m is centred on 2.9.
    assert world.truth()["cup"].position == pytest.approx((2.45, 2.0, 0.55), abs=0.005)


def test_an_occupied_place_is_left_out(build):
    stand = table("stand", (2.6, 2.0), (0.1, 0.2), 0.5)
    first, second = (item(name, (2.6, y, 0.601), (0.09, 0.09, 0.1)) for name, y in (("a", 2.1), ("b", 1.9)))
    world = build(stand, first, second)
    act(world, ActionName.PICK_UP, "b")
    assert act(world, ActionName.PUT_DOWN, "stand").last_result.ok
    assert world.truth()["b"].position[1] < 1.92


def test_a_full_receptacle_has_no_free_place_and_the_hand_keeps_the_thing(build):
    small = table("small", (2.6, 2.0), (0.06, 0.06), 0.5)
    world = build(small, item("a", (2.6, 2.0, 0.551), (0.05, 0.05, 0.05)), STAND, CUP)
    assert act(world, ActionName.PICK_UP, "cup").held == "cup"
    seen = act(world, ActionName.PUT_DOWN, "small")
    assert seen.last_result.failure is Failure.NO_FREE_PLACE
    assert seen.held == "cup"
    assert "cup" not in {label.id for label in seen.labels.values()}


def test_a_long_thing_is_turned_where_it_only_fits_so(build):
    board = table("board", (2.7, 2.0), (0.1, 0.4), 0.5)
    world = build(board, item("ruler", (2.4, 2.6, 0.401), (0.3, 0.05, 0.05)), STAND)
    assert act(world, ActionName.PICK_UP, "ruler").held == "ruler"
    assert act(world, ActionName.PUT_DOWN, "board").last_result.ok
    seen = world.observe("robot")
    number = next(key for key, label in seen.labels.items() if label.id == "ruler")
    rows, columns = (seen.instances == number).nonzero()
    assert columns.max() - columns.min() > 3 * (rows.max() - rows.min())


def test_a_surface_that_supports_nothing_fails_the_physical_check(build):
    # The surface claims to be 0.3 m above the block that it belongs to.
    block = Box((2.7, 2.0, 0.2), (0.3, 0.3, 0.2))
    liar = Solid(
        "liar",
        "Table",
        SolidKind.FURNITURE,
        (block,),
        (Surface((2.7, 2.0, 0.7), (0.3, 0.3), 0.0, math.inf),),
    )
    world = build(liar, STAND, CUP)
    act(world, ActionName.PICK_UP, "cup")
    assert act(world, ActionName.PUT_DOWN, "liar").last_result.failure is Failure.NO_FREE_PLACE
    assert not world.displace("cup", "liar", 0)
    lenient = build(liar, STAND, CUP, placement=PlacementRules(most_moved=1.0))
    act(lenient, ActionName.PICK_UP, "cup")
    assert act(lenient, ActionName.PUT_DOWN, "liar").last_result.ok


def test_a_thing_that_tilts_is_refused(build):
    # The saucer comes to rest on two ridges 0.12 m apart, one 0.035 m lower: 16 degrees, 0.02 m down.
    ridges = tuple(Box((x, 2.0, top / 2), (0.005, 0.1, top / 2)) for x, top in ((2.64, 0.5), (2.76, 0.465)))
    surface = Surface((2.7, 2.0, 0.5), (0.08, 0.08), 0.0, math.inf)
    rack = Solid("rack", "Rack", SolidKind.FURNITURE, ridges, (surface,))
    saucer = item("saucer", (1.0, 1.0, 0.011), (0.08, 0.08, 0.01))
    for rules, accepted in (
        (PlacementRules(most_moved=0.1), False),
        (PlacementRules(most_moved=0.1, most_tilted=math.radians(25.0)), True),
        (PlacementRules(most_moved=0.005, most_tilted=math.radians(25.0)), False),
    ):
        world = build(rack, saucer, robot=False, placement=rules)
        assert world.displace("saucer", "rack", 0) is accepted


def test_a_receptacle_that_holds_something_is_not_picked_up_until_emptied(build):
    desk = table("desk", (2.7, 2.0), (0.3, 0.3), 0.5)
    plate = Solid(
        "plate",
        "Plate",
        SolidKind.ITEM,
        (Box((2.6, 2.0, 0.511), (0.12, 0.12, 0.01)),),
        (Surface((2.6, 2.0, 0.521), (0.12, 0.12), 0.0, math.inf),),
        0.5,
    )
    world = build(desk, plate, STAND, CUP)
    act(world, ActionName.PICK_UP, "cup")
    assert act(world, ActionName.PUT_DOWN, "plate").last_result.ok
    assert world.truth()["cup"].receptacle_category == "Plate"
    refused = act(world, ActionName.PICK_UP, "plate").last_result
    assert refused.failure is Failure.NOT_PICKUPABLE
    assert "cup" in refused.detail
    assert not world.displace("plate", FLOOR, 0)
    assert act(world, ActionName.PICK_UP, "cup").held == "cup"
    act(world, ActionName.DROP)
    assert act(world, ActionName.PICK_UP, "plate").held == "plate"
    assert not world.displace("cup", "plate", 0)


def test_a_moved_receptacle_takes_its_surface_along(build):
    tray = Solid(
        "tray",
        "Tray",
        SolidKind.ITEM,
        (Box((2.4, 2.6, 0.361), (0.1, 0.1, 0.01)),),
        (Surface((2.4, 2.6, 0.371), (0.1, 0.1), 0.0, math.inf),),
        0.5,
    )
    world = build(STAND, tray, item("nut", (3.0, 1.0, 0.031), (0.03, 0.03, 0.03)), robot=False)
    assert world.displace("tray", FLOOR, 1)
    assert world.displace("nut", "tray", 2)
    tray_at, nut_at = (world.truth()[name].position for name in ("tray", "nut"))
    assert nut_at[2] == pytest.approx(0.02 + 0.03, abs=0.004)
    assert math.dist(tray_at[:2], nut_at[:2]) < 0.1


def test_mass_scale_makes_payloads_bind(build):
    heavy = build(STAND, CUP, mass_scale=200.0)
    assert act(heavy, ActionName.PICK_UP, "cup").last_result.failure is Failure.TOO_HEAVY


def test_dropping_avoids_what_lies_there(build):
    world = build(STAND, CUP, item("brick", (2.35, 2.0, 0.051), (0.1, 0.1, 0.05)))
    act(world, ActionName.PICK_UP, "cup")
    assert act(world, ActionName.DROP).last_result.ok
    x, y, _ = world.truth()["cup"].position
    assert max(abs(x - 2.35), abs(y - 2.0)) >= 0.15
    assert math.dist((x, y), (2.0, 2.0)) <= 1.5


def test_a_failed_displacement_leaves_everything_as_it_was(build):
    world = build(table("small", (3.0, 3.0), (0.02, 0.02), 0.5), STAND, CUP)
    before = world.truth()
    assert not world.displace("cup", "small", 0)
    assert world.truth() == before
    assert act(world, ActionName.PICK_UP, "cup").held == "cup"
    assert not world.displace("cup", FLOOR, 0)


def test_the_clearance_counts_even_where_nothing_is_in_the_way(build):
    # A closed compartment may be modelled without its lid: the surface alone says how high it is.
    box = Box((2.7, 2.0, 0.25), (0.3, 0.3, 0.25))
    low, high = (
        Solid("desk", "Desk", SolidKind.FURNITURE, (box,), (Surface((2.7, 2.0, 0.5), (0.3, 0.3), 0.0, free),))
        for free in (0.19, 0.21)
    )
    assert not build(low, STAND, CUP, robot=False).displace("cup", "desk", 0)
    assert build(high, STAND, CUP, robot=False).displace("cup", "desk", 0)


def test_a_thing_is_not_dropped_beyond_reach(build):
    # Blocks around the robot leave no floor free within 1.5 m, but there is some farther away.
    blocks = [
        table(f"block {index}", (2.0 + dx, 2.0 + dy), half, 0.3)
        for index, (dx, dy, half) in enumerate(
            [
                (0.91, 0.0, (0.69, 1.6)),
                (-0.91, 0.0, (0.69, 1.6)),
                (0.0, 0.91, (0.21, 0.69)),
                (0.0, -0.91, (0.21, 0.69)),
            ]
        )
    ]
    cup = item("cup", (2.6, 2.0, 0.401), (0.05, 0.05, 0.1))
    world = build(*blocks, cup)
    assert act(world, ActionName.PICK_UP, "cup").held == "cup"
    seen = act(world, ActionName.DROP)
    assert seen.last_result.failure is Failure.NO_FREE_PLACE
    assert seen.held == "cup"
    far = build(*blocks, cup, visibility_distance=3.0)
    act(far, ActionName.PICK_UP, "cup")
    assert act(far, ActionName.DROP).last_result.ok


def test_no_more_places_are_tried_physically_than_allowed(build, monkeypatch):
    falls = []
    fall = Bullet.fall

    def counted(self, *arguments):
        falls.append(arguments)
        return fall(self, *arguments)

    monkeypatch.setattr(Bullet, "fall", counted)
    block = Box((2.7, 2.0, 0.2), (0.3, 0.3, 0.2))
    surface = Surface((2.7, 2.0, 0.7), (0.3, 0.3), 0.0, math.inf)
    liar = Solid("liar", "Table", SolidKind.FURNITURE, (block,), (surface,))
    world = build(liar, STAND, CUP, robot=False, placement=PlacementRules(most_falls=2))
    assert not world.displace("cup", "liar", 0)
    assert len(falls) == 2
