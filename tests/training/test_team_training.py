"""From nothing to checkpoints and a model card, at the smallest."""

from __future__ import annotations

import json

import pytest

from adhoc.agents.learned.checkpoint import load_checkpoint
from adhoc.agents.learned.decision import DecisionModule, DecisionNetwork
from adhoc.agents.learned.policy import LearnedPolicy
from adhoc.agents.learned.shipped import DECISION_FILE, DETECTOR_FILE, PREDICTOR_FILE, SHIPPED
from adhoc.cli.main import main
from adhoc.core.errors import ConfigurationError
from adhoc.training.model_card import CARD_FILE, model_card
from adhoc.training.team_training import train_team
from adhoc.training.training_settings import TeamTrainingSettings

pytest.importorskip("torch")

TINY = TeamTrainingSettings(
    placement_houses=4,
    demonstration_houses=2,
    scenarios=1,
    detector_epochs=2,
    predictor_epochs=2,
    decision_epochs=2,
)


def nothing(title):
    return lambda done, total, latest: None


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    folder = tmp_path_factory.mktemp("trained")
    return folder, train_team(TINY, folder, 1, nothing)


def test_the_team_runs_on_what_was_trained(trained):
    folder, _ = trained
    LearnedPolicy(checkpoints=str(folder))


def test_the_card_is_in_the_file(trained):
    folder, cards = trained
    loaded = load_checkpoint(folder / DECISION_FILE, DecisionModule.KIND, DecisionNetwork().shapes)
    assert loaded.card == json.loads(json.dumps(cards[DECISION_FILE]))
    assert loaded.card["training"]["demonstration_houses"] == 2
    assert loaded.card["validation"]["examples"] == loaded.card["data"]["decisions"]["validate"]


def test_training_again_gives_the_same_bytes(trained):
    folder, _ = trained
    before = {name: (folder / name).read_bytes() for name in (DETECTOR_FILE, PREDICTOR_FILE, DECISION_FILE)}
    train_team(TINY, folder, 1, nothing)
    assert {name: (folder / name).read_bytes() for name in before} == before


def test_the_page_says_what_the_cards_say(trained):
    folder, cards = trained
    page = (folder / CARD_FILE).read_text()
    assert page == model_card(cards)
    share = cards[DECISION_FILE]["validation"]["accuracy"]
    assert f"| accuracy | {100 * share:.1f}% |" in page
    assert "houses: 1 to choose, 4 to fit, 1 to validate" in page


def test_the_shipped_checkpoints_are_as_right_as_they_should_be():
    cards = {}
    for name, kind, shapes in shipped_files():
        cards[name] = load_checkpoint(SHIPPED / name, kind, shapes).card
    assert cards[DETECTOR_FILE]["validation"]["accuracy"] >= 0.97
    assert cards[PREDICTOR_FILE]["validation"]["top_1_is_reasonable"] >= 0.95
    assert cards[DECISION_FILE]["validation"]["accuracy"] >= 0.90
    assert (SHIPPED / CARD_FILE).read_text() == model_card(cards)


def shipped_files():
    from adhoc.agents.learned.placement_networks import (
        DETECTOR_KIND,
        PREDICTOR_KIND,
        detector_network,
        predictor_network,
    )

    yield DETECTOR_FILE, DETECTOR_KIND, detector_network().shapes
    yield PREDICTOR_FILE, PREDICTOR_KIND, predictor_network().shapes
    yield DECISION_FILE, DecisionModule.KIND, DecisionNetwork().shapes


@pytest.mark.parametrize("wrong", [{"placement_houses": 0}, {"scenarios": -1}, {"stray": 1.0}])
def test_impossible_settings_are_refused(wrong):
    with pytest.raises(ConfigurationError, match=next(iter(wrong))):
        TeamTrainingSettings(**wrong)


def test_a_folder_that_is_a_file_is_an_error_of_one_line(tmp_path, capsys):
    (tmp_path / "file").write_text("x")
    code = main(["train", "team", "--out", str(tmp_path / "file"), "--placement-houses", "1"])
    assert code == 2
    assert capsys.readouterr().err.startswith("adhoc train: error:")


def test_a_number_of_houses_must_be_a_number(capsys):
    with pytest.raises(SystemExit):
        main(["train", "team", "--demonstration-houses", "none"])
    assert "whole number" in capsys.readouterr().err
