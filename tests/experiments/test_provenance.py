from __future__ import annotations

import json
import shutil
import subprocess
import time
from dataclasses import replace
from pathlib import Path

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ModelBusy, RecordError
from adhoc.experiments.provenance import code_state
from adhoc.experiments.provenance.asked_models import asked_models
from adhoc.experiments.provenance.code_state import git_state
from adhoc.experiments.provenance.file import (
    Provenance,
    merge_provenance,
    provenance_files,
    provenance_path,
    read_provenance,
    unfinished_runs,
    write_provenance,
)
from adhoc.experiments.provenance.machine import machine_facts
from adhoc.experiments.provenance.outside import outside_code, outside_files
from adhoc.experiments.provenance.private import publishable, publishable_argument, publishable_text
from adhoc.experiments.provenance.session import begin_session, end_session, provenance_of, run_session
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.model import LMRequest
from adhoc.llm.scripted import ScriptedModel

CONFIG = {
    "policy": {"name": "irot", "agent": {"_target_": "adhoc.agents.llm_agent.LLMAgent"}},
    "benchmark": {"name": "demo"},
    "llm": {"name": "offline", "max_tokens": 100},
    "budget": {"episode": {"calls": None}, "run": {"calls": None}},
    "join_step": 50,
    "out": "results",
    "workers": 1,
    "limit": None,
    "ledger": {"mode": "auto", "path": None},
}
PRINTS = {"benchmark": "b" * 64, "checkpoints of team": ""}


def changed(**changes):
    return {**CONFIG, **changes}


def run_of(config, fingerprints=PRINTS):
    return provenance_of(config, fingerprints).run


class TestId:
    @pytest.mark.parametrize(
        "changes",
        [
            {"out": "elsewhere"},
            {"workers": 7},
            {"limit": 3},
            {"shard": "2/4"},
            {"ledger": {"mode": "replay", "path": "there"}},
            {"budget": {"episode": {"calls": None}, "run": {"calls": 9}}},
        ],
    )
    def test_it_does_not_depend_on_where_and_how_much_is_run(self, changes):
        assert run_of(changed(**changes)) == run_of(CONFIG)

    @pytest.mark.parametrize(
        "changes",
        [
            {"join_step": 51},
            {"llm": {"name": "offline", "max_tokens": 101}},
            {"budget": {"episode": {"calls": 9}, "run": {"calls": None}}},
        ],
    )
    def test_it_depends_on_what_decides_an_episode(self, changes):
        assert run_of(changed(**changes)) != run_of(CONFIG)

    def test_it_depends_on_data_and_code(self):
        facts = provenance_of(CONFIG, PRINTS)
        assert run_of(CONFIG, {"benchmark": "c" * 64}) != facts.run
        for code in ({"library_version": "9"}, {"python": "3.99"}, {"packages": {"numpy": "0"}}):
            assert replace(facts, code={**facts.code, **code}).run != facts.run
        git = {"commit": "1", "branch": "main", "dirty": False, "changes_sha256": None}
        on_main = replace(facts, code={**facts.code, "git": git})
        assert replace(facts, code={**facts.code, "git": {**git, "branch": "other"}}).run == on_main.run
        assert replace(facts, code={**facts.code, "git": {**git, "commit": "2"}}).run != on_main.run


