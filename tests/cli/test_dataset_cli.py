from __future__ import annotations

import gzip
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from adhoc.cli.main import main
from adhoc.dataset.files.ceiling_file import write_ceilings
from adhoc.dataset.files.checked_lines import write_compressed
from adhoc.dataset.files.dataset_folder import SplitFiles
from adhoc.houses import samples

SAMPLES = Path(samples.__file__).parent / "samples"
TASK = "test-01-00-k2-t3"


def adhoc(*arguments):
    return main(list(arguments))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """One generated house with its tasks, by the command itself."""
    folder = tmp_path_factory.mktemp("made") / "mine"
    small = ["--split", "test", "--rooms", "1", "--houses-per-count", "1", "--workers", "1", "--seed", "3"]
    assert adhoc("dataset", "make", "--name", "mine", "--out", str(folder), *small) == 0
    return folder


@pytest.fixture(autouse=True)
def _here(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)


class TestMake:
    def test_it_says_what_it_made(self, capsys):
        small = ["--split", "val", "--rooms", "1", "--houses-per-count", "1", "--workers", "1"]
        assert adhoc("dataset", "make", "--name", "mine", *small) == 0
        assert capsys.readouterr().out == "mine/tasks-val.jsonl.gz: 1 houses, 15 tasks\n"
        assert sorted(path.name for path in Path("mine").iterdir()) == [
            "houses-val.jsonl.gz",
            "houses-val.sha256",
            "making-val.json",
            "tasks-val.jsonl.gz",
        ]

    @pytest.mark.parametrize(
        ("arguments", "told"),
        [
            (["--rooms", "9"], "rooms=[9]: must be some of 1, 2, 3, 4, 5, 6, 7, 8, 10"),
            (["--rooms", "one"], "--rooms one: must be numbers of rooms with commas, e.g. 1,2,10"),
            (["--houses-per-count", "500"], "houses_per_count=500: must be from 1 to 100"),
        ],
    )
    def test_wrong_values_are_one_line(self, capsys, arguments, told):
        assert adhoc("dataset", "make", *arguments) == 2
        assert capsys.readouterr().err == f"adhoc dataset: error: {told}\n"

    def test_no_workers_are_refused(self, capsys):
        with pytest.raises(SystemExit):
            adhoc("dataset", "make", "--workers", "0")
        assert "'0' is no whole number of 1 or more" in capsys.readouterr().err


class TestCheck:
    def test_a_sound_dataset(self, capsys, made):
        assert adhoc("dataset", "check", str(made), "--workers", "1") == 0
        out = capsys.readouterr().out
        assert "test: 1 houses and 15 tasks checked, 0 violations" in out
        assert "how houses were drawn" in out

    def test_violations_are_listed_and_the_code_is_1(self, capsys, made, tmp_path):
        copy = tmp_path / "copy"
        copy.mkdir()
        for path in made.iterdir():
            (copy / path.name).write_bytes(path.read_bytes())
        (copy / "houses-test.sha256").write_text("0" * 64 + "  test-01-00\n")
        assert adhoc("dataset", "check", str(copy), "--tasks", "1", "--workers", "1") == 1
        assert "hashes: houses-test.sha256 line 1: should be" in capsys.readouterr().out

    def test_a_damaged_file_is_one_line(self, capsys, made, tmp_path):
        content = gzip.decompress((made / "tasks-test.jsonl.gz").read_bytes())
        write_compressed(tmp_path / "tasks-test.jsonl.gz", content.replace(b'"steps":', b'"stepz":', 1))
        assert adhoc("dataset", "check", str(tmp_path)) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert "tasks-test.jsonl.gz, line 2: the checksum ('crc') does not fit the line" in error

    def test_an_empty_folder_is_refused(self, capsys, tmp_path):
        assert adhoc("dataset", "check", str(tmp_path)) == 2
        assert "there are no task files in this folder" in capsys.readouterr().err

    def test_houses_of_a_file(self, capsys):
        assert adhoc("dataset", "check", "--house", str(SAMPLES / "one_room.json")) in (0, 1)
        assert "one_room: 1 rooms, " in capsys.readouterr().out

    def test_a_house_with_a_fault(self, capsys, tmp_path):
        house = json.loads((SAMPLES / "one_room.json").read_text())
        first, second = house["objects"][:2]
        second["position"] = {**first["position"]}
        (tmp_path / "bad.json").write_text(json.dumps(house))
        assert adhoc("dataset", "check", "--house", "bad.json") == 1
        assert "penetration: bad " in capsys.readouterr().out


