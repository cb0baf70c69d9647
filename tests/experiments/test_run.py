from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from grid_world import Errand, GridWorld, Script, fetch, scenario, two_rooms

from adhoc.core.errors import ConfigurationError, EpisodesFailed, RecordError
from adhoc.core.values import Action, ActionName
from adhoc.evaluation.contender import Conditions, Contender
from adhoc.evaluation.episode_key import EpisodeKey
from adhoc.evaluation.records import RecordFile
from adhoc.experiments.comparison import Comparison, Entrant
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.run import run_comparison
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LMRequest
from adhoc.llm.scripted import ScriptedModel

HELP = fetch("apple", "counter") + fetch("knife", "counter")


class Quiet:
    """Counts what a run tells."""

    def __init__(self):
        self.told = []

    def begin(self, plan):
        self.total = plan.to_run

    def started(self, episode_id):
        self.told.append(("started", episode_id))

    def finished(self, record):
        self.told.append(("finished", record["episode_id"]))

    def failed(self, failure):
        self.told.append(("failed", failure.episode_id))


TEAM = Contender("walkers", "Walkers", lambda seat: Script(), {"name": "walkers"})
HELPER = Contender("helper", "Helper", lambda seat: Script(*HELP), {"name": "helper"})
IDLER = Contender("idler", "Idler", lambda seat: Script(Action(ActionName.STOP)), {"name": "idler"})
SCENARIOS = [scenario(), scenario(id="two_rooms-s1", seed=1)]


def conditions(**changes):
    return Conditions(
        Errand(), **{"team": TEAM, "max_steps": 30, "settings": {"world": {"size": 1}}, **changes}
    )


def run(folder, newcomer=HELPER, join_step=5, world=None, scenarios=SCENARIOS, tolerance=None, **changes):
    progress = Quiet()
    entrants = () if newcomer is None else (Entrant(newcomer, join_step),)
    comparison = Comparison(world or GridWorld(), scenarios, conditions(**changes), entrants)
    return run_comparison(comparison, RunFolder(folder, tolerance), progress), progress


def test_every_scenario_is_run_alone_and_with_the_newcomer(tmp_path):
    summary, _ = run(tmp_path)
    records = RecordFile(tmp_path).read()
    assert (summary.run, summary.recorded) == (4, 0)
    assert [it["episode_id"] for it in records] == [
        "two_rooms-s0--walkers--alone",
        "two_rooms-s0--walkers--helper--t5",
        "two_rooms-s1--walkers--alone",
        "two_rooms-s1--walkers--helper--t5",
    ]
    alone, joined = records[:2]
    assert (alone["policy"], alone["join_step"], alone["success"]) == ("none", None, False)
    assert (joined["policy"], joined["join_step"], joined["success"]) == ("helper", 5, True)
    assert joined["temporal_steps"] == 9
    assert joined["action_steps"] == 9 + 9 + 4
    assert joined["reference_temporal_steps"] == 30
    assert joined["efficiency"] == pytest.approx(21 / 30)
    assert joined["history_hash"] == alone["history"][5 * 16 : 6 * 16]
    assert (joined["rooms"], joined["difficulty"], joined["teammates"]) == (2, "Easy", 2)


def test_the_same_command_again_runs_nothing(tmp_path):
    run(tmp_path)
    before = (tmp_path / "episodes.jsonl").read_bytes()
    summary, progress = run(tmp_path)
    assert (summary.run, summary.recorded) == (0, 4)
    assert progress.told == []
    assert (tmp_path / "episodes.jsonl").read_bytes() == before


def test_the_team_alone_is_shared_by_policies_and_joining_steps(tmp_path):
    run(tmp_path)
    summary, _ = run(tmp_path, newcomer=IDLER, join_step=7)
    assert (summary.run, summary.recorded) == (2, 2)
    summary, _ = run(tmp_path, newcomer=None)
    assert (summary.run, summary.recorded) == (0, 2)


def test_a_killed_run_goes_on_where_it_stopped(tmp_path):
    run(tmp_path)
    path = tmp_path / "episodes.jsonl"
    whole = [{**it, "wall_s": 0} for it in RecordFile(tmp_path).read()]
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:2]) + lines[2][:100])
    with pytest.warns(UserWarning, match="incomplete last record"):
        summary, _ = run(tmp_path)
    assert (summary.run, summary.recorded) == (2, 2)
    assert [{**it, "wall_s": 0} for it in RecordFile(tmp_path).read()] == whole


def test_another_configuration_is_refused_and_the_difference_named(tmp_path):
    run(tmp_path)
    with pytest.raises(RecordError, match="max_steps: 30 there, 40 here"):
        run(tmp_path, max_steps=40)
    with pytest.raises(RecordError, match=r"world\.size: 1 there, 2 here"):
        run(tmp_path, settings={"world": {"size": 2}})
    with pytest.raises(RecordError, match=r"policy\.name: 'helper' there, 'other' here"):
        run(tmp_path, newcomer=replace(HELPER, settings={"name": "other"}))


