"""Mixed teams and imperfections from the configuration of a run."""

from __future__ import annotations

import json

import pytest
from hydra import compose, initialize_config_dir

from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.llm_agent import LLMAgent
from adhoc.agents.random_policy import RandomPolicy
from adhoc.cli.config_errors import one_line
from adhoc.cli.contestants import Components
from adhoc.cli.main import main
from adhoc.cli.schema import register_schema
from adhoc.cli.seats import at_seat, numbered_seats
from adhoc.core.errors import ConfigurationError
from adhoc.core.resources import data_dir

RANDOM = "adhoc.agents.random_policy.RandomPolicy"


def components(*overrides: str) -> Components:
    register_schema()
    with initialize_config_dir(str(data_dir("configs")), version_base="1.3"):
        return Components(compose("run", list(overrides)))


def policies(made: Components, seats: int = 3) -> list[type]:
    return [type(made.conditions.team.make(seat)) for seat in range(seats)]


def test_one_teammate_may_be_of_another_kind():
    made = components(f"+team.seats.1.agent._target_={RANDOM}")
    assert policies(made) == [HeuristicPolicy, RandomPolicy, HeuristicPolicy]
    assert made.conditions.team.settings["seats"]["1"]["agent"] == {"_target_": RANDOM}


def test_a_seat_may_be_a_choice_of_its_group():
    made = components("+team@team.seats.2=explore_only")
    assert [it.__name__ for it in policies(made)] == [
        "HeuristicPolicy",
        "HeuristicPolicy",
        "ExploreOnlyPolicy",
    ]


def test_a_seat_has_stages_of_its_own_and_the_model_is_known():
    made = components("+policy@team.seats.0=irot", "llm=gpt4_paper")
    assert policies(made) == [LLMAgent, HeuristicPolicy, HeuristicPolicy]
    assert made.conditions.team.model_name == "gpt-4-1106-preview"


def test_without_seats_nothing_is_said_of_them():
    plain, empty = components().conditions.team, components("+team.seats={}").conditions.team
    assert empty.settings == plain.settings
    assert "seats" not in plain.settings


@pytest.mark.parametrize("key", [1, "1", "01"])
def test_seats_are_written_as_json_has_them(key):
    config = numbered_seats({"name": "x", "seats": {key: {"agent": 5}}}, "team")
    assert config == {"name": "x", "seats": {"1": {"agent": 5}}}
    assert json.loads(json.dumps(config)) == config
    assert at_seat(config, "team", 1) == ("team.seats.1", {"agent": 5})
    assert at_seat(config, "team", 0) == ("team", config)


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (["+team.seats.first.agent._target_=x.Y"], "team.seats.first: seats are numbers"),
        (["+team.seats={-1:{agent:{_target_:x.Y}}}"], "team.seats.-1: seats are numbers"),
        (["+team.seats=[1]"], "must give a policy for each seat"),
        (["+team.seats.1=heuristic"], "must give a policy for each seat"),
        (["+team.seats.1.name=x"], "team.seats.1: field 'agent' is missing"),
        (["+team.seats.1.agent._target_=adhoc.nothing.X"], "team.seats.1.agent._target_=adhoc.nothing.X"),
        ([f"+team.seats.1.agent._target_={RANDOM}", "+team.seats.1.agent.x=1"], "team.seats.1.agent: "),
        (
            [f"+team.seats.1.agent._target_={RANDOM}", "+team.seats.1.agent.part._target_=adhoc.nothing.X"],
            "team.seats.1.agent.part._target_=adhoc.nothing.X",
        ),
    ],
)
def test_wrong_seats_are_named(overrides, told):
    with pytest.raises(ConfigurationError) as error:
        assert components(*overrides).conditions
    assert told in str(error.value)


def test_seats_that_are_one_are_refused():
    with pytest.raises(ConfigurationError, match="twice"):
        numbered_seats({"seats": {"1": {}, 1: {}}}, "team")


