"""Episodes and runs that end because a budget is reached."""

from __future__ import annotations

import pytest
from grid_world import Script
from test_run import HELP, HELPER, run

from adhoc.core.errors import BudgetReached
from adhoc.evaluation.contender import Contender
from adhoc.evaluation.records import RecordFile, checked_part
from adhoc.llm.budget import Caps, EpisodeCapModel, RunCapModel, Spent
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LMRequest
from adhoc.llm.scripted import ScriptedModel


def chatty(capped):
    """A helper that asks a model in every step."""
    model = CountingModel(capped)

    class Chatty(Script):
        def act(self, observation, inbox):
            model.complete(LMRequest((), "generate", max_tokens=1))
            return super().act(observation, inbox)

    return Contender("chatty", "Chatty", lambda seat: Chatty(*HELP), {"name": "chatty"}, model)


def script():
    return ScriptedModel(["yes"] * 500, name="tiny")


def unfinished(folder):
    return RecordFile(folder, "unfinished.jsonl").read()


def test_an_episode_fails_at_its_cap_and_the_run_goes_on(tmp_path):
    run(tmp_path, newcomer=chatty(EpisodeCapModel(script(), Caps(calls=3))))
    records = RecordFile(tmp_path).read()
    assert [record["ending"] for record in records[1::2]] == ["budget reached"] * 2
    for record in records[1::2]:
        assert record["reached_cap"] == "budget.episode.calls"
        assert (record["steps"], record["llm"]["calls"]) == (5 + 3, 3)
        assert (record["success"], record["temporal_steps"], record["efficiency"]) == (False, 30, 0.0)
        assert record["agent_steps"]["newcomer"] == 3
    assert all(record["reached_cap"] is None for record in records[::2])
    assert not unfinished(tmp_path)


def test_a_cap_in_the_first_step_after_joining_is_an_episode_too(tmp_path):
    run(tmp_path, newcomer=chatty(EpisodeCapModel(script(), Caps(calls=0))))
    record = RecordFile(tmp_path).read()[1]
    assert (record["steps"], record["joined"], record["llm"]["calls"]) == (5, True, 0)


def test_a_team_at_its_cap_ends_both_episodes_in_the_same_step(tmp_path):
    team = chatty(EpisodeCapModel(script(), Caps(calls=7)))
    run(tmp_path, team=team, newcomer=HELPER)
    alone, joined = RecordFile(tmp_path).read()[:2]
    assert [alone["ending"], joined["ending"]] == ["budget reached"] * 2
    assert (alone["steps"], joined["steps"], joined["joined"]) == (3, 3, False)
    assert alone["llm"] == joined["llm"]


def test_the_run_stops_at_its_cap_and_a_richer_one_goes_on(tmp_path):
    with pytest.raises(BudgetReached, match=r"budget\.run\.calls=3"):
        run(tmp_path, newcomer=chatty(RunCapModel(script(), Caps(calls=3))))
    assert [record["policy"] for record in RecordFile(tmp_path).read()] == ["none"]
    (cut,) = unfinished(tmp_path)
    assert (cut["ending"], cut["reached_cap"]) == ("budget reached", "budget.run.calls")
    assert (cut["steps"], cut["llm"]["calls"]) == (8, 3)

    with pytest.raises(BudgetReached, match="3 spent"):
        run(tmp_path, newcomer=chatty(RunCapModel(script(), Caps(calls=3), spent=Spent(calls=3))))
    assert [cut["steps"] for cut in unfinished(tmp_path)] == [5]

    run(tmp_path, newcomer=chatty(RunCapModel(script(), Caps(calls=300), spent=Spent(calls=3))))
    run(tmp_path / "free", newcomer=chatty(script()))
    capped, free = (RecordFile(folder).read() for folder in (tmp_path, tmp_path / "free"))
    assert [checked_part(record) for record in capped] == [checked_part(record) for record in free]
    assert not (tmp_path / "unfinished.jsonl").exists()


def test_an_episode_that_was_finished_is_not_unfinished_whatever_the_file_says(tmp_path):
    """As after a kill between the two writes."""
    with pytest.raises(BudgetReached):
        run(tmp_path, newcomer=chatty(RunCapModel(script(), Caps(calls=3))))
    before = (tmp_path / "unfinished.jsonl").read_bytes()
    run(tmp_path, newcomer=chatty(script()))
    (tmp_path / "unfinished.jsonl").write_bytes(before)
    capped = chatty(RunCapModel(script(), Caps(calls=3)))
    with pytest.raises(BudgetReached):
        run(tmp_path, newcomer=capped, join_step=7)
    assert [record["episode_id"] for record in unfinished(tmp_path)] == [
        "two_rooms-s0--walkers--chatty-tiny--t7"
    ]


def test_replacing_all_records_by_none_removes_the_file(tmp_path):
    file = RecordFile(tmp_path, "unfinished.jsonl")
    run(tmp_path / "some")
    records = RecordFile(tmp_path / "some").read()
    file.replace(records)
    assert file.read() == records
    file.replace(records[1:2])
    assert file.read() == records[1:2]
    file.replace([])
    assert not file.path.exists()
    file.replace([])


def test_the_checksum_does_not_depend_on_what_was_replayed(tmp_path):
    run(tmp_path, newcomer=chatty(script()))
    record = RecordFile(tmp_path).read()[1]
    replayed = {**record, "wall_s": 99.0, "llm": {**record["llm"], "replayed": 7}}
    assert checked_part(replayed) == checked_part(record)
    file = RecordFile(tmp_path / "again")
    file.append(replayed)
    assert file.read()[0]["llm"]["replayed"] == 7
    assert checked_part({**record, "llm": {**record["llm"], "calls": 1}}) != checked_part(record)
