"""`adhoc verify` against planted faults, in folders that `adhoc run` made in the smallest world."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from adhoc.cli.main import main
from adhoc.cli.verify_plan import scenarios_wanted
from adhoc.evaluation.metrics import efficiency
from adhoc.evaluation.records import RecordFile
from adhoc.experiments.failures import Failure, FailureFile
from adhoc.experiments.provenance.file import provenance_files, read_provenance, write_provenance
from adhoc.experiments.provenance.session import provenance_of
from adhoc.houses.samples import sample_path

FAKES = str(Path(__file__).parents[1] / "evaluation")
DRAW = "{house: one_room, seed: %d, misplaced: 1, teammates: 3}"


@pytest.fixture(autouse=True)
def _fakes(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(FAKES)
    monkeypatch.chdir(tmp_path)


def adhoc(*arguments):
    return main(list(arguments))


DEMO = f"benchmark.draws=[{DRAW % 1}, {DRAW % 2}]"


def run(out, *arguments, benchmark=(DEMO,)):
    code = adhoc(
        "run",
        "world._target_=grid_world.GridWorld",
        "team.agent._target_=grid_world.Script",
        "policy=random",
        "policy.agent._target_=grid_world.Script",
        *benchmark,
        "max_steps=20",
        "pictures=false",
        f"out={out}",
        *arguments,
    )
    assert code == 0


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with 6 records: 2 tasks, the team alone and with a newcomer at step 0 and 5."""
    folder = tmp_path_factory.mktemp("made")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(FAKES)
        patch.chdir(folder)
        run("results", "-m", "join_step=0,5")
        run("longer", "-m", "join_step=0,5", "max_steps=25")
        adhoc("report", "results", "--markdown", "results/table.md")
    return folder


@pytest.fixture
def results(made, tmp_path):
    for name in ("results", "longer"):
        shutil.copytree(made / name, tmp_path / name)
    return Path("results")


@pytest.fixture
def verify(capsys):
    def verified(*arguments):
        capsys.readouterr()
        code = adhoc("verify", "--trust", *map(str, arguments))
        lines = capsys.readouterr().out.splitlines()
        assert code == (0 if lines[-1].endswith("no faults") or "run again" in lines[-1] else 1) or code == 1
        return code, lines

    return verified


def edit(folder, line, **changes):
    """Change fields of a record, and give it the checksum of what it then says."""
    file = RecordFile(folder)
    records = [dict(it) for it in file.read()]
    records[line - 1].update(changes)
    file.replace(records)


def place(folder, **fields):
    """The line of the first record with these fields."""
    for line, record in enumerate(RecordFile(folder).read(), start=1):
        if all(record[name] == value for name, value in fields.items()):
            return line
    raise AssertionError(fields)


def test_a_whole_folder_has_no_faults(results, verify):
    code, lines = verify(results, "longer")
    assert code == 0
    assert lines == [
        "results: 6 records of 2 runs checked, no faults",
        "longer: 6 records of 2 runs checked, no faults",
    ]


def test_every_flipped_byte_but_those_of_the_clock_is_found(results, verify):
    path = results / "episodes.jsonl"
    whole = path.read_bytes()
    for position in range(7, len(whole), 1511):
        damaged = bytearray(whole)
        damaged[position] ^= 1
        path.write_bytes(bytes(damaged))
        line = whole[:position].count(b"\n") + 1
        code, lines = verify(results)
        assert code == 1
        assert any(it.startswith(f"results/episodes.jsonl, line {line}") for it in lines), lines
        assert any("planned episodes are missing" in it for it in lines), lines


def test_damage_in_one_line_hides_no_damage_in_another(results, verify):
    path = results / "episodes.jsonl"
    lines = path.read_bytes().split(b"\n")
    lines[1] = lines[1].replace(b'"rooms":1', b'"rooms":2')
    lines[4] = b"{}"
    path.write_bytes(b"\n".join(lines))
    found = verify(results)[1]
    assert any("line 2: the checksum ('crc') does not fit" in it for it in found)
    assert any("line 5: not an episode record" in it for it in found)


def test_a_torn_last_line_is_named(results, verify):
    path = results / "episodes.jsonl"
    path.write_bytes(path.read_bytes()[:-9])
    code, lines = verify(results)
    assert code == 1
    assert "results/episodes.jsonl, line 6: the last line is incomplete" in lines