class TestFile:
    def test_it_comes_back_and_says_all(self, tmp_path):
        run = begin_session(tmp_path, CONFIG, PRINTS, ["/usr/bin/adhoc", "run", "out=results"])
        facts = read_provenance(tmp_path, run)
        assert facts.config == CONFIG
        assert list(facts.config) == list(CONFIG)
        assert facts.data["benchmark"] == "b" * 64
        assert len(facts.data["prompts"]) == 64
        assert "checkpoints of team" not in facts.data
        assert facts.code["packages"]["numpy"]
        (session,) = facts.sessions
        assert session["command"] == ["adhoc", "run", "out=results"]
        assert session["options"] == {
            "out": "results",
            "workers": 1,
            "limit": None,
            "ledger": CONFIG["ledger"],
        }
        assert session["machine"]["cpus"] >= 1
        assert session["ended"] is None

    def test_a_second_session_is_added_and_nothing_else_changes(self, tmp_path):
        run = begin_session(tmp_path, CONFIG, PRINTS)
        before = json.loads(provenance_path(tmp_path, run).read_text())
        assert begin_session(tmp_path, changed(workers=2), PRINTS) == run
        end_session(tmp_path, run)
        after = json.loads(provenance_path(tmp_path, run).read_text())
        assert [it["options"]["workers"] for it in after["sessions"]] == [1, 2]
        assert [it["ended"] is None for it in after["sessions"]] == [True, False]
        assert {**after, "sessions": before["sessions"], "sha256": before["sha256"]} == before
        assert [it.name for it in provenance_files(tmp_path)] == [f"{run}.json"]

    def test_the_name_of_the_host_may_be_taken_out(self, tmp_path):
        run = begin_session(tmp_path, CONFIG, PRINTS)
        path = provenance_path(tmp_path, run)
        facts = json.loads(path.read_text())
        del facts["sessions"][0]["machine"]["host"]
        path.write_text(json.dumps(facts))
        assert read_provenance(tmp_path, run).run == run

    def test_an_interrupted_session_has_an_end(self, tmp_path):
        with pytest.raises(KeyboardInterrupt), run_session(tmp_path, CONFIG) as run:
            raise KeyboardInterrupt
        assert read_provenance(tmp_path, run).sessions[0]["ended"] is not None

    @pytest.mark.parametrize(
        ("damage", "told"),
        [
            (lambda text: text[:-30], "cannot be read as JSON"),
            (lambda text: text.replace('"join_step": 50', '"join_step": 51'), "it was edited"),
            (lambda text: text.replace("adhoc provenance", "something"), "another file"),
            (lambda text: text.replace('"version": 1', '"version": 2'), "version: is 2"),
            (lambda text: text.replace('"sessions": [', '"session": ['), "sessions: should be a list"),
            (lambda text: text.replace('"workers": 1', '"workers": 3'), "sha256: is not that of what"),
        ],
    )
    def test_damage_is_told_and_never_written_over(self, tmp_path, damage, told):
        run = begin_session(tmp_path, CONFIG)
        path = provenance_path(tmp_path, run)
        damaged = damage(path.read_text())
        path.write_text(damaged)
        for use in (
            lambda: read_provenance(tmp_path, run),
            lambda: begin_session(tmp_path, CONFIG),
            lambda: end_session(tmp_path, run),
        ):
            with pytest.raises(RecordError, match=f"{run}.json: .*{told}"):
                use()
        assert path.read_text() == damaged

    def test_a_missing_file_is_named(self, tmp_path):
        with pytest.raises(RecordError, match=r"provenance/0123\.json: there is no such file"):
            read_provenance(tmp_path, "0123")

    def test_merging_brings_runs_and_sessions_together_once(self, tmp_path):
        first, second, whole = tmp_path / "1", tmp_path / "2", tmp_path / "all"
        run = begin_session(first, changed(shard="1/2"))
        assert begin_session(second, changed(shard="2/2")) == run
        other = begin_session(second, changed(join_step=0))
        for _ in range(2):
            merge_provenance(whole, [first, second])
            assert {path.stem for path in provenance_files(whole)} == {run, other}
            shards = [it["options"]["shard"] for it in read_provenance(whole, run).sessions]
            assert shards == ["1/2", "2/2"]

    def test_writing_the_same_again_changes_nothing(self, tmp_path):
        run = begin_session(tmp_path, CONFIG)
        before = provenance_path(tmp_path, run).read_bytes()
        write_provenance(tmp_path, read_provenance(tmp_path, run))
        assert provenance_path(tmp_path, run).read_bytes() == before


