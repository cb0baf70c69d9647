import pytest

from adhoc.core.errors import AssetError
from adhoc.houses.facts import asset
from adhoc.houses.facts_furniture import CORNER, EDGE, MIDDLE, furniture_groups, standing


def test_a_fridge_stands_in_corners_and_at_edges_and_one_is_enough():
    fridge = standing("Fridge")
    assert fridge.anchors == {CORNER, EDGE}
    assert fridge.on_floor
    assert fridge.fixed
    assert not fridge.multiple


def test_mugs_do_not_stand_on_floors():
    assert not standing("Mug").on_floor
    assert not standing("Mug").fixed


def test_an_unknown_type_is_named():
    with pytest.raises(AssetError, match="unknown object type 'Gadget'"):
        standing("Gadget")


def test_groups_are_complete_and_their_assets_known():
    groups = {group.name: group for group in furniture_groups()}
    assert len(groups) == 18
    assert groups["television-sofa"].room_types == {"LivingRoom", "Bedroom"}
    assert groups["chair-diningtable"].anchors == {CORNER, EDGE, MIDDLE}
    for group in groups.values():
        assert group.members[0].parent is None
        for number, member in enumerate(group.members):
            assert member.parent is None or member.parent < number
            assert {asset(name).category for name in member.assets} <= group.categories


def test_the_chair_of_a_table_stands_behind_it_and_faces_forward():
    group = next(group for group in furniture_groups() if group.name == "chair-diningtable")
    chair = group.members[1]
    # Its middle is 0.1 m behind the table's rear edge.
    assert (chair.side, chair.offset, chair.align, chair.turn) == ((0, -1), (0.0, -0.1), (0, 0), 0)
