"""Experiments are configurations that sweep; every one composes, and what it compares can be built."""

from __future__ import annotations

import subprocess
import sys
from itertools import product

import pytest
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from adhoc.cli.comparing import comparisons_of, provider_of
from adhoc.cli.experiment_overrides import with_swept
from adhoc.cli.hydra_run import run_with_hydra
from adhoc.cli.main import main
from adhoc.cli.schema import register_schema
from adhoc.core.errors import ConfigurationError
from adhoc.core.resources import data_dir
from adhoc.evaluation.records import RecordFile
from adhoc.experiments.scenario_run import run_scenario

ROOT = data_dir("configs")
EXPERIMENTS = sorted(path.stem for path in (ROOT / "experiment").glob("*.yaml"))
PAPER_ROWS = {"random", "heuristic", "plastic", "naive", "gpl", "cot", "irot"}
TINY = ["benchmark=sample", "limit=1", "max_steps=12", "pictures=false", "transcript=false"]


def params(name: str) -> dict[str, list[str]]:
    swept = OmegaConf.load(ROOT / "experiment" / f"{name}.yaml").hydra.sweeper.params
    return {str(key): str(values).split(",") for key, values in swept.items()}


def configs(name: str):
    """One for each team and policy, at the first joining step."""
    register_schema()
    swept = {**params(name), "join_step": params(name)["join_step"][:1]}
    with initialize_config_dir(str(ROOT), version_base="1.3"):
        for values in product(*swept.values()):
            pairs = [f"{key}={value}" for key, value in zip(swept, values)]
            yield compose("run", [f"experiment={name}", *pairs, "benchmark=sample", "limit=1"])


def test_the_tables_of_the_paper_are_there():
    for name, join_step in (("table1", "0"), ("table2", "50"), ("table3", "100")):
        swept = params(name)
        assert swept["join_step"] == [join_step]
        assert swept["team"] == ["heuristic", "learned", "llm"]
        assert set(swept["policy"]) == PAPER_ROWS | {"none"}
    assert len(params("ablation")["policy"]) == 6
    assert params("ablation")["join_step"] == ["0", "50", "100"]


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_experiment_composes_and_builds(name):
    composed = list(configs(name))
    comparisons = comparisons_of(composed, provider_of(composed[0]), lambda place, _: str(place))
    try:
        entrants = [(it.newcomer.name, it.join_step) for one in comparisons for it in one.entrants]
    finally:
        comparisons.close()
    joined = [it for it in composed if it.policy.name != "none"]
    assert len(entrants) == len(joined)
    assert len(comparisons) == len(params(name)["team"])


def test_what_an_experiment_sweeps_may_be_swept_otherwise():
    given = ["experiment=table1", "policy=naive,irot", "limit=3", "join_step='it''s'"]
    assert with_swept(given, [ROOT]) == [
        "experiment=table1",
        "hydra.sweeper.params={policy:'naive,irot'}",
        "limit=3",
        "hydra.sweeper.params={join_step:'\\'it\\'\\'s\\''}",
    ]
    assert with_swept(["policy=naive,irot"], [ROOT]) == ["policy=naive,irot"]


def test_two_experiments_at_once_are_refused():
    with pytest.raises(ConfigurationError, match="experiment=table1,table2: one at a time"):
        run_with_hydra(["-m", "experiment=table1,table2", *TINY])


MINE = """\
# @package _global_
defaults: [{override /policy: irot}]
policy: {name: "irot_n${policy.generator.n}"}
hydra: {mode: MULTIRUN, sweeper: {params: {policy.generator.n: "1,3", join_step: "0"}}}
"""


@pytest.mark.parametrize("place", [0, 1, 2])
def test_an_experiment_of_ones_own_is_found_wherever_its_folder_is_named(tmp_path, capsys, place):
    (tmp_path / "mine" / "experiment").mkdir(parents=True)
    (tmp_path / "mine" / "experiment" / "candidates.yaml").write_text(MINE)
    words = ["experiment=candidates", "policy.generator.n=1,2", *TINY, f"out={tmp_path / 'out'}"]
    words[place:place] = ["--config-dir", str(tmp_path / "mine")]
    assert run_with_hydra(words) == 0
    assert "3 episodes in 1 scenario" in capsys.readouterr().out
    assert {it["policy"] for it in RecordFile(tmp_path / "out").read()} == {"none", "irot_n1", "irot_n2"}


def test_an_experiment_runs_as_one_plan(tmp_path, capsys):
    out = tmp_path / "out"
    assert (
        run_with_hydra(
            ["experiment=table1", "team=heuristic", "policy=none,random,heuristic", *TINY, f"out={out}"]
        )
        == 0
    )
    said = capsys.readouterr().out
    assert "3 episodes in 1 scenario; recorded: 0; to run: 3 (No ad hoc 1, Random 1, Heuristic 1)" in said
    records = RecordFile(out).read()
    assert [it["policy"] for it in records] == ["none", "random", "heuristic"]
    assert {it["run"] for it in records} <= {path.stem for path in (out / "provenance").iterdir()}


