"""PLASTIC's training from nothing, in small; and its shipped library on houses that were not trained on."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from adhoc import HeuristicPolicy
from adhoc.agents.learned.decision import SubSkillKind
from adhoc.agents.learned.features import FEATURE_SIZE
from adhoc.agents.learned.situation import Detection, Other, OwnState, Situation
from adhoc.agents.plastic.deeds import Heard, Seen
from adhoc.agents.plastic.library import types_in
from adhoc.agents.plastic.situation import FEATURES
from adhoc.cli import train_plastic as train_plastic_command
from adhoc.cli.main import main
from adhoc.core.errors import ConfigurationError
from adhoc.core.values import Capability, Pose
from adhoc.training.demonstrations import DemonstrationSettings, demonstrate_in_house
from adhoc.training.plastic_card import plastic_card
from adhoc.training.plastic_demonstrations import ROW_SIZE, examples_of, expert_beside
from adhoc.training.plastic_settings import PlasticTrainingSettings
from adhoc.training.plastic_teams import TYPE_NAMES, ExpertBeside, TeamType, team_types
from adhoc.training.plastic_training import train_plastic
from adhoc.training.plastic_trials import Trial, TrialSettings, report_of, run_trial
from adhoc.training.training_houses import VALIDATE, HouseDraw, house_draws
from adhoc.worlds.pybullet_world import PyBulletWorld

TINY = PlasticTrainingSettings(
    seed=2, houses=1, behaviour_epochs=2, decision_epochs=2, max_steps=15, join_steps=(0,)
)


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld(image_size=64)
    yield world
    world.close()


def situation(mine: float, other: float) -> Situation:
    """A robot and a free able teammate, each so many metres from a misplaced object at the origin."""
    own = OwnState("newcomer", Capability(), Pose(mine, 0.0), 10, 400, False, False, False, 3, 2, 1)
    detection = Detection("Mug_1", (0.0, 0.0), 0.3, 9, False, False, 1.0)
    return Situation(own, (detection,), (Other("a", (other, 0.0), Capability(), False, False, False),))


class AlwaysMisplaced:
    """Stands in for the expert's knowledge: takes an object if nobody able is closer."""

    def __call__(self, given: Situation) -> SubSkillKind:
        closer = any(
            it.capability.can_manipulate and abs(it.position[0]) < abs(given.own.pose.x)
            for it in given.others
        )
        return SubSkillKind.EXPLORE if closer else SubSkillKind.PICKUP_OBJECT


def test_beside_explorers_the_expert_waits_for_nobody():
    expert = AlwaysMisplaced()
    helpers = TeamType(HeuristicPolicy, replaces=True)
    explorers = TeamType(HeuristicPolicy, replaces=False)
    assert ExpertBeside(expert, helpers)(situation(3.0, 1.0)) is SubSkillKind.EXPLORE
    assert ExpertBeside(expert, explorers)(situation(3.0, 1.0)) is SubSkillKind.PICKUP_OBJECT
    assert [name for name, team in team_types().items() if not team.replaces] == ["explore_only"]


def test_one_episode_records_decisions_and_behaviour(world):
    def cast(*where):
        return expert_beside("heuristic", TeamType(HeuristicPolicy), None, 0.0, (0,), *where)

    settings = DemonstrationSettings("tiny", cast, ROW_SIZE, 1, 60)
    shown = demonstrate_in_house(world, HouseDraw(VALIDATE, 3, 5), settings)
    decisions, heard, seen = (examples_of(shown, part) for part in ("decision", "heard", "seen"))
    assert len(decisions) + len(heard) + len(seen) == len(shown.labels)
    assert decisions.inputs.shape[1] == FEATURE_SIZE
    assert heard.inputs.shape[1] == seen.inputs.shape[1] == len(FEATURES)
    assert len(decisions) > 0
    assert set(heard.labels.tolist()) <= set(map(int, Heard))
    assert set(seen.labels.tolist()) <= set(map(int, Seen))
    assert np.isfinite(shown.inputs).all()


def test_training_from_nothing_makes_a_library_and_its_card_and_goes_on_where_it_stopped(tmp_path):
    pytest.importorskip("torch")
    told: list[str] = []

    def begin(title: str):
        told.append(title)
        return lambda done, total, latest: None

    report = train_plastic(TINY, tmp_path, 1, begin, team_types(("explore_only", "heuristic")))
    library = types_in(tmp_path)
    assert list(library) == ["explore_only", "heuristic"]
    card = library["heuristic"].card
    assert card["type"] == "heuristic"
    assert card["parts"]["decision"]["examples"]["fit"] > 0
    assert report["episodes"] == sum(map(sum, (it.values() for it in report["confusion"].values())))
    assert "| heuristic |" in (tmp_path / "MODEL_CARD.md").read_text()
    kept = sorted(tmp_path.glob("demonstrations/*.npz"))
    assert len(kept) == 6
    before = [file.stat().st_mtime_ns for file in kept]
    tensors = (tmp_path / "heuristic.safetensors").read_bytes()
    train_plastic(TINY, tmp_path, 1, begin, team_types(("explore_only", "heuristic")))
    assert [file.stat().st_mtime_ns for file in kept] == before
    assert (tmp_path / "heuristic.safetensors").read_bytes() == tensors
    assert any("explore_only" in title for title in told)