@pytest.mark.parametrize("who", ["alone", "joined"])
@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("success", True),
        ("replaced", 1),
        ("misplaced", 2),
        ("partial_success", 0.5),
        ("ending", "all misplaced objects re-placed"),
        ("ending", "budget reached"),
        ("steps", 19),
        ("steps", 21),
        ("temporal_steps", 19),
        ("action_steps", 59),
        ("max_steps", 21),
        ("failed_share", "full"),
        ("reference_temporal_steps", 19),
        ("efficiency", 0.25),
        ("agent_steps", {"teammate_1": 20}),
        ("agent_steps", {"teammate_1": 20, "teammate_2": 20, "teammate_3": 21}),
        ("joined", None),
        ("join_step", 7),
        ("history_hash", "0" * 16),
        ("history", "0" * 16 * 21),
        ("difficulty", "Difficult"),
        ("rooms", 2),
        ("seed", 99),
        ("house_id", "four_rooms"),
        ("task_id", "one_room-s3"),
        ("scenario_hash", "0" * 16),
        ("config_hash", "0" * 16),
        ("policy", "heuristic"),
        ("policy_label", "IRoT-LLM"),
        ("team", "llm"),
        ("team_label", "LLM based"),
        ("model", "gpt-4"),
        ("library_version", "9.9"),
        ("episode_id", "one_room-s7--heuristic--alone"),
        ("run", "0" * 16),
        ("run", None),
        ("first_help", 90),
        ("newcomer", 3),
        ("teammates", 4),
        ("llm", {"calls": 3}),
        ("steps", "20"),
        ("agent_steps", None),
    ],
)
def test_an_edited_number_is_found_though_its_checksum_is_right(results, verify, field, value, who):
    line = place(results, join_step=None) if who == "alone" else place(results, join_step=5)
    if RecordFile(results).read()[line - 1][field] == value:
        pytest.skip("it has this value")
    edit(results, line, **{field: value})
    code, lines = verify(results)
    assert code == 1
    assert any(it.startswith(f"results/episodes.jsonl, line {line}: ") for it in lines), lines
    assert any(f"{field}" in it for it in lines), lines


def test_a_success_with_a_wrong_efficiency_is_found(results, verify):
    """What only the record of the team alone decides, in a record that is consistent by itself."""
    line = place(results, join_step=5)
    robots = {"teammate_1": 15, "teammate_2": 15, "teammate_3": 15, "newcomer": 10}
    wrong = {
        "success": True,
        "replaced": 1,
        "partial_success": 1.0,
        "ending": "all misplaced objects re-placed",
        "steps": 15,
        "temporal_steps": 15,
        "agent_steps": robots,
        "action_steps": 55,
    }
    edit(results, line, **wrong, efficiency=0.3)
    (fault,) = [it for it in verify(results)[1] if "efficiency" in it]
    assert f"line {line}: efficiency: is 0.3; with the temporal_steps of the team alone" in fault
    edit(results, line, efficiency=efficiency(20, 15, True))
    assert not any("efficiency" in it for it in verify(results)[1])


def test_a_consistent_forgery_is_found_by_running_it_again(results, verify):
    edit(results, place(results, join_step=5), messages=123)
    assert verify(results, "--replay", 5)[0] in (0, 1)
    code, lines = verify(results, "--replay", 6)
    assert code == 1
    assert any("messages: is 123; run again it is" in it for it in lines)
    assert lines[-1] == "results: 5 of 6 episodes that were run again have the same records"


def test_a_deleted_record_is_missing(results, verify):
    file = RecordFile(results)
    records = file.read()
    gone = records[place(results, join_step=5) - 1]
    file.replace([it for it in records if it is not gone])
    code, lines = verify(results)
    assert code == 1
    assert any(f"1 of 4 planned episodes are missing: {gone['episode_id']}" in it for it in lines), lines


def test_a_deleted_team_alone_leaves_nothing_to_compare_with(results, verify):
    file = RecordFile(results)
    file.replace([it for it in file.read() if it["join_step"] is not None or it["task_id"] != "one_room-s1"])
    lines = verify(results)[1]
    assert sum("no intact record of the same team alone" in it for it in lines) == 2
    assert any("planned episodes are missing: one_room-s1--heuristic--alone" in it for it in lines)


