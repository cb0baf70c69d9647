"""Renamed houses: the same house, and names that give nothing away."""

from __future__ import annotations

from dataclasses import replace

import pytest

from adhoc.houses.anonymous import anonymous
from adhoc.houses.build import build_solids
from adhoc.houses.house import FLOOR
from adhoc.houses.samples import sample_house, sample_names


@pytest.mark.parametrize("name", sample_names())
def test_only_the_names_change(name):
    house = sample_house(name)
    renamed = anonymous(house, 3)
    assert len(renamed.objects) == len(house.objects)
    names = {old.id: new.id for old, new in zip(house.objects, renamed.objects, strict=True)}
    for old, new in zip(house.objects, renamed.objects, strict=True):
        parent = old.parent if old.parent in (None, FLOOR) else names[old.parent]
        assert new == replace(old, id=names[old.id], parent=parent)
    old_boxes = [(solid.category, solid.boxes) for solid in build_solids(house)]
    assert [(solid.category, solid.boxes) for solid in build_solids(renamed)] == old_boxes


def test_names_carry_a_category_and_a_number_and_nothing_else():
    house = sample_house("eight_rooms")
    for thing in anonymous(house, 0).objects:
        category, number = thing.id.rsplit("_", 1)
        same = [it for it in house.objects if it.category == thing.category]
        assert category == thing.category
        assert 0 <= int(number) < len(same)
    ids = {solid.id for solid in build_solids(anonymous(house, 0))}
    assert not [name for name in ids if "." in name or ("|" in name and not name.startswith("room|"))]


def test_the_order_is_drawn_from_the_seed():
    house = sample_house("eight_rooms")
    orders = {tuple(it.id for it in anonymous(house, seed).objects) for seed in (0, 0, 1, 2)}
    assert len(orders) == 3