def test_another_scenario_of_the_same_name_is_refused(tmp_path):
    run(tmp_path)
    house = two_rooms()
    moved = replace(house, objects=(replace(house.objects[0], position=(2.0, 0.4, 0.4)), *house.objects[1:]))
    with pytest.raises(RecordError, match="another version of scenario 'two_rooms-s0'"):
        run(tmp_path, scenarios=[scenario(house=moved)])


def test_a_disturbed_past_is_reported_and_not_recorded(tmp_path):
    with pytest.raises(EpisodesFailed, match=r"two_rooms-s.*EpisodeError"):
        run(tmp_path, world=GridWorld(disturb_step=3))
    assert len(RecordFile(tmp_path).read()) == 1


def test_a_disturbed_past_is_reported_against_an_old_record(tmp_path):
    run(tmp_path, newcomer=None)
    world = GridWorld(disturb_step=3)
    world.resets = 1
    with pytest.raises(EpisodesFailed, match="at step 3"):
        run(tmp_path, world=world)


def test_a_late_newcomer_is_recorded_as_never_joined(tmp_path):
    quitters = replace(TEAM, make=lambda seat: Script(Action(ActionName.STOP)))
    run(tmp_path, team=quitters)
    joined = RecordFile(tmp_path).read()[1]
    assert not joined["joined"]
    assert joined["action_steps"] == 60


def test_model_calls_are_counted_per_episode(tmp_path):
    model = CountingModel(ScriptedModel(["yes indeed"] * 20, name="tiny model"))

    class Chatty(Script):
        def act(self, observation, inbox):
            if observation.step in (5, 6):
                model.complete(LMRequest((), "generate"))
            return super().act(observation, inbox)

    chatty = Contender("chatty", "Chatty", lambda seat: Chatty(), {"name": "chatty"}, model)
    run(tmp_path, newcomer=chatty)
    alone, joined = RecordFile(tmp_path).read()[:2]
    assert (alone["model"], alone["llm"]["calls"]) == (None, 0)
    assert (joined["model"], joined["llm"]["calls"], joined["llm"]["completion_tokens"]) == (
        "tiny model",
        2,
        4,
    )
    assert joined["episode_id"] == "two_rooms-s0--walkers--chatty-tiny-model--t5"
    assert RecordFile(tmp_path).read()[3]["llm"]["calls"] == 2


@pytest.mark.parametrize("scenarios", [[], [scenario(), scenario()]])
def test_impossible_lists_of_scenarios_are_refused(tmp_path, scenarios):
    with pytest.raises(ConfigurationError):
        run(tmp_path, scenarios=scenarios)


def stripped(folder: Path) -> list[dict]:
    lines = (folder / "episodes.jsonl").read_text().splitlines()
    return [{name: value for name, value in json.loads(it).items() if name != "wall_s"} for it in lines]


def test_records_are_equal_in_one_process_and_in_two(tmp_path):
    run(tmp_path / "first")
    run(tmp_path / "second")
    script = (
        f"import sys; sys.path[:0] = {[path for path in sys.path if 'tests' in path]!r}; "
        f"from pathlib import Path; import test_run; test_run.run(Path({str(tmp_path / 'third')!r}))"
    )
    subprocess.run([sys.executable, "-c", script], check=True, timeout=100)
    assert stripped(tmp_path / "first") == stripped(tmp_path / "second") == stripped(tmp_path / "third")


def test_another_folder_of_the_house_file_changes_nothing():
    house = replace(two_rooms(), source="elsewhere")
    assert scenario(house=house).content_hash() == scenario().content_hash()
    assert scenario(seed=3).content_hash() != scenario().content_hash()


def test_settings_that_were_cut_short_are_written_again(tmp_path):
    run(tmp_path, newcomer=None)
    (path,) = (tmp_path / "settings").iterdir()
    whole = path.read_bytes()
    path.write_bytes(b"")
    (tmp_path / "episodes.jsonl").unlink()
    run(tmp_path, newcomer=None)
    assert path.read_bytes() == whole


def test_an_episode_is_never_stored_twice(tmp_path):
    comparison = Comparison(GridWorld(), SCENARIOS[:1], conditions())
    folder = RunFolder(tmp_path)
    run_comparison(comparison, folder)
    key = EpisodeKey(SCENARIOS[0], comparison.kinds[0])
    with pytest.raises(RecordError, match="is there already"):
        folder.add(key, folder.records[0])
    assert len(RecordFile(tmp_path).read()) == 1
