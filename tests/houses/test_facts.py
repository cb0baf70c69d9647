import pytest

from adhoc.core.errors import AssetError
from adhoc.core.values import Place
from adhoc.houses import facts
from adhoc.houses.house import FLOOR


def test_an_asset_has_its_category_and_its_size_with_z_up():
    fridge = facts.asset("Fridge_5")
    assert (fridge.category, fridge.pickupable) == ("Fridge", False)
    assert fridge.size == pytest.approx((0.8535, 0.7064, 1.6926))


def test_masses_are_those_of_the_category_but_for_boxes_and_shakers():
    assert facts.asset("Apple_1").mass == facts.category_facts("Apple").mass == 0.2
    special = {
        category
        for category in facts.pickupable_categories()
        if len({facts.asset(name).mass for name in facts.assets_of(category)}) > 1
    }
    assert special <= {"Box", "PepperShaker", "SaltShaker"}
    assert special


def test_there_are_62_pickupable_types_with_709_assets_of_known_mass():
    categories = facts.pickupable_categories()
    assets = [facts.asset(name) for category in categories for name in facts.assets_of(category)]
    assert (len(categories), len(assets)) == (62, 709)
    assert all(asset.pickupable and 0.006 <= asset.mass <= 5.4 for asset in assets)


def test_every_asset_belongs_to_its_category_and_has_a_positive_size():
    for category in facts.categories():
        for name in facts.assets_of(category):
            assert facts.asset(name).category == category
            assert min(facts.asset(name).size) > 0


@pytest.mark.parametrize(
    ("category", "receptacle", "room_type", "reasonable"),
    [
        ("Apple", "Fridge", "Kitchen", True),
        ("Apple", "Fridge", "Bedroom", False),
        ("Apple", "Toilet", "Kitchen", False),
        ("Apple", FLOOR, "Kitchen", False),
        ("BasketBall", FLOOR, "Bedroom", True),
        ("Pen", "TVStand", "LivingRoom", True),
        ("CD", "TVStand", "Bedroom", True),
        ("Pillow", "Sofa", "LivingRoom", True),
        ("Apple", "Fridge", facts.CORRIDOR, False),
        ("BasketBall", FLOOR, facts.CORRIDOR, False),
    ],
)
def test_where_things_belong(category, receptacle, room_type, reasonable):
    assert facts.is_reasonable(category, receptacle, room_type) is reasonable


def test_only_five_types_may_lie_on_the_floor():
    on_floor = {
        category
        for category in facts.pickupable_categories()
        if any(facts.is_reasonable(category, FLOOR, room_type) for room_type in facts.ROOM_TYPES)
    }
    assert on_floor == {"BaseballBat", "BasketBall", "Boots", "Box", "Plunger"}


def test_four_types_belong_nowhere():
    nowhere = {category for category in facts.pickupable_categories() if not facts.places_for(category)}
    assert nowhere == {"AluminumFoil", "Footstool", "ScrubBrush", "WateringCan"}


def test_places_are_reasonable_complete_and_ranked():
    places = facts.places_for("Apple")
    assert places[0] == Place("DiningTable", "Kitchen")
    assert all(facts.is_reasonable("Apple", place.receptacle, place.room_type) for place in places)
    usual = [facts.room_weight(place.receptacle, place.room_type) > 0 for place in places]
    assert usual == sorted(usual, reverse=True)
    assert Place(FLOOR, "Bedroom") in facts.places_for("BasketBall")


def test_nothing_is_put_on_what_can_be_carried():
    assert facts.receptacle_probability("Box", "Pencil") > 0
    assert not facts.category_facts("Box").is_receptacle
    places = {place.receptacle for name in facts.pickupable_categories() for place in facts.places_for(name)}
    assert not places & set(facts.pickupable_categories())


def test_probabilities_are_probabilities():
    values = {
        (receptacle, category): facts.receptacle_probability(receptacle, category)
        for receptacle in facts.categories()
        for category in facts.pickupable_categories()
    }
    assert all(0 <= value <= 1 for value in values.values())
    known = {pair for pair, value in values.items() if value > 0}
    assert len(known) == 342


@pytest.mark.parametrize(
    "ask",
    [
        lambda: facts.asset("Nonsense_1"),
        lambda: facts.category_facts("Nonsense_1"),
        lambda: facts.assets_of("Nonsense_1"),
        lambda: facts.is_reasonable("Nonsense_1", "Fridge", "Kitchen"),
        lambda: facts.is_reasonable("Apple", "Nonsense_1", "Kitchen"),
        lambda: facts.is_reasonable("Apple", "Fridge", "Nonsense_1"),
        lambda: facts.room_weight("Apple", "Nonsense_1"),
        lambda: facts.receptacle_probability("Nonsense_1", "Apple"),
        lambda: facts.places_for("Nonsense_1"),
        lambda: facts.wall_hole("Nonsense_1"),
    ],
)
def test_what_is_unknown_is_named(ask):
    with pytest.raises(AssetError, match="'Nonsense_1'"):
        ask()
