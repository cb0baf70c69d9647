"""`task/common_sense=llm`: who is asked, what belongs to the configuration, and what the report shows."""

from __future__ import annotations

import json
from pathlib import Path

from hydra import compose, initialize_config_dir

from adhoc.cli.contestants import Components
from adhoc.cli.main import main
from adhoc.cli.schema import register_schema
from adhoc.core.resources import data_dir
from adhoc.evaluation.episode_key import EpisodeKind
from adhoc.tasks.llm_common_sense import LLMCommonSense
from adhoc.tasks.placement import PlacementCommonSense

SHORT = ["limit=1", "max_steps=25", "pictures=false", "transcript=false", "benchmark=demo"]


def components(*overrides: str) -> Components:
    register_schema()
    with initialize_config_dir(str(data_dir("configs")), version_base="1.3"):
        return Components(compose("run", list(overrides)))


def records(folder: Path) -> list[dict]:
    return [json.loads(line) for line in (folder / "episodes.jsonl").read_text().splitlines()]


def test_the_table_is_the_default_and_asks_nobody():
    conditions = components("policy=none").conditions
    assert isinstance(conditions.task.common_sense, PlacementCommonSense)
    assert conditions.model is None
    assert "llm" not in conditions.settings["task"]


def test_files_that_a_judge_goes_by_are_part_of_the_configuration(monkeypatch):
    plain = components("policy=none")
    assert "fingerprint of task" not in plain.fingerprints(None)
    monkeypatch.setattr(PlacementCommonSense, "fingerprint", "weights")
    judged = components("policy=none")
    assert judged.fingerprints(None)["fingerprint of task"] == "weights"
    assert EpisodeKind(judged.conditions).config_hash != EpisodeKind(plain.conditions).config_hash


def test_the_model_of_the_run_is_asked_also_if_no_robot_uses_it():
    conditions = components("policy=heuristic", "task/common_sense=llm", "llm=gpt4_paper").conditions
    assert isinstance(conditions.task.common_sense, LLMCommonSense)
    assert conditions.task.common_sense.judge == conditions.model.name == "gpt-4-1106-preview"
    assert conditions.settings["task"]["llm"]["temperature"] == 0.3
    assert conditions.team.model is None


def test_robots_and_judge_share_one_model():
    made = components("policy=irot", "task/common_sense=llm")
    assert made.newcomer is not None
    assert made.newcomer.model is made.conditions.model
    assert components("policy=irot").conditions.team.model is None


def test_a_run_counts_its_judge_and_the_report_shows_it(tmp_path, capsys):
    out = tmp_path / "judged"
    assert main(["run", "policy=heuristic", "task/common_sense=llm", *SHORT, f"out={out}"]) == 0
    for record in records(out):
        counts, stage = record["common_sense"], record["llm"]["stages"]["common_sense"]
        assert counts["asked"] == counts["agreed"] > 0
        assert record["llm"]["calls"] == stage["calls"] == stage["valid"] > 0
        assert record["model"] == counts["judge"] == "offline (not a language model)"
    assert main(["report", str(out), "--markdown", str(tmp_path / "table.md")]) == 0
    assert "against the placement table" in capsys.readouterr().out
    assert "against the placement table" in (tmp_path / "table.md").read_text()


def test_judges_do_not_mix_in_one_folder(tmp_path, capsys):
    out = tmp_path / "table"
    assert main(["run", "policy=none", *SHORT, f"out={out}"]) == 0
    assert records(out)[0]["common_sense"] is None
    assert main(["report", str(out)]) == 0
    assert "against the placement table" not in capsys.readouterr().out
    assert main(["run", "policy=none", "task/common_sense=llm", *SHORT, f"out={out}"]) == 2
    assert "was made with another configuration" in capsys.readouterr().err


def test_unknown_judges_are_told_the_known(capsys):
    assert main(["run", "task/common_sense=oracle"]) == 2
    assert "task/common_sense=oracle: no such choice; there are: llm, table" in capsys.readouterr().err