class TestPrivacy:
    KEY = "sk-proj-" + "a1b2c3d4" * 4

    def test_no_secret_and_no_home_is_written(self, tmp_path, monkeypatch):
        secrets = {
            "OPENAI_API_KEY": "plain-looking-value-77",
            "HF_TOKEN": "another1value",
            "DB_PASSWORD": "Correct Horse",
        }
        for name, value in secrets.items():
            monkeypatch.setenv(name, value)
        monkeypatch.setenv("HOME", "/home/grace")
        config = changed(
            llm={
                "api_key": "whatever it is",
                "api_base": "https://grace:hopper@models.example/v1?api_key=q1w2e3&x=1",
                "extra_headers": {"Authorization": "Bearer abcdefghijk", "x-note": secrets["HF_TOKEN"]},
                "max_tokens": 100,
                "remark": f"uses {secrets['OPENAI_API_KEY']} and {self.KEY}",
            },
            out="/home/grace/results",
        )
        command = [
            "adhoc",
            "run",
            "+llm.api_key=whatever it is",
            f"llm.remark={self.KEY}",
            "out=/home/grace/r",
        ]
        run = begin_session(tmp_path, config, command=[*command, secrets["DB_PASSWORD"]])
        text = provenance_path(tmp_path, run).read_text()
        for secret in (
            "whatever it is",
            "hopper",
            "q1w2e3",
            "abcdefghijk",
            self.KEY,
            "grace",
            *secrets.values(),
        ):
            assert secret not in text, secret
        facts = read_provenance(tmp_path, run)
        assert facts.config["llm"]["max_tokens"] == 100
        assert facts.config["llm"]["api_key"] == "[removed]"
        assert facts.config["llm"]["api_base"] == "https://[removed]@models.example/v1?api_key=[removed]&x=1"
        assert facts.config["out"] == "~/results"

    @pytest.mark.parametrize(
        ("argument", "told"),
        [
            ("+llm.api_key=abc", "+llm.api_key=[removed]"),
            ("llm.max_tokens=5", "llm.max_tokens=5"),
            ("++my.password=", "++my.password="),
            ("--token=abc", "--token=[removed]"),
            ("policy=irot", "policy=irot"),
            ("-m", "-m"),
        ],
    )
    def test_arguments_lose_the_values_of_secret_fields(self, argument, told):
        assert publishable_argument(argument) == told

    def test_only_the_home_folder_itself_is_shortened(self, monkeypatch):
        monkeypatch.setenv("HOME", "/home/ada")
        assert publishable_text("/home/ada/x and '/home/ada', /home/adam/y") == "~/x and '~', /home/adam/y"

    def test_ordinary_words_in_the_environment_stay(self, monkeypatch):
        monkeypatch.setenv("SOME_API_KEY", "not-needed")
        assert publishable({"a": "not-needed", "b": [1, 2.5, None, True]}) == {
            "a": "not-needed",
            "b": [1, 2.5, None, True],
        }

    def test_what_json_cannot_say_is_a_text(self):
        assert publishable([float("inf"), Path("a/b"), 1]) == ["inf", "a/b", 1]