class TestShow:
    def test_a_task_is_told_and_drawn(self, capsys, made):
        assert adhoc("dataset", "show", TASK, "--dataset", str(made)) == 0
        out = capsys.readouterr().out
        assert out.startswith(f"{TASK}: Easy\n1 rooms: ")
        assert "teammate_3" in out
        assert "newcomer" in out
        assert out.endswith(f"drawn: {TASK}.png\n")
        assert Path(f"{TASK}.png").read_bytes().startswith(b"\x89PNG")

    def test_the_picture_can_be_named(self, made):
        assert adhoc("dataset", "show", TASK, "--dataset", str(made), "--picture", "pictures/it.png") == 0
        assert Path("pictures/it.png").is_file()

    @pytest.mark.parametrize(
        ("task", "told"),
        [
            ("test-01-00-k9-t3", "there is no task 'test-01-00-k9-t3'; ids are like 'test-01-00-k1-t3'"),
            ("val-01-00-k1-t3", "there is no split 'val' in this dataset"),
            ("demo", "no task 'demo': ids begin with train, val, test"),
        ],
    )
    def test_an_unknown_task_is_one_line(self, capsys, made, task, told):
        assert adhoc("dataset", "show", task, "--dataset", str(made)) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert told in error


class TestRun:
    def test_a_run_on_a_dataset(self, made, monkeypatch):
        monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "evaluation"))
        command = ["benchmark=paper", f"benchmark.folder={made}", "policy=none", "limit=1", "max_steps=3"]
        assert adhoc("run", *command, "world.image_size=16", "pictures=false", "out=results", "seed=4") == 0
        (record,) = map(json.loads, Path("results/episodes.jsonl").read_text().splitlines())
        assert record["task_id"] == "test-01-00-k1-t3-r4"

    def test_a_missing_dataset_is_one_line(self, capsys):
        assert adhoc("run", "benchmark=paper", "benchmark.folder=nowhere", "policy=none") == 2
        assert "nowhere: there is no such folder" in capsys.readouterr().err


@pytest.mark.parametrize("command", [[], ["make"], ["check"], ["show"]])
def test_help(command):
    program = [sys.executable, "-m", "adhoc.cli.main", "dataset", *command, "--help"]
    done = subprocess.run(program, capture_output=True, text=True, timeout=100)
    assert done.returncode == 0
    assert done.stdout.startswith(f"usage: adhoc dataset {' '.join(command)}".rstrip())


class TestCeilings:
    def test_they_are_made_summed_up_and_shown(self, made, tmp_path, capsys):
        folder = shutil.copytree(made, tmp_path / "mine")
        page = tmp_path / "ceilings.md"
        assert (
            adhoc("dataset", "ceilings", str(folder), "--make", "--workers", "1", "--markdown", str(page))
            == 0
        )
        assert "What the oracle solves" in capsys.readouterr().out
        assert page.read_text(encoding="utf-8").splitlines()[-1].startswith("| all | all | 15 |")
        assert adhoc("dataset", "show", TASK, "--dataset", str(folder)) == 0
        assert "oracle: " in capsys.readouterr().out
        assert adhoc("dataset", "check", str(folder), "--tasks", "1", "--workers", "1") == 0

    def test_a_floor_stands_beside_them(self, made, tmp_path, capsys):
        folder = shutil.copytree(made, tmp_path / "mine")
        adhoc("dataset", "ceilings", str(folder), "--make", "--workers", "1")
        run = ["benchmark=paper", f"benchmark.folder={folder}", "limit=1", "policy=none", "max_steps=5"]
        assert adhoc("run", *run, "out=floor", "pictures=false", "transcript=false") == 0
        capsys.readouterr()
        assert adhoc("dataset", "ceilings", str(folder), "--floor", "floor") == 0
        assert "| Easy | 3 | 1 |" in capsys.readouterr().out

    def test_a_task_that_has_none_is_shown_without(self, made, tmp_path, capsys):
        folder = shutil.copytree(made, tmp_path / "mine")
        write_ceilings(SplitFiles(folder, "test"), [], 500)
        assert adhoc("dataset", "show", TASK, "--dataset", str(folder)) == 0
        assert "oracle: not asked for this task" in capsys.readouterr().out

    @pytest.mark.parametrize("picture", ["task.xyz", "."])
    def test_pictures_are_png_files(self, made, capsys, picture):
        assert adhoc("dataset", "show", TASK, "--dataset", str(made), "--picture", picture) == 2
        assert "must be a file that ends with .png" in capsys.readouterr().err

    def test_without_verdicts_it_says_where_they_should_be(self, made, capsys):
        assert adhoc("dataset", "ceilings", str(made)) == 2
        assert "ceilings-test.jsonl.gz" in capsys.readouterr().err
