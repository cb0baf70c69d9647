import math

import pytest
from box_geometry import blocked, holds, penetration, skin

from adhoc.houses import facts
from adhoc.houses.build import build_solids, object_solid
from adhoc.houses.house import HouseObject
from adhoc.houses.procthor import parse_house
from adhoc.houses.proxy_parts import Load, shelf_levels
from adhoc.houses.solids import Box, SolidKind


@pytest.fixture
def solids(document):
    return {solid.id: solid for solid in build_solids(parse_house(document, "tiny"))}


def test_every_thing_is_one_solid_of_its_kind(solids, document):
    kinds = {solid.id: solid.kind for solid in solids.values()}
    assert kinds["room|2"] is SolidKind.FLOOR
    assert kinds["f"] is kinds["t"] is SolidKind.FURNITURE
    assert kinds["e"] is kinds["b"] is SolidKind.ITEM
    assert kinds["door|1|3"] is kinds["window|2|0"] is SolidKind.DOOR
    assert "door|2|3" not in kinds
    assert sum(kind is SolidKind.WALL for kind in kinds.values()) == 7
    assert len(build_solids(parse_house(document, "tiny"))) == len(solids)


def test_floors_have_their_top_at_zero_and_are_surfaces(solids):
    floor = solids["room|3"]
    assert floor.category == "Floor"
    assert floor.boxes == (Box((6, 1.5, -0.05), (2, 1.5, 0.05)),)
    assert (floor.surfaces[0].center, floor.surfaces[0].half) == ((6, 1.5, 0), (2, 1.5))


def test_a_wall_goes_around_its_door(solids):
    wall = solids["wall|4.00|0.00|4.00|3.00"]
    spans = {tuple(round(value, 6) for value in (*interval(box, 1), *interval(box, 2))) for box in wall.boxes}
    assert spans == {(0, 1.5, 0, 2.5), (1.5, 2.5, 2.0, 2.5), (2.5, 3, 0, 2.5)}
    assert all(interval(box, 0) == pytest.approx((3.99, 4.01)) for box in wall.boxes)


def test_a_window_leaves_wall_below_and_above_and_has_a_pane(solids):
    wall = solids["wall|0.00|0.00|0.00|3.00"]
    middle = sorted(interval(box, 2) for box in wall.boxes if interval(box, 1) == pytest.approx((1, 2.5)))
    assert middle == [pytest.approx((0, 0.8)), pytest.approx((1.7, 2.5))]
    (pane,) = solids["window|2|0"].boxes
    assert interval(pane, 1) == pytest.approx((1, 2.5))
    assert interval(pane, 0) == pytest.approx((-0.005, 0.005))


def test_the_thickness_of_walls_is_a_parameter(document):
    solids = build_solids(parse_house(document, "tiny"), wall_thickness=0.1)
    wall = next(solid for solid in solids if solid.kind is SolidKind.WALL and solid.boxes[0].center[0] == 4)
    assert interval(wall.boxes[0], 0) == pytest.approx((3.95, 4.05))


def test_the_egg_is_seen_from_the_front_of_the_fridge_and_nowhere_else(solids):
    fridge, egg = solids["f"], solids["e"]
    points = skin(egg.boxes[0])
    assert not blocked((2.0, 1.5, 1.2), points, (*fridge.boxes, egg.boxes[0])).all()
    for behind_or_beside in ((-1.0, 1.5, 1.2), (0.45, 0.0, 1.2), (0.45, 3.0, 1.2)):
        assert blocked(behind_or_beside, points, fridge.boxes).all()
    assert all(penetration(part, egg.boxes[0]) < 0.002 for part in fridge.boxes)


def test_a_table_stands_on_legs(solids):
    table = solids["t"]
    assert not any(holds(box, [(6.0, 1.5, 0.3)]).any() for box in table.boxes)
    (surface,) = table.surfaces
    assert surface.center == pytest.approx((6.0, 1.5, 0.75), abs=0.002)
    assert surface.clearance == math.inf


