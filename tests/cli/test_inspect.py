"""`adhoc inspect`: from the folder of a run to a page, without asking anybody."""

from __future__ import annotations

import base64
import json
import re
import shutil
import zlib
from pathlib import Path

import pytest
from paid_model import PaidReasoner

from adhoc.cli.main import main
from adhoc.evaluation.records import RecordFile

ALONE, JOINED = "one_room-s1--heuristic--alone", "one_room-s1--heuristic--irot-paid--t3"
DRAWS = "benchmark.draws=[{house: one_room, seed: 1, misplaced: 2, teammates: 2}]"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder of a run whose model was paid."""
    folder = tmp_path_factory.mktemp("paid") / "out"
    options = ["policy=irot", "join_step=3", "max_steps=25", "pictures=false", "transcript=false"]
    model = ["llm._target_=paid_model.PaidReasoner", "+llm.price={prompt: 10, completion: 30}"]
    assert main(["run", *options, DRAWS, *model, f"out={folder}"]) == 0
    return folder


def embedded(page: Path):
    (packed,) = re.findall(r'type="text/plain">([^<]*)<', page.read_text(encoding="utf-8"))
    return json.loads(zlib.decompress(base64.b64decode(packed)))


def test_the_newcomers_episode_is_shown_beside_the_team_alone_and_nobody_is_asked(run, capsys, monkeypatch):
    monkeypatch.setattr(PaidReasoner, "complete", None)
    assert main(["inspect", "--trust", str(run), JOINED]) == 0
    page = run / "inspect" / f"{JOINED}.html"
    assert f"written: {page}" in capsys.readouterr().out
    data = embedded(page)
    assert [episode["record"]["episode_id"] for episode in data["episodes"]] == [ALONE, JOINED]
    assert data["commonPast"][0][1] == 3
    joined = data["episodes"][1]
    assert joined["record"]["model"] == "paid"
    assert joined["llm"]["cost_usd"] > 0
    (first, *_) = (trace for _, _, _, trace in joined["decisions"] if "decision" in trace)
    (asked, *_) = first["decision"]["exchanges"]
    assert asked["model"] == "paid"
    assert asked["cost_usd"] > 0
    assert asked["prompt_tokens"] > 100
    assert joined["pictures"]
    assert all(robot["floor"] for robot in joined["robots"])


def test_a_folder_that_was_sent_elsewhere_is_read_there(run, tmp_path):
    elsewhere = tmp_path / "sent"
    shutil.copytree(run, elsewhere, ignore=shutil.ignore_patterns("inspect"))
    page = tmp_path / "page.html"
    assert main(["inspect", "--trust", str(elsewhere), ALONE, "--out", str(page)]) == 0
    assert len(embedded(page)["episodes"]) == 1
    assert not (elsewhere / "inspect").exists()


def test_episodes_are_listed_without_a_name(run, capsys):
    assert main(["inspect", "--trust", str(run)]) == 0
    out = capsys.readouterr().out
    assert ALONE in out
    assert JOINED in out


def test_pictures_and_a_film_are_drawn(run, tmp_path):
    options = ["--pictures", str(tmp_path), "--film", str(tmp_path / "film.gif"), "--beside", JOINED]
    assert main(["inspect", "--trust", str(run), ALONE, "--out", str(tmp_path / "page.html"), *options]) == 0
    assert {path.suffix for path in tmp_path.iterdir()} == {".html", ".png", ".svg", ".gif"}
    first = embedded(tmp_path / "page.html")["episodes"][0]
    assert first["record"]["episode_id"] == JOINED


class TestBadInput:
    def refused(self, capsys, *arguments: object) -> str:
        assert main(["inspect", "--trust", *map(str, arguments)]) == 2
        (line,) = [it for it in capsys.readouterr().err.splitlines() if it.startswith("adhoc inspect: error")]
        return line

    def test_an_unknown_episode_with_near_ones(self, run, capsys):
        told = self.refused(capsys, run, JOINED.replace("t3", "t4"))
        assert f"no episode {JOINED.replace('t3', 't4')!r} among 2" in told
        assert JOINED in told

    def test_a_folder_without_records(self, tmp_path, capsys):
        assert "there are no records" in self.refused(capsys, tmp_path, ALONE)

    def test_records_of_an_earlier_version(self, run, tmp_path, capsys):
        self._changed(run, tmp_path, run=None)
        assert "field 'run' is None" in self.refused(capsys, tmp_path, JOINED)

    def test_a_record_that_is_not_what_comes_out(self, run, tmp_path, capsys):
        self._changed(run, tmp_path, history_hash="0" * 16)
        told = self.refused(capsys, tmp_path, JOINED)
        assert "run again, it is another episode: history_hash was 0000000000000000, is " in told

    def test_no_provenance(self, run, tmp_path, capsys):
        self._changed(run, tmp_path)
        shutil.rmtree(tmp_path / "provenance")
        assert "there is no such file" in self.refused(capsys, tmp_path, JOINED)

    def test_no_ledger(self, run, tmp_path, capsys):
        self._changed(run, tmp_path)
        shutil.rmtree(tmp_path / "ledger")
        assert str(tmp_path / "ledger") in self.refused(capsys, tmp_path, JOINED)

    @pytest.mark.parametrize(
        ("option", "told"),
        [("--film=a.avi", r"--film a\.avi: must end with"), ("--rrd=a.txt", r"--rrd a\.txt: must end with")],
    )
    def test_files_of_another_kind_before_anything_is_run(self, option, told, capsys):
        assert re.search(told, self.refused(capsys, "nowhere", ALONE, option))

    def _changed(self, source: Path, folder: Path, **changes: object) -> None:
        shutil.copytree(source, folder, dirs_exist_ok=True)
        file = RecordFile(folder)
        file.replace([{**record, **changes} for record in file.read()])
