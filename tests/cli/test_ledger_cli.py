from __future__ import annotations

from pathlib import Path

import pytest

from adhoc.cli.main import main
from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ModelBusy, ReplyError
from adhoc.llm.ledger.reader import ledger_files
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.model import LMRequest
from adhoc.llm.scripted import ScriptedModel


def adhoc(*arguments: str) -> int:
    return main(list(arguments))


def asked(text: str, stage: str = "generate") -> LMRequest:
    return LMRequest((ChatMessage("user", f"[bold]{text}[/]"),), stage, agent="r1", episode="e1")


@pytest.fixture
def ledger(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    model = LedgerModel(
        ScriptedModel(["yes [red]indeed[/]", ReplyError("cut", "truncated"), ModelBusy("later"), "no"]),
        "ledger",
    )
    model.complete(asked("one"))
    with pytest.raises(ReplyError):
        model.complete(asked("two", "reflect"))
    with pytest.raises(ModelBusy):
        model.complete(asked("three"))
    (path,) = Path("ledger").iterdir()
    return path


def pending(path: Path) -> None:
    """As if the process had been killed before the last call ended."""
    path.write_bytes(b"".join(path.read_bytes().splitlines(keepends=True)[:-1]))


def key_of(path: Path) -> str:
    return next(entry.key for _, entry in ledger_files(path)[0].entries() if hasattr(entry, "key"))


class TestShow:
    def test_a_table_by_stage_and_model(self, ledger, capsys):
        assert adhoc("ledger", "show", "ledger") == 0
        rows = [row.replace("│", " ").split() for row in capsys.readouterr().out.splitlines()]
        assert ["generate", "scripted", "1", "0", "1", "0", "1", "2", "0.0000"] in rows
        assert ["reflect", "scripted", "1", "1", "0", "0", "0", "0", "0.0000"] in rows
        assert ["all", "2", "1", "1", "0", "1", "2", "0.0000"] in rows

    def test_pending_calls_are_listed(self, ledger, capsys):
        pending(ledger)
        assert adhoc("ledger", "show", str(ledger)) == 0
        out = capsys.readouterr().out
        assert "pending: in flight when a run was ended" in out
        assert "e1" in out

    def test_the_calls_of_a_stage_or_an_episode_are_listed(self, ledger, capsys):
        assert adhoc("ledger", "show", "ledger", "--stage", "reflect") == 0
        out = capsys.readouterr().out
        assert "truncated" in out
        assert "ModelBusy" not in out
        assert adhoc("ledger", "show", "ledger", "--episode", "e1") == 0
        out = capsys.readouterr().out
        assert key_of(ledger)[:12] in out
        assert "ModelBusy" in out

    def test_one_call_in_full(self, ledger, capsys):
        assert adhoc("ledger", "show", "ledger", "--call", key_of(ledger)[:10]) == 0
        out = capsys.readouterr().out
        for told in (
            key_of(ledger),
            "[bold]one[/]",
            "yes [red]indeed[/]",
            "1 + 2 tokens",
            "stage generate by r1",
        ):
            assert told in out

    def test_a_folder_without_a_ledger_is_one_line(self, ledger, capsys):
        assert adhoc("ledger", "show", "none") == 2
        assert capsys.readouterr().err == (
            "adhoc ledger: error: none: there is no such file or folder; a run writes one to OUT/ledger, or "
            "where ledger.path=... says\n"
        )


class TestVerify:
    def test_totals(self, ledger, capsys):
        assert adhoc("ledger", "verify", "ledger", str(ledger)) == 0
        told = "intact; 1 file, 2 calls (1 of no use), 1 + 2 tokens, US$ 0.0000; 1 failed calls"
        assert capsys.readouterr().out == f"ledger: {told}\n{ledger}: {told}\n"

    def test_pending_calls_are_told(self, ledger, capsys):
        pending(ledger)
        assert adhoc("ledger", "verify", "ledger") == 0
        assert "; 1 never answered: they were in flight when a run was ended\n" in capsys.readouterr().out

    @pytest.mark.filterwarnings("default")
    def test_a_torn_end_is_a_warning(self, ledger, capsys):
        ledger.write_bytes(ledger.read_bytes()[:-3])
        assert adhoc("ledger", "verify", "ledger") == 0
        assert capsys.readouterr().err.startswith(
            f"adhoc: warning: {ledger}, line 10: incomplete last line left out"
        )

    def test_the_first_fault_is_one_line(self, ledger, capsys):
        ledger.write_bytes(ledger.read_bytes().replace(b"bold", b"cold"))
        assert adhoc("ledger", "verify", "ledger") == 2
        assert capsys.readouterr().err == (
            f"adhoc ledger: error: {ledger}, line 2: the checksum ('crc') does not fit the line; the file is "
            "damaged\n"
        )


class TestRewrite:
    def test_merge(self, ledger, capsys):
        assert adhoc("ledger", "merge", "all.jsonl", "ledger", "ledger") == 0
        assert capsys.readouterr().out == "all.jsonl: 9 entries (9 repeated ones left out)\n"
        assert adhoc("ledger", "merge", "all.jsonl", "ledger") == 2
        assert "all.jsonl: exists already" in capsys.readouterr().err

    def test_redact(self, ledger, capsys):
        Path("words.txt").write_text("one\n\nthree\n")
        assert adhoc("ledger", "redact", "ledger", "public.jsonl", "--raw", "--words", "words.txt") == 0
        assert capsys.readouterr().out == "public.jsonl: 9 entries\n"
        stored = Path("public.jsonl").read_text()
        assert "[bold][removed][/]" in stored
        assert "two" in stored

    def test_an_empty_list_of_words_is_told(self, ledger, capsys):
        Path("words.txt").write_text("\n")
        assert adhoc("ledger", "redact", "ledger", "public.jsonl", "--words", "words.txt") == 2
        assert capsys.readouterr().err == (
            "adhoc ledger: error: words.txt: holds no words; write one on each line\n"
        )
        Path("words.txt").write_bytes(b"\xff")
        assert adhoc("ledger", "redact", "ledger", "public.jsonl", "--words", "words.txt") == 2
        assert "words.txt: is not UTF-8 text" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["", "show", "verify", "merge", "redact"])
def test_every_command_has_help(command, capsys):
    with pytest.raises(SystemExit) as ended:
        adhoc("ledger", *([command] if command else []), "--help")
    assert ended.value.code == 0
    assert f"usage: adhoc ledger {command}".strip() in capsys.readouterr().out
