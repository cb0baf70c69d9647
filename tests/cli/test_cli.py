from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from adhoc.cli.main import main
from adhoc.core.resources import data_dir

ROOT = Path(__file__).parents[2]
FAKES = str(ROOT / "tests" / "evaluation")
"""Where the smallest world is (`grid_world`)."""


@pytest.fixture(autouse=True)
def _fakes(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(FAKES)
    monkeypatch.chdir(tmp_path)


def adhoc(*arguments):
    return main(list(arguments))


def small_run(*arguments):
    """A run in the grid world with policies that walk at random: one scenario, 20 steps."""
    return adhoc(
        "run",
        "world._target_=grid_world.GridWorld",
        "team.agent._target_=grid_world.Script",
        "benchmark.draws=[{house: one_room, seed: 1, misplaced: 1, teammates: 3}]",
        "max_steps=20",
        "out=results",
        "pictures=false",
        *arguments,
    )


def walker(*arguments):
    return small_run("policy=random", "policy.agent._target_=grid_world.Script", *arguments)


def records(folder="results"):
    lines = Path(folder, "episodes.jsonl").read_text().splitlines()
    return [json.loads(line) for line in lines]


class TestMain:
    @pytest.mark.parametrize(("number", "code"), [(errno.ENOSPC, 2), (errno.EFBIG, 2), (errno.EBADF, None)])
    def test_a_full_disk_is_one_line_and_other_troubles_keep_their_trace(
        self, monkeypatch, capsys, number, code
    ):
        def fail(arguments):
            raise OSError(number, os.strerror(number))

        monkeypatch.setattr("adhoc.cli.report.main", fail)
        if code is None:
            with pytest.raises(OSError, match="Bad file descriptor"):
                adhoc("report", "x")
        else:
            assert adhoc("report", "x") == code
            told = f"adhoc report: error: a file could not be written: {os.strerror(number)}\n"
            assert capsys.readouterr().err == told

    def test_a_reader_that_goes_away_is_no_trouble(self):
        program = (
            "import sys\n"
            "from adhoc.cli import ledger\n"
            "from adhoc.cli.main import main\n"
            "ledger.main = lambda arguments: [sys.stdout.write('x' * 99) for _ in range(9999)]\n"
            "sys.exit(main(['ledger']))"
        )
        with subprocess.Popen(
            [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE
        ) as asked:
            asked.stdout.close()
            assert asked.stderr.read() == b""
            assert asked.wait(60) == 141

    def test_help_imports_nothing_heavy(self):
        program = (
            "import sys\n"
            "from adhoc.cli.main import main\n"
            "try:\n    main(['--help'])\nexcept SystemExit:\n    pass\n"
            "main(['run', '--help'])\n"
            "heavy = {'hydra', 'pybullet', 'numba', 'litellm', 'torch', 'matplotlib', 'numpy', 'rich'}\n"
            "sys.exit(','.join(heavy & set(sys.modules)) or 0)"
        )
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr
        assert "policy=" in done.stdout

    def test_an_unknown_command_lists_the_known(self, capsys):
        with pytest.raises(SystemExit) as stop:
            adhoc("rum")
        assert stop.value.code == 2
        assert "'run', 'sensitivity', 'report', 'inspect'" in capsys.readouterr().err

    def test_the_version_is_told(self, capsys):
        with pytest.raises(SystemExit):
            adhoc("--version")
        assert capsys.readouterr().out.startswith("adhoc 0")


class TestErrors:
    @pytest.mark.parametrize(
        ("arguments", "told"),
        [
            (["join_step=abc"], "'abc' of type 'str' could not be converted to Integer"),
            (["policy=foo"], "policy=foo: no such choice; there are: cot, gpl, heuristic, human, idle, irot"),
            (["policy=none,random"], "policy=none,random: several values need -m: adhoc run -m policy=none"),
            (["join_step=0,50"], "several values need -m"),
            (["policy/evaluator=foo"], "there are: gpl, keep_order, llm"),
            (["joinstep=3"], "keys of a run: policy, team, task"),
            (["join_step=600"], "must be at least 0 and below max_steps=500"),
            (["join_step=-1"], "must be at least 0"),
            (["limit=0"], "limit=0: must be at least 1"),
            (["max_steps=0"], "max_steps=0: must be at least 1"),
            (["llm=litellm"], "llm.model=...: must be given"),
            (["benchmark=house", "policy=none"], "benchmark.path=...: must be given"),
            (["benchmark=house", "benchmark.path=no.json", "policy=none"], "no.json"),
            (
                ["policy.agent._target_=nowhere.Policy"],
                "policy.agent._target_=nowhere.Policy: cannot be imported",
            ),
            (["policy.agent._target_=adhoc.core.values.Pose"], "Pose"),
            (["policy.agent._target_=pathlib.Path"], "policy.agent: PosixPath is no Policy"),
            (["policy.agent._target_=builtins.dict"], "builtins.dict: cannot be configured"),
            (["policy.agent._target_=.Policy"], "must be the dotted name of a class"),
            (["policy.agent=null"], "policy.agent=None: is no component; it needs a _target_"),
            (["policy.generator._target_=collections.Counter"], "policy.generator: Counter is no SubTaskGen"),
            (["policy.evaluator._target_=pathlib.Path"], "policy.evaluator: PosixPath is no Evaluator"),
            (["policy.reflector._target_=pathlib.Path"], "policy.reflector: PosixPath is no Reflector"),
            (["policy.planner._target_=pathlib.Path"], "policy.planner: PosixPath is no Planner"),
            (["policy.sub_skill_planner._target_=pathlib.Path"], "PosixPath is no SubSkillPlanner"),
            (["policy.evaluator._target_=adhoc.Evaluator"], "TypeError: Can't instantiate abstract class"),
            (["world=null"], "Config group override must be a string"),
            (["policy.generator.n=abc"], "policy.generator.n='abc': must be int"),
            (["policy.agent.patience=abc"], "policy.agent.patience='abc': must be int"),
            (["policy.planner.accept_unjudged=1"], "policy.planner.accept_unjudged=1: must be bool"),
            (["world.image_size=abc", "policy=none"], "world.image_size='abc': must be int"),
            (["world.mass_scale=x", "policy=none"], "world.mass_scale='x': must be float"),
            (["+world.image_size=64", "policy=none"], "+world.image_size=...: is set already; leave out the"),
            (["benchmark.draws=[{house: one_room, seed: x}]"], "benchmark.draws: seed='x' of {'house'"),
            (["benchmark.draws=[{house: one_room, misplaced: 1.5}]"], "misplaced=1.5 of {'house'"),
            (
                ["benchmark.draws=3"],
                "benchmark.draws=3: adhoc.evaluation.benchmark.SampleBenchmark cannot be",
            ),
            (["policy.generator.m=4"], "(keys of policy.generator: _target_, n; +policy.generator.KEY=VALUE"),
            (["policy.agnt=4"], "(keys of policy: generator, evaluator"),
            (["failed_share=ful"], "failed_share=ful: must be one of from_joining, full"),
            (["out="], "out=: must name the run folder"),
            (["+policy.generator.m=4"], "its parameters are: model, n, template"),
            (["+world.image_sice=3", "policy=none"], "its parameters are: image_size"),
            (["=="], "Error parsing override"),
        ],
    )
    def test_each_is_one_line_that_says_what_would_be_right(self, capsys, arguments, told):
        assert adhoc("run", *arguments) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert error.startswith("adhoc run: error: ")
        assert told in error

    @pytest.mark.parametrize("out", ["file", "file/below", "/dev/null/below"])
    @pytest.mark.parametrize("sweep", [[], ["-m"]])
    def test_a_run_folder_that_cannot_be_made(self, capsys, out, sweep):
        Path("file").write_text("precious")
        assert adhoc("run", *sweep, "policy=none", f"out={out}") == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert f"out={out}: no run folder can be made there" in error or "out=/dev/null: " in error
        assert Path("file").read_text() == "precious"

    def test_a_table_that_cannot_be_written(self, capsys):
        walker()
        assert adhoc("report", "results", "--markdown", "nowhere/table.md") == 2
        assert capsys.readouterr().err == (
            "adhoc report: error: --markdown nowhere/table.md: there is no such folder\n"
        )

    def test_a_sweep_with_a_wrong_value_does_not_begin(self, capsys):
        assert walker("-m", "join_step=3,99") == 2
        assert "join_step=99" in capsys.readouterr().err
        assert not Path("results/episodes.jsonl").exists()

    def test_a_folder_without_records(self, capsys):
        assert adhoc("report", "nowhere") == 2
        assert "nowhere/episodes.jsonl: no episode records" in capsys.readouterr().err

    def test_a_file_that_is_no_house(self, capsys):
        Path("broken.json").write_text("{")
        assert adhoc("house", "broken.json") == 2
        assert "broken.json" in capsys.readouterr().err

    @pytest.mark.filterwarnings("always")
    def test_a_torn_record_is_a_warning_in_one_line(self, capsys):
        walker()
        path = Path("results/episodes.jsonl")
        path.write_bytes(path.read_bytes()[:-20])
        assert walker() == 0
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert error.startswith("adhoc: warning: results/episodes.jsonl, line 2: incomplete last record")
        assert len(records()) == 2


class TestRun:
    def test_a_run_and_its_report(self, capsys):
        assert walker("join_step=4") == 0
        assert [it["policy"] for it in records()] == ["none", "random"]
        assert adhoc("report", "results", "--markdown", "table.md") == 0
        out = capsys.readouterr().out
        assert "2/2" in out
        assert "The ad hoc robot joins at step 4" in out
        assert "| Heuristic based | No ad hoc |" in Path("table.md").read_text()

    def test_a_sweep_runs_the_team_alone_once(self):
        assert walker("join_step=0,4,8", "-m") == 0
        assert [(it["policy"], it["join_step"]) for it in records()] == [
            ("none", None),
            ("random", 0),
            ("random", 4),
            ("random", 8),
        ]

    def test_the_same_command_again_runs_nothing(self, capsys):
        walker()
        before = Path("results/episodes.jsonl").read_bytes()
        assert walker() == 0
        assert "2 episodes in 1 scenario; recorded: 2; to run: 0" in capsys.readouterr().out
        assert Path("results/episodes.jsonl").read_bytes() == before

    def test_another_configuration_in_the_same_folder_is_refused(self, capsys):
        walker()
        assert walker("max_steps=21") == 2
        assert "max_steps: 20 there, 21 here" in capsys.readouterr().err

    def test_nothing_is_left_outside_of_the_run_folder(self):
        walker("-m", "join_step=0,4")
        assert [path.name for path in Path().iterdir()] == ["results"]
        assert {path.name for path in Path("results").iterdir()} == {
            "episodes.jsonl",
            "provenance",
            "run.lock",
            "settings",
        }

    def test_a_run_that_is_killed_leaves_nothing_in_the_temporary_folder(self, monkeypatch):
        """Because it makes nothing there."""
        monkeypatch.setattr("tempfile.tempdir", "nowhere")
        assert walker() == 0

    def test_pictures_are_drawn(self):
        assert walker("pictures=true") == 0
        assert sorted(path.name for path in Path("results/pictures").iterdir()) == [
            "one_room-s1--heuristic--alone.png",
            "one_room-s1--heuristic--random--t0.png",
        ]

    def test_seeds_give_other_scenarios_in_one_folder(self):
        assert small_run("policy=none", "seed=0,1", "-m") == 0
        assert [it["task_id"] for it in records()] == ["one_room-s1", "one_room-s1-r1"]
        assert records()[0]["seed"] == 1
        assert len({it["scenario_hash"] for it in records()}) == 2

    def test_the_share_of_failures_is_a_key(self):
        for share in ("from_joining", "full"):
            assert walker(f"failed_share={share}", "join_step=5", f"out={share}") == 0
        assert [records(share)[1]["failed_share"] for share in ("from_joining", "full")] == [
            "from_joining",
            "full",
        ]
        assert [records(share)[1]["action_steps"] for share in ("from_joining", "full")] == [
            20 * 3 + 15,
            20 * 4,
        ]

    def test_another_share_of_failures_in_the_same_folder_is_refused(self, capsys):
        walker()
        assert walker("failed_share=full") == 2
        assert "failed_share: 'from_joining' there, 'full' here" in capsys.readouterr().err

    def test_settings_of_a_replaced_class_do_not_reach_the_new_one(self):
        """`GridWorld` has no `image_size`, `Script` no `may_stop`; what is given has to fit all the same."""
        assert walker() == 0
        assert walker("world.image_size=3", "out=other") == 2
        settings = [json.loads(path.read_text()) for path in Path("results/settings").iterdir()]
        assert {tuple(it["world"]) for it in settings} == {("_target_", "name")}

    def test_a_stage_of_ones_own_from_ones_own_folder(self, capsys):
        """One file and one config, without editing anything of the library."""
        Path("my_stage.py").write_text(
            "from adhoc.planning.interfaces import Evaluator\n"
            "class LastFirst(Evaluator):\n"
            "    def rank(self, context, candidates):\n"
            "        return tuple(reversed(candidates))\n"
        )
        Path("mine/policy/evaluator").mkdir(parents=True)
        Path("mine/policy/evaluator/last_first.yaml").write_text("_target_: my_stage.LastFirst\n")
        sys.path.insert(0, ".")
        try:
            code = adhoc("run", "--config-dir", "mine", "policy/evaluator=last_first", "--cfg", "job")
        finally:
            sys.path.remove(".")
        assert code == 0
        assert "my_stage.LastFirst" in capsys.readouterr().out


class TestHouse:
    def test_a_sample_is_described_and_drawn(self, capsys):
        file = ROOT / "adhoc" / "houses" / "samples" / "corridor.json"
        assert adhoc("house", str(file), "--picture", "plan.png") == 0
        out = capsys.readouterr().out
        assert "3 rooms (Easy)" in out
        assert "Corridor" in out
        assert Path("plan.png").stat().st_size > 3000


def test_help_lists_every_choice(capsys):
    assert adhoc("run", "--help") == 0
    out = capsys.readouterr().out
    for file in data_dir("configs").rglob("*.yaml"):
        if file.stem != "run":
            assert file.stem in out