@pytest.mark.parametrize(
    ("overrides", "settings"),
    [
        ([], {}),
        (["imperfections=none", "imperfections.loss=0.5"], {"loss": 0.5}),
        (["imperfections=lossy"], {"loss": 0.2}),
        (["imperfections=lossy", "imperfections.silent=[1]"], {"loss": 0.2, "silent": [1]}),
        (["imperfections.leaves={2:70}"], {"leaves": {"2": 70}}),
        (
            ["imperfections=breakdown", "+imperfections.breaks_down.1=9"],
            {"breaks_down": {"0": 50, "1": 9}},
        ),
    ],
)
def test_imperfections_are_chosen_and_combined(overrides, settings):
    assert components(*overrides).conditions.imperfections.settings == settings


@pytest.mark.parametrize(
    ("override", "told"),
    [
        ("imperfections.loss=often", "imperfections.loss='often': must be float"),
        ("imperfections.loss=-0.2", "imperfections.loss=-0.2: must be a probability"),
        ("imperfections.wrong={0:5}", "imperfections.wrong={0:5}: seat 0: 5 must be a probability"),
        ("imperfections.leaves={1:500}", "imperfections.leaves={1:500}: seat 1: with max_steps=500 no"),
    ],
)
def test_wrong_imperfections_are_named(override, told):
    with pytest.raises(ConfigurationError) as error:
        assert components(override).conditions
    assert told in str(error.value)


def test_an_unknown_choice_is_named():
    with pytest.raises(Exception, match="imperfections/perfect") as error:
        components("imperfections=perfect")
    assert one_line(error.value).startswith("imperfections=perfect: no such choice; there are: breakdown")


NEAREST = "+team@team.seats.1=nearest_first"


@pytest.mark.parametrize(
    ("overrides", "name", "label"),
    [
        ([], "heuristic", "Heuristic based"),
        (["team.dialect=structured"], "heuristic", "Heuristic based"),
        (["team=learned"], "learned", "Learning based"),
        (["team=with_human"], "with_human", "Heuristic and a person"),
        (["team=with_human", "+team.seats.0.agent.script=s"], "with_human", "Heuristic and a person"),
        ([NEAREST], "heuristic (seat 1 nearest_first)", "Heuristic based (seat 1 Nearest first)"),
        (
            [NEAREST, "team.seats.1.dialect=codes"],
            "heuristic (seat 1 nearest_first in codes)",
            "Heuristic based (seat 1 Nearest first in codes)",
        ),
        (
            ["+team@team.seats.0=learned"],
            "heuristic (seat 0 learned)",
            "Heuristic based (seat 0 Learning based)",
        ),
        (
            [f"+team.seats.2.agent._target_={RANDOM}", "team.dialect=silent"],
            "heuristic (seat 2 RandomPolicy, dialect silent)",
            "Heuristic based (seat 2 RandomPolicy, dialect silent)",
        ),
        (
            ["team.dialect={_target_: test_speech.LowCodes}"],
            "heuristic (dialect LowCodes)",
            "Heuristic based (dialect LowCodes)",
        ),
        (
            ["team=learned", "team.dialect=structured"],
            "learned (dialect structured)",
            "Learning based (dialect structured)",
        ),
        (
            ["team=with_human", "+team.seats.0.agent.script=s", NEAREST],
            "with_human (seat 1 nearest_first)",
            "Heuristic and a person (seat 1 Nearest first)",
        ),
        ([NEAREST, "team.name=mine", "team.label=Mine"], "mine", "Mine"),
    ],
)
def test_a_team_that_was_changed_has_a_name_of_its_own(tmp_path, monkeypatch, overrides, name, label):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s").write_text("w")
    team = components(*overrides).conditions.team
    assert (team.name, team.label) == (name, label)
    assert team.settings["label"] in label, "the configuration, and so its hash, is as it was given"


