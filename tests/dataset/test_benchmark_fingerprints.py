from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from adhoc.core.errors import DatasetError, HouseError
from adhoc.dataset.benchmarks import TaskFileBenchmark
from adhoc.dataset.files.dataset_folder import SHIPPED
from adhoc.dataset.procthor10k import ProcThor10kBenchmark
from adhoc.evaluation.benchmark import Benchmark, Draw, HouseBenchmark, SampleBenchmark
from adhoc.houses.samples import sample_path


def test_benchmarks_say_nothing_by_default():
    class Nothing(Benchmark):
        def scenarios(self, world, seed, limit=None):
            return []

    assert Nothing().fingerprint == ""


def test_a_fingerprint_is_of_the_houses_that_are_drawn_in():
    prints = {name: SampleBenchmark([Draw(name)]).fingerprint for name in ("corridor", "one_room")}
    assert len({*prints.values()}) == 2
    both = SampleBenchmark([Draw("one_room"), Draw("corridor"), Draw("corridor", seed=1)])
    assert both.fingerprint == SampleBenchmark([Draw("corridor"), Draw("one_room")]).fingerprint
    assert both.fingerprint not in prints.values()


@pytest.mark.parametrize("make", [HouseBenchmark, lambda path: ProcThor10kBenchmark(str(path))])
def test_a_fingerprint_is_of_the_content_of_a_house_file_and_of_no_folder(tmp_path, make):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        shutil.copy(sample_path("one_room"), tmp_path / folder / "house.json")
    first, second = (tmp_path / folder / "house.json" for folder in ("a", "b"))
    assert make(first).fingerprint == make(second).fingerprint
    second.write_text(second.read_text() + " ")
    assert make(first).fingerprint != make(second).fingerprint
    second.unlink()
    with pytest.raises(HouseError, match=r"house\.json"):
        _ = make(second).fingerprint


def test_houses_of_another_package_have_none():
    assert ProcThor10kBenchmark().fingerprint == ""


def test_a_dataset_is_known_by_its_tasks_and_houses(tmp_path):
    shipped = TaskFileBenchmark().fingerprint
    assert shipped != TaskFileBenchmark(split="val").fingerprint
    assert shipped == TaskFileBenchmark(subset="sample").fingerprint
    copy = Path(shutil.copytree(SHIPPED / "paper", tmp_path / "copy"))
    assert TaskFileBenchmark(folder=str(copy)).fingerprint == shipped
    shutil.copy(copy / "tasks-val.jsonl.gz", copy / "tasks-test.jsonl.gz")
    assert TaskFileBenchmark(folder=str(copy)).fingerprint != shipped
    (copy / "houses-test.jsonl.gz").write_bytes(b"no")
    with pytest.raises(DatasetError, match="houses-test"):
        _ = TaskFileBenchmark(folder=str(copy)).fingerprint