def test_a_sweep_is_shared_out_and_merged(tmp_path, capsys):
    swept = ["-m", "policy=random,heuristic", "join_step=0,3", *TINY, "limit=3"]
    for number in (1, 2):
        run_with_hydra([*swept, f"out={tmp_path / 'parts'}", f"shard={number}/2"])
    assert main(["merge", str(tmp_path / "parts")]) == 0
    run_with_hydra([*swept, f"out={tmp_path / 'whole'}", "workers=2"])
    merged, whole = (RecordFile(tmp_path / name).read() for name in ("parts", "whole"))
    assert {it["episode_id"] for it in merged} == {it["episode_id"] for it in whole}
    assert len(merged) == 3 * 5
    tables = []
    for name in ("parts", "whole"):
        capsys.readouterr()
        main(["report", str(tmp_path / name)])
        tables.append(capsys.readouterr().out)
    assert tables[0] == tables[1]


def test_several_runs_of_one_command_have_their_own_folders(tmp_path):
    run_with_hydra(["-m", "policy=random,heuristic", *TINY, f"out={tmp_path}/${{policy.name}}"])
    assert [len(RecordFile(tmp_path / name).read()) for name in ("random", "heuristic")] == [2, 2]


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("experiment=table9", "experiment=table9: no such choice; there are: ablation"),
        ("shard=3/2", "shard=3/2: must be i/n"),
        ("shard=half", "shard=half: must be i/n"),
        ("fail_on_error=-1", "fail_on_error=-1.0: must be a share"),
        ("executor=cloud", "executor=cloud: no such choice"),
        ("executor.name=cloud", r"executor\.name=cloud: must be one of local, serial, processes, ray"),
        ("join_step=soon", "join_step"),
        ("policy.name='机器'", "policy.name=机器: must begin with an ASCII letter"),
        ("policy.name=none", "policy.name=none: is the name of no policy"),
        ("team.name=", r"team\.name=: must begin"),
    ],
)
def test_ill_typed_and_unknown_values_are_named(tmp_path, override, message):
    with pytest.raises(ConfigurationError, match=message):
        run_with_hydra([*TINY, f"out={tmp_path}", override])
    assert not (tmp_path / "episodes.jsonl").exists()


def test_a_serial_run_has_no_workers(tmp_path):
    with pytest.raises(ConfigurationError, match="executor=serial has no workers=2"):
        run_with_hydra([*TINY, f"out={tmp_path}", "executor=serial", "workers=2"])


@pytest.mark.parametrize("flag", [["--cfg", "job"], ["--info", "config"]])
def test_hydra_tells_what_it_composed(tmp_path, flag):
    """In a process of its own: Hydra sets up its logging for it."""
    command = [
        sys.executable,
        "-m",
        "adhoc.cli.main",
        "run",
        "experiment=ablation",
        f"out={tmp_path / 'out'}",
    ]
    told = subprocess.run([*command, *flag], cwd=tmp_path, capture_output=True, text=True, timeout=100)
    assert told.returncode == 0
    assert "LLMGenerator" in told.stdout
    assert not (tmp_path / "out" / "episodes.jsonl").exists()


def test_nothing_of_a_command_line_is_written_beside_the_records(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run_with_hydra(["-m", "policy=random,heuristic", "+llm.api_key=sk-abcdefghijklmnop", *TINY, "out=here"])
    written = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert not [path for path in written if b"sk-abcdefghijklmnop" in path.read_bytes()]
    assert [path.name for path in tmp_path.iterdir()] == ["here"]


def test_each_shard_has_its_own_ledger_and_tells_its_models(tmp_path):
    run_with_hydra(["policy=irot", "ledger.mode=record", "shard=1/2", *TINY, f"out={tmp_path}"])
    part = tmp_path / "shard-1-of-2"
    assert [path.name for path in tmp_path.iterdir()] == ["shard-1-of-2"]
    if RecordFile(part).read():
        assert list((part / "ledger").glob("*.jsonl"))


def test_going_on_with_another_version_is_said(tmp_path):
    run_with_hydra(["policy=random", *TINY, f"out={tmp_path}"])
    old = [{**it, "library_version": "0.0.1"} for it in RecordFile(tmp_path).read()]
    RecordFile(tmp_path).replace(old)
    with pytest.warns(UserWarning, match=r"holds episodes of adhoc 0\.0\.1"):
        run_with_hydra(["policy=heuristic", *TINY, f"out={tmp_path}"])


def test_a_report_says_that_a_run_did_not_finish(tmp_path, capsys, monkeypatch):
    stopped = "adhoc.experiments.run.run_scenario"
    before = run_scenario

    def interrupted(comparison, position, store, progress):
        if store.records:
            raise KeyboardInterrupt
        before(comparison, position, store, progress)

    monkeypatch.setattr(stopped, interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_with_hydra(["policy=random", *TINY, "limit=2", f"out={tmp_path}"])
    main(["report", str(tmp_path)])
    assert "1 run did not finish" in " ".join(capsys.readouterr().out.split())
    monkeypatch.setattr(stopped, before)
    run_with_hydra(["policy=random", *TINY, "limit=2", f"out={tmp_path}"])
    capsys.readouterr()
    main(["report", str(tmp_path)])
    assert "did not finish" not in capsys.readouterr().out
