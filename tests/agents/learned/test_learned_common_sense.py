"""What was learned of where things belong, against the placement table."""

from __future__ import annotations

import numpy as np
import pytest

from adhoc.agents.learned import vocabulary
from adhoc.agents.learned.common_sense import LearnedCommonSense
from adhoc.agents.learned.placement_networks import detector_network, predictor_network
from adhoc.agents.learned.shipped import common_sense_in, decision_in
from adhoc.core.errors import CheckpointError
from adhoc.core.values import ObjectRecord, Place
from adhoc.houses import facts
from adhoc.houses.samples import sample_house, sample_names
from adhoc.tasks.placement import PlacementCommonSense
from adhoc.tasks.tidying_up import TidyingUp


def blank(network):
    return {name: np.zeros(shape, np.float32) for name, shape in network.shapes.items()}


def constant(detector_logit=0.0, predictor_logits=None):
    """Networks that give these logits whatever they are asked."""
    detector, predictor = blank(detector_network()), blank(predictor_network())
    detector["logits.bias"] = np.array([detector_logit], np.float32)
    if predictor_logits is not None:
        predictor["logits.bias"] = predictor_logits.astype(np.float32)
    return LearnedCommonSense(detector, predictor)


def test_the_sign_of_the_logit_decides():
    assert constant(0.1).is_misplaced("Mug", "Sofa", "Bedroom")
    assert not constant(-0.1).is_misplaced("Mug", "Sofa", "Bedroom")


def test_places_are_those_above_the_threshold_likeliest_first():
    logits = np.full(len(vocabulary.candidate_places()), -1.0)
    logits[[3, 8]] = 1.0, 2.0
    candidates = vocabulary.candidate_places()
    assert constant(predictor_logits=logits).places_for("Mug") == (candidates[8], candidates[3])


def test_what_there_is_no_word_for_belongs_nowhere():
    judge = common_sense_in()
    assert judge.places_for("Unicorn") == ()
    assert judge.is_misplaced("Unicorn", "Bed", "Bedroom")
    assert judge.is_misplaced("Mug", "Cloud", "Kitchen")
    assert judge.is_misplaced("Mug", "CounterTop", "Dungeon")


def test_rows_have_a_one_for_each_word():
    row = vocabulary.situated_row("Mug", "Floor", "Bathroom")
    assert row.sum() == 3
    assert row[vocabulary.objects().index("Mug")] == 1
    assert row[len(vocabulary.objects()) + len(vocabulary.holders()) - 1] == 1
    assert row[-1] == 1
    assert vocabulary.object_row("Mug").sum() == 1


def test_the_candidates_are_every_place_that_the_table_knows():
    known = {place for name in facts.pickupable_categories() for place in facts.places_for(name)}
    assert known <= set(vocabulary.candidate_places())


def test_the_shipped_judges_agree_with_the_table_on_shipped_houses():
    judge, table = common_sense_in(), PlacementCommonSense()
    agreed = total = likeliest = belonging = 0
    for name in sample_names():
        house = sample_house(name)
        types = {room.id: room.room_type for room in house.rooms if room.room_type in facts.ROOM_TYPES}
        spots = {
            (it.category, types[it.room]) for it in house.objects if it.is_receptacle and it.room in types
        }
        for category in {it.category for it in house.objects if it.pickupable}:
            for holder, room_type in spots:
                total += 1
                asked = (category, holder, room_type)
                agreed += judge.is_misplaced(*asked) == table.is_misplaced(*asked)
            if table.places_for(category):
                belonging += 1
                likeliest += judge.places_for(category)[0] in table.places_for(category)
    assert total > 500
    assert agreed / total >= 0.97
    assert likeliest / belonging >= 0.95


def test_a_task_is_judged_by_it_instead_of_the_table():
    record = ObjectRecord("mug", "Mug", (0, 0, 0), receptacle_category="CounterTop", is_pickupable=True)
    task = TidyingUp(misplaced_below=0.2)
    assert task.judge(record, {"Kitchen": 1.0}) is False
    logits = np.full(len(vocabulary.candidate_places()), 1.0)
    wrong = task.with_common_sense(constant(5.0, logits))
    assert wrong.judge(record, {"Kitchen": 1.0}) is True
    assert wrong.judge(record, {"Kitchen": 0.3, "Bedroom": 0.7}) is True
    assert task.judge(record, {"Kitchen": 1.0}) is False


def test_the_floor_is_a_place():
    assert Place("Floor", "Bedroom") in vocabulary.candidate_places()


@pytest.mark.parametrize(
    ("load", "file"),
    [(common_sense_in, "misplaced_detector.safetensors"), (decision_in, "sub_skill_decision.safetensors")],
)
def test_a_folder_without_checkpoints_is_an_error_that_names_file_and_command(tmp_path, load, file):
    with pytest.raises(CheckpointError) as caught:
        load(tmp_path)
    assert str(tmp_path / file) in str(caught.value)
    assert f"`adhoc train team --out {tmp_path}` makes it" in str(caught.value)
    (tmp_path / file).write_bytes(b"broken")
    with pytest.raises(CheckpointError) as caught:
        load(tmp_path)
    assert "adhoc train" not in str(caught.value)


def test_the_fingerprint_is_of_everything_that_decides_an_answer():
    detector, predictor = blank(detector_network()), blank(predictor_network())
    assert PlacementCommonSense().fingerprint == ""
    prints = {
        constant(0.1).fingerprint,
        constant(0.2).fingerprint,
        constant(0.1, np.full(len(vocabulary.candidate_places()), 1.0)).fingerprint,
        LearnedCommonSense(detector, predictor).fingerprint,
        LearnedCommonSense(detector, predictor, reasonable_above=0.6).fingerprint,
    }
    assert len(prints) == 5
    assert constant(0.1).fingerprint in prints
