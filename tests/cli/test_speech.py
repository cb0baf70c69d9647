"""Teams and newcomers are given dialects, and formats to understand, in the configuration."""

from __future__ import annotations

import json

import pytest
from hydra import compose, initialize_config_dir

from adhoc.agents.dialects.codes import Codes
from adhoc.agents.dialects.dialect import Adapter
from adhoc.agents.dialects.speaking import Speaking
from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.cli.contestants import Components
from adhoc.cli.main import main
from adhoc.cli.schema import register_schema
from adhoc.cli.speech import speaking, without_default_speech
from adhoc.core.errors import ConfigurationError
from adhoc.core.resources import data_dir

SHORT = ["policy=irot", "join_step=5", "limit=1", "max_steps=25", "pictures=false", "transcript=false"]
SHOUTING = {"_target_": "test_speech.Shouting"}


class Shouting(Adapter):
    name = "shouting"

    def read(self, message):
        return {"stopped": True} if message.text.isupper() else None


class LowCodes(Codes):
    name = "low codes"


def components(*overrides: str) -> Components:
    register_schema()
    with initialize_config_dir(str(data_dir("configs")), version_base="1.3"):
        return Components(compose("run", list(overrides)))


def test_the_default_is_the_librarys_format_and_leaves_no_trace() -> None:
    team = components().conditions.team
    assert isinstance(team.make(0), HeuristicPolicy)
    assert "dialect" not in team.settings
    assert without_default_speech({"name": "x", "dialect": None, "adapters": []}) == {"name": "x"}


@pytest.mark.parametrize("name", ["codes", "sentences", "silent"])
def test_a_team_speaks_what_is_configured(name: str) -> None:
    team = components(f"team.dialect={name}").conditions.team
    assert isinstance(team.make(0), Speaking)
    assert team.settings["dialect"] == name


def test_a_newcomer_may_have_a_dialect_and_adapters() -> None:
    adapters = "+policy.adapters=[{_target_: test_speech.Shouting}]"
    newcomer = components("policy=heuristic", "+policy.dialect=codes", adapters).newcomer
    assert newcomer is not None
    assert isinstance(newcomer.make(3), Speaking)
    assert newcomer.settings["adapters"] == [SHOUTING]


def test_a_dialect_of_ones_own_is_a_component() -> None:
    made = speaking(HeuristicPolicy(), {"dialect": {"_target_": "test_speech.LowCodes"}}, "team")
    assert isinstance(made, Speaking)
    team = components("team.dialect={_target_: test_speech.LowCodes}").conditions.team
    assert isinstance(team.make(0), Speaking)
    assert team.settings["dialect"] == {"_target_": "test_speech.LowCodes"}


@pytest.mark.parametrize(
    ("config", "error"),
    [
        ({"dialect": "esperanto"}, r"^team\.dialect=esperanto: must be one of structured, codes"),
        ({"dialect": 3}, r"^team\.dialect=3: must be one of"),
        ({"dialect": SHOUTING}, r"team\.dialect: Shouting is no Dialect"),
        ({"adapters": "codes"}, r"team\.adapters='codes': must be a list of components"),
        ({"adapters": ["codes"]}, r"team\.adapters=\['codes'\]: must be a list of components"),
        (
            {"adapters": [{"_target_": "no.Such"}]},
            r"team\.adapters\.0\._target_=no\.Such: cannot be imported",
        ),
    ],
)
def test_wrong_values_are_errors_that_name_the_place(config, error: str) -> None:
    with pytest.raises(ConfigurationError, match=error):
        speaking(HeuristicPolicy(), config, "team")


def test_records_count_what_was_understood(tmp_path) -> None:
    assert main(["run", *SHORT, "team.dialect=codes", f"out={tmp_path}"]) == 0
    alone, joined = map(json.loads, (tmp_path / "episodes.jsonl").read_text(encoding="utf-8").splitlines())
    assert set(alone["messages_understood"]) == {"codes"}
    assert set(joined["messages_understood"]) == {"codes", "structured"}
    assert joined["messages_not_understood"] == 0