def test_boxes_turn_with_their_furniture():
    thing = furniture("RoboTHOR_sofa_alrid", yaw=math.pi / 2)
    back = max(object_solid(thing).boxes, key=lambda box: box.half[2])
    assert back.center[0] > 0.3
    assert abs(back.center[1]) < 1e-9


def every_furniture():
    return [
        asset
        for category in facts.categories()
        if not facts.category_facts(category).pickupable
        for asset in facts.assets_of(category)
    ]


def test_every_asset_fills_its_bounding_box_and_no_more():
    for asset in every_furniture():
        thing = furniture(asset)
        boxes = object_solid(thing).boxes
        for axis in range(3):
            low = min(interval(box, axis)[0] for box in boxes)
            high = max(interval(box, axis)[1] for box in boxes)
            assert all(min(box.half) > 0 for box in boxes), asset
            middle, extent = thing.position[axis], thing.size[axis]
            assert (low, high) == pytest.approx((middle - extent / 2, middle + extent / 2), abs=0.06), asset


def test_every_receptacle_has_surfaces_that_things_can_lie_on():
    for asset in every_furniture():
        thing = furniture(asset)
        solid = object_solid(thing)
        assert bool(solid.surfaces) >= thing.is_receptacle, asset
        for surface in solid.surfaces:
            assert min(surface.half) > 0.01, asset
            x, y, z = surface.center
            below, above = (x, y, z - 0.002), (x, y, z + 0.03)
            assert any(holds(box, [below]).any() for box in solid.boxes), asset
            assert not any(holds(box, [above]).any() for box in solid.boxes), asset


def test_items_are_single_boxes():
    (box,) = object_solid(furniture("Box_1")).boxes
    assert box.half == pytest.approx([extent / 2 for extent in facts.asset("Box_1").size])


@pytest.mark.parametrize(
    ("loads", "usual", "levels"),
    [
        ([], (0.1, 0.5), [0.1, 0.5]),
        ([Load(0.3, 0.4), Load(0.35, 0.5)], (), [0.299]),
        ([Load(0.3, 0.6)], (0.1, 0.5, 0.8), [0.1, 0.299, 0.8]),
        ([Load(0.3, 0.4), Load(0.6, 0.7)], (0.35,), [0.299, 0.599]),
        ([Load(1.0, 1.2)], (0.5,), [0.5]),
        ([], (0.95,), []),
    ],
)
def test_shelves_are_where_things_lie_and_elsewhere_as_usual(loads, usual, levels):
    assert shelf_levels(loads, 1.0, usual) == pytest.approx(levels)


@pytest.mark.parametrize("asset", ["Sofa_221_1", "Armchair_201_4", "Chair_210_1", "Bed_9"])
def test_seats_and_mattresses_carry_what_lies_on_them(asset):
    thing = furniture(asset)
    bottom = 0.45 * thing.size[2]
    solid = object_solid(thing, [Load(bottom, bottom + 0.1)])
    assert max(surface.center[2] for surface in solid.surfaces) == pytest.approx(bottom - 0.001)


def test_l_and_c_shaped_counters_leave_the_floor_between_their_arms_free():
    for asset, free in (("Countertop_L_8x6", (-0.5, 0.4)), ("Countertop_C_8x6", (0.0, 0.4))):
        solid = object_solid(furniture(asset))
        assert not any(holds(box, [(*free, 0.5)]).any() for box in solid.boxes)
        assert any(holds(box, [(1.1, 0.4, 0.5)]).any() for box in solid.boxes)


def furniture(asset, yaw=0.0):
    known = facts.asset(asset)
    return HouseObject(
        "x",
        asset,
        known.category,
        (0.0, 0.0, known.size[2] / 2),
        yaw,
        known.size,
        "room|2",
        None,
        known.pickupable,
        known.mass,
        facts.category_facts(known.category).is_receptacle,
    )


def interval(box, axis):
    return box.center[axis] - box.half[axis], box.center[axis] + box.half[axis]