def test_the_report_counts_what_each_team_was_taken_for():
    trials = [
        Trial("a", {"a": 0.8, "b": 0.2}, 30, True),
        Trial("a", {"a": 0.4, "b": 0.6}, 300, False),
        Trial("b", {"a": 0.1, "b": 0.9}, 300, False),
    ]
    trials.append(Trial("learned", {"heuristic": 0.7, "learned": 0.3}, 20, True))
    report = report_of(trials[:3], ("a", "b"), long=100)
    assert report["confusion"] == {"a": {"a": 1, "b": 1}, "b": {"a": 0, "b": 1}}
    assert report["found"] == pytest.approx(2 / 3, abs=1e-3)
    assert report["belief_in_true_type"] == pytest.approx((0.8 + 0.4 + 0.9) / 3, abs=1e-3)
    assert (report["long_episodes"], report["found_in_long"]) == (2, 0.5)
    assert report["nearly_found"] == report["found"]
    alike = report_of(trials[3:], ("heuristic", "learned"))
    assert (alike["found"], alike["nearly_found"]) == (0.0, 1.0)


def test_beliefs_concentrate_on_the_true_type_in_houses_of_no_training(world):
    """A handful of short episodes; the model card beside the checkpoints tells of many more."""
    draws = [draw for draw in house_draws(VALIDATE, 18, seed=1) if draw.rooms in (4, 5)][:2]
    settings = TrialSettings(max_steps=75)
    asked = [(draw, name, team) for name, team in team_types().items() for draw in draws]
    trials = [trial for one in asked for trial in run_trial(world, *one, settings)]
    found = Counter(trial.true_type for trial in trials if trial.taken_for == trial.true_type)
    assert len(trials) == 10
    assert found.total() >= 6, found
    assert sum(trial.beliefs[trial.true_type] for trial in trials) / 10 > 1.5 / len(TYPE_NAMES)


@pytest.mark.parametrize("wrong", [{"houses": 0}, {"stray": 1.0}, {"join_steps": ()}, {"join_steps": (700,)}])
def test_impossible_settings_are_refused(wrong):
    with pytest.raises(ConfigurationError, match=next(iter(wrong))):
        PlasticTrainingSettings(**wrong)


def test_an_unknown_type_is_refused(capsys):
    with pytest.raises(ConfigurationError, match="room_by_room"):
        team_types(["dancers"])
    with pytest.raises(SystemExit):
        main(["train", "plastic", "--type", "dancers", "--out", "nowhere"])
    assert "argument --type: invalid choice: 'dancers'" in capsys.readouterr().err


def test_the_command_trains_what_is_asked_for(monkeypatch, tmp_path):
    trained = []

    def train(settings, out, workers, begin, types):
        trained.append((settings, out, workers, list(types), types["learned"].make.keywords))
        return {"known": ["learned"]}

    monkeypatch.setattr(train_plastic_command, "train_plastic", train)
    asked = "--type learned --type heuristic --houses 3 --seed 5 --workers 1 --team-checkpoints mine"
    assert main(["train", "plastic", "--out", str(tmp_path), *asked.split()]) == 0
    settings = PlasticTrainingSettings(seed=5, houses=3, team_checkpoints="mine")
    assert trained == [(settings, tmp_path, 1, ["learned", "heuristic"], {"checkpoints": "mine"})]


def reported(trials, types, monkeypatch, capsys, tmp_path):
    """What the command says of these trials, and the lines of the card about them."""
    report = report_of(trials, types)
    monkeypatch.setattr(train_plastic_command, "train_plastic", lambda *arguments: report)
    asked = [word for name in types for word in ("--type", name)]
    assert main(["train", "plastic", "--out", str(tmp_path), *asked]) == 0
    return capsys.readouterr().out, plastic_card({"explore_only": CARD}, report)


PART = {"examples": {"fit": 0}, "fit": None, "validation": None}
CARD = {
    "library_version": "1",
    "training": {},
    "data": {"episodes": {"fit": 1}},
    "parts": dict.fromkeys(("decision", "heard", "seen"), PART),
}


def test_one_type_alone_is_not_said_to_be_found(monkeypatch, capsys, tmp_path):
    trials = [Trial("explore_only", {"explore_only": 1.0}, 30, True)]
    said, card = reported(trials, ["explore_only"], monkeypatch, capsys, tmp_path)
    for text in (said, card):
        assert "nothing to tell it apart from" in text
        assert "believed in most" not in text


def test_types_that_were_in_the_folder_already_are_told_apart(monkeypatch, capsys, tmp_path):
    trials = [Trial("explore_only", {"explore_only": 0.3, "heuristic": 0.7}, 30, True)]
    said, card = reported(trials, ["explore_only"], monkeypatch, capsys, tmp_path)
    assert "true type believed in most: 0.0% of 1 held-out" in said
    assert "(by chance 50.0%)" in card
    assert "| true type | explore_only | heuristic |" in card
    assert "| explore_only | 0 | 1 |" in card


@pytest.mark.parametrize("what", ["team", "plastic"])
def test_the_help_says_what_is_kept_and_what_is_made_anew(what, capsys):
    with pytest.raises(SystemExit):
        main(["train", what, "--help"])
    told = capsys.readouterr().out
    assert "kept in\nDIR/demonstrations and not run again" in told
    assert "anew" in told