def test_swapped_records_of_two_folders_are_found(results, verify):
    mine, others = RecordFile(results), RecordFile("longer")
    ours, theirs = list(mine.read()), list(others.read())
    line = place(results, join_step=5, task_id="one_room-s1")
    other = place("longer", join_step=5, task_id="one_room-s1")
    ours[line - 1], theirs[other - 1] = theirs[other - 1], ours[line - 1]
    mine.replace(ours)
    others.replace(theirs)
    for folder, at in (("results", line), ("longer", other)):
        code, lines = verify(folder)
        assert code == 1
        assert any(it.startswith(f"{folder}/episodes.jsonl, line {at}: run: ") for it in lines), lines
        assert any(it.startswith(f"{folder}/settings/") for it in lines), lines


def test_a_record_of_another_configuration_is_found_though_its_run_was_edited(results, verify):
    line = place("longer", join_step=None)
    foreign = dict(RecordFile("longer").read()[line - 1])
    shutil.copytree("longer/settings", "results/settings", dirs_exist_ok=True)
    file = RecordFile(results)
    records = list(file.read())
    at = place(results, join_step=None, task_id=foreign["task_id"])
    records[at - 1] = {**foreign, "run": records[at - 1]["run"]}
    file.replace(records)
    lines = verify(results)[1]
    assert any(f"line {at}: config_hash: is" in it and "by the configuration of run" in it for it in lines), (
        lines
    )


def test_edited_settings_are_found(results, verify):
    path = next((results / "settings").iterdir())
    path.write_text(path.read_text().replace('"max_steps": 20', '"max_steps": 21'))
    code, lines = verify(results)
    assert code == 1
    assert any(f"settings/{path.name}: its content has the hash" in it for it in lines)
    path.unlink()
    assert any(f"settings/{path.name}: there is no such file" in it for it in verify(results)[1])


@pytest.mark.parametrize(
    ("there", "edited", "told"),
    [
        ('"max_steps": 20', '"max_steps": 21', "run: what it says has the hash"),
        ('"limit": null', '"limit": 1', "sha256: is not that of what it says"),
    ],
)
def test_edited_provenance_is_found(results, verify, there, edited, told):
    path = provenance_files(results)[0]
    text = path.read_text()
    assert there in text
    path.write_text(text.replace(there, edited))
    code, lines = verify(results)
    assert code == 1
    assert any(f"provenance/{path.name}: {told}" in it for it in lines)


def test_records_without_provenance_are_named_in_one_line(results, verify):
    shutil.rmtree(results / "provenance")
    file = RecordFile(results)
    file.replace([{name: value for name, value in it.items() if name != "run"} for it in file.read()])
    code, lines = verify(results)
    assert code == 1
    assert len(lines) == 2
    assert "run: 6 records do not say which run they are of" in lines[0]


def test_an_edited_table_is_found(results, verify):
    path = results / "table.md"
    path.write_text(path.read_text().replace("20.0", "19.0", 1))
    code, lines = verify(results)
    assert code == 1
    assert any(it.startswith("results/table.md, line ") and "from the records" in it for it in lines), lines


def test_a_limited_run_is_whole_and_its_continuation_is_not_before_it_ends(tmp_path, verify):
    run("few", "limit=1")
    assert verify("few")[0] == 0
    (path,) = provenance_files("few")
    facts = read_provenance("few", path.stem)
    more = {**facts.sessions[0], "options": {"limit": None, "shard": "1/1"}}
    write_provenance("few", replace(facts, sessions=[more]))
    lines = verify("few")[1]
    assert any("2 of 4 planned episodes are missing" in it for it in lines), lines
    run("few")
    assert verify("few")[0] == 0


def test_failed_episodes_are_told_and_not_missed_twice(results, verify):
    file = RecordFile(results)
    *kept, gone = file.read()
    file.replace(kept)
    told = (gone["episode_id"], gone["task_id"], gone["team"], gone["policy"], gone["join_step"])
    FailureFile(results).add(Failure(*told, "ValueError", "no good", "trace", "0"))
    code, lines = verify(results)
    assert code == 1
    assert (
        f"results/failures.jsonl, line 1: episode {gone['episode_id']} failed: ValueError: no good" in lines
    )
    assert not any("missing" in it for it in lines)


def test_a_damaged_ledger_is_named(results, verify):
    (results / "ledger").mkdir()
    (results / "ledger/a.jsonl").write_text("something\n")
    code, lines = verify(results)
    assert code == 1
    assert any(it.startswith("results/ledger: ") and "a.jsonl" in it for it in lines), lines