def test_a_newcomer_with_another_dialect_too():
    newcomer = components("policy=heuristic", "+policy.dialect=codes").newcomer
    assert newcomer is not None
    assert newcomer.name == "heuristic (dialect codes)"


def test_many_changes_are_told_by_a_hash():
    seats = [f"+team@team.seats.{seat}={{}}" for seat in range(3)]
    one, other = (
        components(*(it.format(kind) for it in seats), f"team.dialect={dialect}").conditions.team
        for kind, dialect in (("nearest_first", "codes"), ("nearest_first", "silent"))
    )
    assert one.name.startswith("heuristic (changed ")
    assert one.name != other.name


def test_a_mixed_team_shares_a_folder_and_a_plain_one_is_known_as_before(tmp_path):
    short = ["policy=none", "limit=1", "max_steps=3", "pictures=false", "transcript=false", f"out={tmp_path}"]
    for overrides in ([], [NEAREST], ["team.dialect=silent", "imperfections=lossy"]):
        assert main(["run", *short, *overrides]) == 0
    records = [json.loads(line) for line in (tmp_path / "episodes.jsonl").read_text().splitlines()]
    assert [(it["episode_id"], it["team"], it["team_label"]) for it in records] == [
        ("corridor-s0--heuristic--alone", "heuristic", "Heuristic based"),
        (
            "corridor-s0--heuristic-seat-1-nearest_first--alone",
            "heuristic (seat 1 nearest_first)",
            "Heuristic based (seat 1 Nearest first)",
        ),
        (
            "corridor-s0--heuristic-dialect-silent-loss-0.2--alone",
            "heuristic (dialect silent) (loss 0.2)",
            "Heuristic based (dialect silent) (loss 0.2)",
        ),
    ]


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (
            ["+team@team.seats.9=nearest_first"],
            "team.seats.9=nearest_first: no scenario of the run has a seat 9",
        ),
        ([f"+team.seats.4.agent._target_={RANDOM}"], f"team.seats.4={RANDOM}: no scenario"),
        (["imperfections.silent=[0,9]"], "imperfections.silent=[0,9]: no scenario of the run has a seat 9"),
        (["imperfections.wrong={4:0.5}"], "the largest team has 4 robots, seats 0 to 3"),
        (["limit=2", "imperfections.wrong={3:0.5}"], "the largest team has 3 robots, seats 0 to 2"),
        (["benchmark=sample", "imperfections.leaves={5:9}"], "the largest team has 5 robots, seats 0 to 4"),
        (["benchmark=procthor10k", "imperfections.leaves={5:9}"], "the largest team has 5 robots"),
        (
            ["benchmark=house", "benchmark.path=x", "imperfections.silent=[5]"],
            "the largest team has 5 robots",
        ),
        (
            ["max_steps=50", "imperfections=breakdown"],
            "imperfections.breaks_down={0:50}: seat 0: with max_steps=50",
        ),
        (["imperfections.battery={0:501}"], "imperfections.battery={0:501}: seat 0: with max_steps=500"),
    ],
)
def test_what_no_episode_of_the_run_comes_to_is_refused(overrides, told):
    with pytest.raises(ConfigurationError) as error:
        assert components(*overrides).conditions
    assert told in str(error.value)


@pytest.mark.parametrize(
    "overrides",
    [
        ["+team@team.seats.3=nearest_first", "imperfections.silent=[3]"],
        ["benchmark=sample", "imperfections.silent=[4]", "imperfections.leaves={0:499}"],
        ["benchmark=house", "benchmark.path=x", "benchmark.teammates=8", "imperfections.silent=[7]"],
        ["benchmark.draws=[{house: one_room}]", "imperfections.battery={4:500}"],
        ["benchmark=paper", "benchmark.folder=mine", "imperfections.silent=[7]"],
    ],
)
def test_a_seat_that_some_teams_have_or_may_have_is_none_too_many(overrides):
    assert components(*overrides).conditions
