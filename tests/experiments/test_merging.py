from __future__ import annotations

import shutil
from dataclasses import replace

import pytest
from grid_world import GridWorld
from test_plan import MANY
from test_run import HELPER, conditions

from adhoc.cli.merge import shards_in
from adhoc.core.errors import ConfigurationError, RecordError
from adhoc.evaluation.records import UNFINISHED_NAME, RecordFile, checked_part
from adhoc.experiments.comparison import Comparison, Entrant
from adhoc.experiments.failures import Failure, FailureFile
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.merging import merge_folders
from adhoc.experiments.plan import Shard, make_plan
from adhoc.experiments.provenance.file import Provenance, write_provenance
from adhoc.experiments.run import run_plan


def run(path, shard=None, helper=HELPER, **changes):
    comparison = Comparison(GridWorld(), MANY, conditions(**changes), (Entrant(helper, 5),))
    folder = RunFolder(path)
    run_plan(make_plan([comparison], folder, shard=shard), [comparison], folder)


def contents(path):
    return {it["episode_id"]: checked_part(it) for it in RecordFile(path).read()}


def in_shards(folder, count=3):
    for number in range(1, count + 1):
        run(folder / f"shard-{number}-of-{count}", Shard(number, count))
    return shards_in(folder)


def test_merged_shards_are_the_undisturbed_run(tmp_path):
    merged = merge_folders(tmp_path / "all", in_shards(tmp_path / "parts"))
    run(tmp_path / "whole")
    assert contents(tmp_path / "all") == contents(tmp_path / "whole")
    assert (merged.records, merged.new, merged.failures) == (24, 24, 0)
    assert {it.name for it in (tmp_path / "all/settings").iterdir()} == {
        it.name for it in (tmp_path / "whole/settings").iterdir()
    }


def test_merging_again_adds_what_is_new(tmp_path):
    parts = in_shards(tmp_path)
    merge_folders(tmp_path, parts[:2])
    merged = merge_folders(tmp_path, parts)
    assert (merged.records, merged.new) == (24, 8)
    before = (tmp_path / "episodes.jsonl").read_bytes()
    assert merge_folders(tmp_path, parts).new == 0
    assert (tmp_path / "episodes.jsonl").read_bytes() == before


def test_a_run_of_the_whole_goes_on_with_what_was_merged(tmp_path):
    merge_folders(tmp_path, in_shards(tmp_path)[:2])
    run(tmp_path)
    assert len(contents(tmp_path)) == 24


def test_an_episode_that_came_out_otherwise_is_refused_and_nothing_is_written(tmp_path):
    run(tmp_path / "a")
    shutil.copytree(tmp_path / "a", tmp_path / "b")
    records = RecordFile(tmp_path / "b").read()
    RecordFile(tmp_path / "b").replace([{**records[0], "steps": 1}, *records[1:]])
    with pytest.raises(RecordError, match=r"b: episode .* came out otherwise in .*a"):
        merge_folders(tmp_path / "all", [tmp_path / "a", tmp_path / "b"])
    assert not (tmp_path / "all").exists()


def test_parts_of_several_configurations_are_refused(tmp_path):
    run(tmp_path / "a", Shard(1, 2))
    run(tmp_path / "b", Shard(2, 2), replace(HELPER, settings={"name": "helper", "n": 5}))
    with pytest.raises(RecordError, match="another configuration of team=walkers policy=helper"):
        merge_folders(tmp_path / "all", [tmp_path / "a", tmp_path / "b"])


def test_a_part_without_records_is_refused(tmp_path):
    run(tmp_path / "a")
    with pytest.raises(RecordError, match="b: there are no episode records"):
        merge_folders(tmp_path / "all", [tmp_path / "a", tmp_path / "b"])


def test_failures_stay_unless_the_episode_is_recorded_elsewhere(tmp_path):
    parts = in_shards(tmp_path, 2)
    recorded = RecordFile(parts[0]).read()[0]["episode_id"]
    for name in (recorded, "another"):
        failure = Failure(name, "t", "walkers", "helper", 5, "WorldError", "m", "", "0")
        FailureFile(parts[1]).add(failure)
    assert merge_folders(tmp_path, parts).failures == 1
    assert [it.episode_id for it in RunFolder(tmp_path).failures] == ["another"]


def test_calls_of_all_parts_stay_one_ledger(tmp_path):
    parts = in_shards(tmp_path, 2)
    for part in parts:
        (part / "ledger").mkdir()
        (part / "ledger" / "calls.jsonl").write_text(part.name)
    merge_folders(tmp_path, parts)
    found = {it.name: it.read_text() for it in (tmp_path / "ledger").iterdir()}
    assert found == {f"{part.name}-calls.jsonl": part.name for part in parts}


@pytest.mark.parametrize(
    ("names", "message"),
    [
        ([], "there are no shards"),
        (["shard-1-of-2"], "shard 2/2 is missing"),
        (["shard-1-of-2", "shard-2-of-2", "shard-1-of-3"], "shards of 2 and of 3 parts"),
    ],
)
def test_incomplete_shards_are_refused(tmp_path, names, message):
    for name in names:
        (tmp_path / name).mkdir()
    with pytest.raises(ConfigurationError, match=message):
        shards_in(tmp_path)


def test_a_part_that_had_nothing_to_do_is_complete(tmp_path):
    parts = in_shards(tmp_path, 2)
    empty = tmp_path / "shard-3-of-3"
    write_provenance(empty, Provenance({}, {"git": None}, {"files": {}}, [{"started": "now"}]))
    assert merge_folders(tmp_path, [*parts, empty]).records == 24


def test_episodes_that_were_cut_short_stay_unfinished(tmp_path):
    parts = in_shards(tmp_path, 2)
    first, second = RecordFile(parts[0]).read()[:2]
    missing = {**first, "episode_id": "another"}
    RecordFile(parts[1], UNFINISHED_NAME).replace([missing, second])
    merge_folders(tmp_path, parts)
    assert [it["episode_id"] for it in RunFolder(tmp_path).unfinished] == ["another"]