class TestOutside:
    def test_files_and_folders_are_known_by_their_content(self, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        Path("houses.json").write_text("{}")
        Path("data/inner").mkdir(parents=True)
        Path("data/inner/a").write_text("a")
        config = {
            "benchmark": {"path": "houses.json", "folder": "data", "name": "houses.json"},
            "policy": {"agent": {"checkpoints": None, "list": ["data/inner/a", "no/such/file"]}},
            "out": "data",
            "ledger": {"path": "data"},
        }
        found = outside_files(config)
        assert set(found) == {"benchmark.path", "benchmark.folder", "policy.agent.list.0"}
        assert found["benchmark.path"] == {
            "path": "houses.json",
            "sha256": "44136fa355b3678a1146ad16f7e8649e94fb4fc21fe77e8310c060f61caaff8a",
            "bytes": 2,
        }
        Path("data/inner/a").rename("data/inner/b")
        assert outside_files(config)["benchmark.folder"] != found["benchmark.folder"]

    def test_an_unreadable_file_is_named(self, tmp_path, monkeypatch):
        path = tmp_path / "houses.json"
        path.write_text("{}")

        def refuse(*arguments):
            raise PermissionError(13, "Permission denied", str(path))

        monkeypatch.setattr("adhoc.experiments.provenance.outside._hash_once", refuse)
        with pytest.raises(RecordError, match=r"houses\.json: cannot be read: Permission denied"):
            outside_files({"benchmark": {"path": str(path)}})

    def test_code_from_outside_is_known_by_its_content(self, tmp_path, monkeypatch):
        (tmp_path / "my_policies.py").write_text("class Mine: ...\n")
        monkeypatch.syspath_prepend(str(tmp_path))
        config = {
            "policy": {"agent": {"_target_": "my_policies.Mine"}, "planner": {"_target_": "adhoc.x.Y"}},
            "world": {"_target_": "no_such_module_at_all.World"},
        }
        found = outside_code(config)
        assert set(found) == {"my_policies", "no_such_module_at_all"}
        assert found["no_such_module_at_all"] is None
        assert len(found["my_policies"]) == 64


class TestModels:
    def ask(self, folder, name, replies):
        model = LedgerModel(ScriptedModel(replies, name=name), folder)
        for number, reply in enumerate(replies):
            request = LMRequest((ChatMessage("user", f"{number}"),), "generate")
            if isinstance(reply, str):
                model.complete(request)
            else:
                with pytest.raises(ModelBusy):
                    model.complete(request)

    def test_models_are_told_with_their_dates(self, tmp_path):
        self.ask(tmp_path, "tiny", ["a", ModelBusy("later"), "b"])
        self.ask(tmp_path, "large", ["c"])
        found = asked_models(tmp_path)
        assert {name: it["answers"] for name, it in found.items()} == {"large": 1, "tiny": 2}
        assert found["tiny"]["reported"] == {"tiny": 2}
        assert found["tiny"]["first"] <= found["tiny"]["last"]
        assert asked_models(tmp_path, since="9999") == {}

    def test_a_session_tells_what_it_asked_and_not_what_was_asked_before(self, tmp_path):
        self.ask(tmp_path / "ledger", "before", ["a"])
        time.sleep(0.005)  # times in ledgers are of milliseconds
        with run_session(tmp_path, CONFIG) as run:
            self.ask(tmp_path / "ledger", "now", ["b", "c"])
        (session,) = read_provenance(tmp_path, run).sessions
        assert {name: it["answers"] for name, it in session["models"].items()} == {"now": 2}
        assert session["started"] <= session["models"]["now"]["first"] <= session["ended"]

    def test_nothing_was_asked_without_a_ledger(self, tmp_path):
        assert asked_models(tmp_path / "none") == {}


def git(folder, *arguments):
    settings = ("-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false")
    subprocess.run(["git", "-C", str(folder), *settings, *arguments], check=True, capture_output=True)


@pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")
class TestGit:
    @pytest.fixture
    def checkout(self, tmp_path):
        git(tmp_path, "init", "-b", "work")
        for name in ("adhoc/a.py", "docs/b.md"):
            (tmp_path / name).parent.mkdir()
            (tmp_path / name).write_text("1\n")
        git(tmp_path, "add", ".")
        git(tmp_path, "commit", "-m", "one")
        return tmp_path

    def test_a_clean_checkout(self, checkout):
        state = git_state(checkout)
        assert (state["branch"], state["dirty"], state["changes_sha256"]) == ("work", False, None)
        assert len(state["commit"]) == 40

    def test_changes_of_the_code_are_told_apart_and_others_are_none(self, checkout):
        (checkout / "docs/b.md").write_text("2\n")
        (checkout / "results").mkdir()
        (checkout / "results/episodes.jsonl").write_text("")
        assert git_state(checkout)["dirty"] is False
        seen = set()
        for change in ("2\n", "3\n", None):
            path = checkout / "adhoc/a.py"
            path.unlink() if change is None else path.write_text(change)
            state = git_state(checkout)
            assert state["dirty"]
            seen.add(state["changes_sha256"])
        (checkout / "adhoc/a.py").write_text("1\n")
        assert git_state(checkout)["dirty"] is False
        (checkout / "adhoc/new.py").write_text("x")
        seen.add(git_state(checkout)["changes_sha256"])
        assert len(seen) == 4

    def test_a_folder_inside_of_another_checkout_is_none(self, checkout):
        assert git_state(checkout / "adhoc") is None

    def test_neither_is_one_without_git(self, checkout, monkeypatch):
        monkeypatch.setenv("PATH", "")
        assert git_state(checkout) is None

    def test_a_commit_of_no_branch(self, checkout):
        git(checkout, "checkout", "--detach")
        assert git_state(checkout)["branch"] is None


def test_an_installed_package_has_no_commit(tmp_path):
    assert git_state(tmp_path) is None


def test_a_package_that_is_not_there_has_no_version(monkeypatch):
    assert code_state._version("no-such-package-at-all") is None


def test_machines_that_tell_nothing_are_no_error(monkeypatch, tmp_path):
    monkeypatch.setattr("adhoc.experiments.provenance.machine._CPU_FACTS", tmp_path / "none")
    monkeypatch.setattr("platform.processor", lambda: "")
    monkeypatch.delattr("os.sysconf")
    facts = machine_facts()
    assert facts["cpu"] is None
    assert facts["memory_bytes"] is None


def session(started, complete=None, shard="1/1"):
    known = {} if complete is None else {"complete": complete}
    return {"started": started, "options": {"shard": shard}, **known}


@pytest.mark.parametrize(
    ("sessions", "finished"),
    [
        ([session("1", False), session("2", True)], True),
        ([session("1", True), session("2", False)], False),
        ([session("1", True, "1/2"), session("2", True, "2/2")], True),
        ([session("1", False, "1/2"), session("2", True, "2/2")], False),
        ([session("1", False, "1/2"), session("2", True)], True),
        ([session("1")], True),
    ],
)
def test_a_run_is_unfinished_if_its_latest_session_is(tmp_path, sessions, finished):
    run = write_provenance(tmp_path, Provenance({}, {"git": None}, {"files": {}}, sessions))
    assert unfinished_runs(tmp_path) == ([] if finished else [run])