def test_a_folder_without_records_is_an_error(tmp_path, capsys):
    assert adhoc("verify", str(tmp_path)) == 2
    assert "no episode records" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [("--replay", "-1"), ("--file", "houses.json")])
def test_wrong_options_are_errors(results, arguments, capsys):
    assert adhoc("verify", "--trust", "results", *arguments) == 2
    assert arguments[0] in capsys.readouterr().err


class TestElsewhere:
    """A folder that was packed, sent and unpacked."""

    def unpacked(self, folder, there):
        shutil.make_archive(str(there / "sent"), "zip", folder.parent, folder.name)
        shutil.rmtree(folder)
        shutil.unpack_archive(there / "sent.zip", there)
        return there / folder.name

    def test_it_is_verified_and_replayed(self, results, tmp_path_factory, verify, monkeypatch):
        there = tmp_path_factory.mktemp("elsewhere")
        folder = self.unpacked(results, there)
        monkeypatch.chdir(there)
        code, lines = verify("results", "--replay", 6)
        assert code == 0
        assert lines[-1] == "results: 6 of 6 episodes that were run again have the same records"
        texts = [path.read_text() for path in folder.rglob("*.json")]
        assert not any(str(Path(FAKES).parents[1]) in text for text in texts)

    def test_what_is_needed_from_outside_is_named_with_its_checksum(
        self, tmp_path, tmp_path_factory, verify, monkeypatch
    ):
        shutil.copy(sample_path("one_room"), "my_house.json")
        house = ("benchmark=house", "benchmark.path=my_house.json", "benchmark.count=1")
        run("results", benchmark=house)
        run_id = provenance_files("results")[0].stem
        digest = read_provenance("results", run_id).data["files"]["benchmark.path"]["sha256"]
        there = tmp_path_factory.mktemp("elsewhere")
        self.unpacked(Path("results"), there)
        moved = there / "houses" / "my_house.json"
        moved.parent.mkdir()
        shutil.move("my_house.json", moved)
        monkeypatch.chdir(there)
        code, lines = verify("results", "--replay", 1)
        assert code == 1
        assert (
            f"benchmark.path: my_house.json is not here; the run needs my_house.json with SHA-256 {digest}"
            in (lines[0])
        )
        assert "cannot be replayed" in lines[-2]
        code, lines = verify("results", "--replay", 2, "--file", "benchmark.path=houses/my_house.json")
        assert code == 0, lines
        moved.write_text(moved.read_text() + " ")
        code, lines = verify("results", "--file", "benchmark.path=houses/my_house.json")
        assert code == 1
        assert "houses/my_house.json has SHA-256" in lines[0]


def test_parts_are_judged_when_they_are_merged(tmp_path, verify):
    for part in ("1/2", "2/2"):
        run("parts", f"shard={part}")
    code, lines = verify("parts/shard-1-of-2")
    assert code == 0
    assert "note: provenance/" in lines[0]
    assert adhoc("merge", "parts") == 0
    code, lines = verify("parts")
    assert code == 0, lines
    file = RecordFile("parts")
    file.replace([it for it in file.read() if it["join_step"] is None])
    assert any("2 of 4 planned episodes are missing" in it for it in verify("parts")[1])


@pytest.mark.parametrize(
    ("sessions", "wanted"),
    [
        ([(None, "1/1")], 30),
        ([(5, "1/1")], 5),
        ([(5, "1/1"), (7, "1/1")], 7),
        ([(5, "1/1"), (None, "1/1")], 30),
        ([(None, "1/2")], 0),
        ([(None, "1/2"), (None, "2/2")], 30),
        ([(None, "1/2"), (None, "2/3")], 0),
        ([(4, "2/2"), (4, "1/2"), (None, "3/3")], 4),
        ([(None, None)], 30),
        ([], 0),
    ],
)
def test_how_many_scenarios_sessions_were_to_run(sessions, wanted):
    told = [{"options": {"limit": limit, "shard": shard}} for limit, shard in sessions]
    assert scenarios_wanted(told, 30) == wanted


def test_a_run_that_cannot_be_planned_again_is_named(results, verify):
    """As one of an earlier release, whose configuration lacks what this one asks for."""
    run = write_provenance(results, provenance_of({"policy": {"name": "none"}}))
    code, lines = verify(results)
    assert code == 1
    (fault,) = [line for line in lines if run in line and "states of the code" not in line]
    assert fault.startswith(f"results/provenance/{run}.json: config: the run cannot be planned again here: ")
