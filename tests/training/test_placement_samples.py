"""What a small house teaches of where things belong, counted by hand."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from adhoc.agents.learned import vocabulary
from adhoc.core.values import Place
from adhoc.houses.facts import is_reasonable, places_for
from adhoc.houses.house import House, HouseObject, Room
from adhoc.houses.samples import sample_house
from adhoc.tasks.placement import PlacementCommonSense
from adhoc.training.judges_report import detector_report, predictor_report
from adhoc.training.placement_samples import (
    HousePlacements,
    detector_examples,
    placements_in,
    predictor_examples,
)


def thing(name, category, parent, pickupable, receptacle=False, room="kitchen"):
    return HouseObject(
        name, name, category, (0, 0, 0), 0.0, (1, 1, 1), room, parent, pickupable, 1.0, receptacle
    )


@pytest.fixture(scope="module")
def house():
    shell = sample_house("one_room")
    kitchen = replace(shell.rooms[0], id="kitchen", room_type="Kitchen")
    hall = replace(shell.rooms[0], id="hall", room_type="Corridor")
    assert isinstance(kitchen, Room)
    return House(
        "tiny",
        (kitchen, hall),
        (),
        (),
        (
            thing("counter", "CounterTop", None, False, True),
            thing("shelf", "Shelf", None, False, True, room="hall"),
            thing("mug", "Mug", "counter", True),
            thing("spoon", "Spoon", "mug", True),
            thing("boots", "Boots", "Floor", True),
            thing("hat", "Cloth", "shelf", True, room="hall"),
        ),
    )


def test_a_tiny_house(house):
    found = placements_in(house)
    assert found.lying == {
        ("Mug", "CounterTop", "Kitchen"): 1,
        ("Spoon", "Mug", "Kitchen"): 1,
        ("Boots", "Floor", "Kitchen"): 1,
    }
    assert found.possible == {
        (name, holder, "Kitchen"): 1
        for name in ("Mug", "Spoon", "Boots")
        for holder in ("CounterTop", "Floor")
    }


def test_labels_are_those_of_the_constraints_and_each_answer_weighs_half():
    houses = [placements_in(sample_house("four_rooms"))]
    examples = detector_examples(houses)
    triples = sorted(houses[0].lying.keys() | houses[0].possible.keys())
    assert examples.labels[:, 0].tolist() == [float(not is_reasonable(*triple)) for triple in triples]
    misplaced = examples.labels[:, 0] == 1
    assert examples.weights[misplaced].sum() == pytest.approx(examples.weights[~misplaced].sum(), rel=1e-4)


def test_the_predictor_is_shown_every_reasonable_place():
    examples = predictor_examples([placements_in(sample_house("four_rooms"))])
    (position,) = np.flatnonzero(examples.inputs[:, vocabulary.objects().index("Mug")])
    shown = {place for place, yes in zip(vocabulary.candidate_places(), examples.labels[position]) if yes}
    assert shown == set(places_for("Mug"))


def test_the_table_itself_is_always_right():
    houses = [placements_in(sample_house("four_rooms"))]
    report = detector_report(PlacementCommonSense(), houses, ())
    assert report["accuracy"] == report["unseen"]["accuracy"] == 1.0
    by_table = predictor_report(PlacementCommonSense(), houses)
    assert (by_table["top_1_is_reasonable"], by_table["precision"], by_table["recall"]) == (1.0, 1.0, 1.0)


class Contrary(PlacementCommonSense):
    """Calls everything misplaced, and everything belong into a bath."""

    def is_misplaced(self, category, receptacle, room_type):
        return True

    def places_for(self, category):
        return (Place("Bathtub", "Kitchen"),)


def test_reports_by_hand():
    wrong, right = ("Mug", "Bed", "Bedroom"), ("Mug", "CounterTop", "Kitchen")
    house = HousePlacements(Counter({right: 3}), Counter({wrong: 2, right: 1}))
    report = detector_report(Contrary(), [house], {right})
    assert (report["in_place"], report["misplaced"], report["accuracy"]) == (0.0, 1.0, 0.5)
    assert (report["triples"], report["examples"]) == (2, 6)
    assert (report["unseen"]["triples"], report["unseen"]["in_place"]) == (1, None)
    by_predictor = predictor_report(Contrary(), [house])
    assert by_predictor["objects"] == 3
    assert (by_predictor["top_1_is_reasonable"], by_predictor["precision"], by_predictor["recall"]) == (
        0,
        0,
        0,
    )
