from __future__ import annotations

import json

import pytest
from recorded_calls import Counting, Interrupted, asked, entries_of, outcome, record, reply_format

from adhoc.core.errors import LedgerError
from adhoc.core.line_checksum import checked_line
from adhoc.llm.ledger.entry import Answer, Call, Text
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.ledger.redaction import Redaction
from adhoc.llm.ledger.replaying import ReplayModel
from adhoc.llm.ledger.rewriting import merge, rewrite
from adhoc.llm.ledger.spending import Spending, spent
from adhoc.llm.ledger.summary import Summary, exchanges, find_call
from adhoc.llm.ledger.verifying import verify
from adhoc.llm.scripted import ScriptedModel

A, B, C = asked("a", episode="e2"), asked("the Acme robot"), asked("!cut", stage="reflect")


@pytest.fixture
def ledger(tmp_path):
    """Two files: a, the robot; then the cut one, a failure, one that was interrupted."""
    folder = tmp_path / "ledger"
    record(folder, A, B)
    record(folder, A, C, asked("!busy"))
    with pytest.raises(KeyboardInterrupt):
        LedgerModel(Interrupted(), folder).complete(asked("slow"))
    return folder


def replayed(path):
    model = ReplayModel(path)
    model.begin_episode("e1", 0)
    return [outcome(model, request) for request in (A, B, C)]


class TestMerge:
    def test_one_file_holds_everything_once(self, ledger, tmp_path):
        out = tmp_path / "all.jsonl"
        before = {path: path.read_bytes() for path in ledger.iterdir()}
        merged = merge(out, [ledger])
        assert {path: path.read_bytes() for path in ledger.iterdir()} == before
        assert replayed(out) == replayed(ledger)
        entries = entries_of(out)
        assert len(entries) == len(set(map(repr, entries))) == merged.entries - merged.repeated
        assert {repr(entry) for entry in entries} == {repr(entry) for entry in entries_of(ledger)}
        assert spent(out) == spent(ledger)
        assert verify(out).files == 1

    def test_overlapping_ledgers_are_counted_once(self, ledger, tmp_path):
        first, second = tmp_path / "first.jsonl", tmp_path / "second.jsonl"
        merge(first, [ledger])
        merge(second, [first, ledger, first])
        assert second.read_bytes() == first.read_bytes()

    @pytest.mark.parametrize("redacted_first", [False, True])
    def test_a_redacted_copy_adds_no_second_endings(self, ledger, tmp_path, redacted_first):
        copy, out = tmp_path / "copy.jsonl", tmp_path / "all.jsonl"
        rewrite(copy, [ledger], Redaction(prompts=True, raw=True))
        merge(out, [copy, ledger] if redacted_first else [ledger, copy])
        assert spent(out) == spent(ledger)
        assert (verify(out).repeated, replayed(out)) == (verify(ledger).repeated, replayed(ledger))

    def test_an_earlier_copy_does_not_hide_what_was_answered_since(self, tmp_path):
        """It was made while a call was in flight."""
        folder, copy, out = tmp_path / "ledger", tmp_path / "copy.jsonl", tmp_path / "all.jsonl"

        class Copied(Counting):
            def complete(self, request):
                merge(copy, [folder])
                return super().complete(request)

        LedgerModel(Copied(), folder).complete(A)
        merge(out, [copy, folder])
        assert (spent(copy).pending, spent(out)) == (1, spent(folder))
        assert verify(out).spending.pending == 0

    def test_the_order_is_that_of_time_not_of_names(self, ledger, tmp_path):
        files = sorted(ledger.iterdir(), reverse=True)
        merge(tmp_path / "all.jsonl", files)
        merge(tmp_path / "same.jsonl", [ledger])
        assert (tmp_path / "all.jsonl").read_bytes() == (tmp_path / "same.jsonl").read_bytes()

    def test_a_merged_ledger_is_gone_on_with(self, ledger, tmp_path):
        merge(tmp_path / "new" / "all.jsonl", [ledger])
        inner = Counting()
        model = LedgerModel(inner, tmp_path / "new")
        assert [outcome(model, request) for request in (A, B, C)] == replayed(ledger)
        assert inner.asked == []

    def test_nothing_is_overwritten_and_nothing_left_behind(self, ledger, tmp_path):
        out = tmp_path / "all.jsonl"
        out.write_text("mine")
        with pytest.raises(LedgerError, match=r"all\.jsonl: exists already; nothing is overwritten"):
            merge(out, [ledger])
        assert out.read_text() == "mine"
        assert sorted(path.name for path in tmp_path.iterdir()) == ["all.jsonl", "ledger"]

    def test_a_damaged_input_leaves_no_output(self, ledger, tmp_path):
        path = sorted(ledger.iterdir())[0]
        path.write_bytes(path.read_bytes().replace(b"stop", b"stOp"))
        with pytest.raises(LedgerError, match="the checksum"):
            merge(tmp_path / "all.jsonl", [ledger])
        assert [path.name for path in tmp_path.iterdir()] == ["ledger"]

    def test_models_are_not_mixed(self, ledger, tmp_path):
        other = tmp_path / "other"
        LedgerModel(ScriptedModel(["x"]), other).complete(A)
        with pytest.raises(LedgerError, match="model is 'scripted', but 'counting-1' in"):
            merge(tmp_path / "all.jsonl", [ledger, other])

    def test_a_name_that_no_folder_would_show_is_refused(self, ledger, tmp_path):
        with pytest.raises(LedgerError, match=r"the name of a ledger file ends with \.jsonl"):
            merge(tmp_path / "all.txt", [ledger])


class TestRedaction:
    def test_prompts_and_raw_answers_are_left_out_and_a_replay_is_the_same(self, ledger, tmp_path):
        out = tmp_path / "public.jsonl"
        rewrite(out, [ledger], Redaction(prompts=True, raw=True))
        assert replayed(out) == replayed(ledger)
        stored = out.read_text()
        assert "You are a robot." not in stored
        assert all(entry.raw is None for entry in entries_of(out) if isinstance(entry, Answer))
        assert all(text.redacted for text in entries_of(out) if isinstance(text, Text))
        assert verify(out).spending == verify(ledger).spending

    def test_a_miss_in_a_ledger_without_prompts_says_why_it_knows_no_more(self, ledger, tmp_path):
        rewrite(tmp_path / "public.jsonl", [ledger], Redaction(prompts=True))
        with pytest.raises(LedgerError, match="another message 2, whose text was taken out of this ledger"):
            ReplayModel(tmp_path / "public.jsonl").complete(asked("unheard of"))

    def test_words_are_removed_in_any_case(self, ledger, tmp_path):
        folder = tmp_path / "words"
        answered = LedgerModel(ScriptedModel(["fine"], name="counting-1"), folder)
        request = asked("ACME lab", agent="acme-bot", reply=reply_format({"title": "acme-lab"}))
        answered.complete(request)
        out = tmp_path / "public.jsonl"
        rewrite(out, [folder], Redaction(words=["acme", "acme lab"]))
        assert "acme" not in out.read_text().lower()
        contents = [entry.content for entry in entries_of(out) if isinstance(entry, Text)]
        assert "[removed]" in contents, "the longer word goes first"
        assert ReplayModel(out).complete(request).text == "fine"

    def test_a_word_in_an_answer_is_told_unless_answers_may_change(self, ledger, tmp_path):
        out = tmp_path / "public.jsonl"
        with pytest.raises(
            LedgerError, match=r"line \d+: the answer to [0-9a-f]+ holds a word .*; --answers"
        ):
            rewrite(out, [ledger], Redaction(words=["acme"]))
        assert not out.exists()
        rewrite(out, [ledger], Redaction(words=["acme"], answers=True))
        assert "acme" not in out.read_text().lower()
        assert replayed(out)[1] == "answer 2 to the [removed] robot"

    def test_a_word_in_the_header_is_told(self, ledger, tmp_path):
        with pytest.raises(LedgerError, match="model is 'counting-1', which holds a word"):
            rewrite(tmp_path / "public.jsonl", [ledger], Redaction(words=["counting"], answers=True))

    def test_keys_of_this_machine_are_removed_in_any_case(self, tmp_path, monkeypatch):
        record(tmp_path / "ledger", asked("the word is hunter2-hunter2"), asked("!busy"))
        monkeypatch.setenv("LAB_API_KEY", "hunter2-hunter2")
        rewrite(tmp_path / "public.jsonl", [tmp_path / "ledger"], Redaction(answers=True))
        assert "hunter2" not in (tmp_path / "public.jsonl").read_text()


class TestSummary:
    def test_calls_are_added_up_by_stage_and_model(self, ledger):
        summary = Summary()
        for exchange in exchanges(ledger):
            summary.add(exchange)
        assert summary.groups == {
            ("generate", "counting-1"): Spending(3, 20, 6, 0.5, refused=0, failed=1, pending=1),
            ("reflect", "counting-1"): Spending(1, 10, 3, 0.25, refused=1),
        }
        assert summary.total == spent(ledger) == verify(ledger).spending
        assert [exchange.fate for exchange in exchanges(ledger)] == [
            "answered",
            "answered",
            "truncated",
            "ModelBusy",
            "pending",
        ]

    def test_one_stage_or_episode_is_chosen(self, ledger):
        assert [it.call.stage for it in exchanges(ledger, stage="reflect")] == ["reflect"]
        assert [it.fate for it in exchanges(ledger, episode="e2")] == ["answered"]
        assert [it.fate for it in exchanges(ledger, stage="reflect", episode="e2")] == []

    def test_a_call_that_was_made_again_is_one_pending_and_one_answered(self, ledger):
        LedgerModel(Counting(), ledger).complete(asked("slow"))
        fates = [it.fate for it in exchanges(ledger)]
        assert (fates.count("pending"), fates.count("answered")) == (1, 3)

    def test_the_answered_attempt_is_found(self, tmp_path):
        for model in (Interrupted(), Counting()):
            try:
                LedgerModel(model, tmp_path).complete(asked())
            except KeyboardInterrupt:
                continue
        key = next(entry.key for entry in entries_of(tmp_path) if isinstance(entry, Answer))
        assert find_call(tmp_path, key).fate == "answered"

    def test_an_unknown_or_ambiguous_key_is_told(self, ledger):
        with pytest.raises(LedgerError, match="no call with a key that begins with 'zz'"):
            find_call(ledger, "zz")
        with pytest.raises(LedgerError, match="no call with a key that begins with ''"):
            find_call(ledger, "")

    def test_keys_that_begin_alike_are_told(self, tmp_path):
        record(tmp_path, *(asked(str(number)) for number in range(17)))
        keys = [entry.key for entry in entries_of(tmp_path) if isinstance(entry, Call)]
        first = next(key[0] for key in keys if sum(other[0] == key[0] for other in keys) > 1)
        with pytest.raises(LedgerError, match=rf"\d+ calls have keys that begin with '{first}': "):
            find_call(tmp_path, first)


class TestVerify:
    def test_what_is_there_is_counted(self, ledger):
        verdict = verify(ledger)
        assert (verdict.files, verdict.repeated) == (3, 0)
        assert verdict.spending == Spending(4, 30, 9, 0.75, refused=1, failed=1, pending=1)

    def test_second_answers_are_counted(self, tmp_path):
        models = [LedgerModel(Counting(), tmp_path) for _ in range(3)]
        for model in models:
            model.complete(A)
        assert verify(tmp_path).repeated == 2

    @pytest.mark.parametrize(
        ("line", "change", "told"),
        [
            (2, {"content": "You are a rabbit."}, "line 2: sha256 is .*; the hash of the content is"),
            (
                4,
                {"messages": [["user", "00"]]},
                "line 4: refers to the text 00, which is not in the file before",
            ),
            (4, {"schema": "11"}, "line 4: refers to the text 11"),
            (5, {"key": "22" * 32}, "line 5: key is 2222.*; no call of this key is open here"),
        ],
    )
    def test_what_does_not_fit_together_is_told(self, ledger, line, change, told):
        path = sorted(ledger.iterdir())[0]
        lines = path.read_bytes().splitlines(keepends=True)
        entry = {**json.loads(lines[line - 1]), **change}
        del entry["crc"]
        path.write_bytes(b"".join([*lines[: line - 1], checked_line(entry), *lines[line:]]))
        with pytest.raises(LedgerError, match=told):
            verify(ledger)

    def test_an_answer_without_a_call_is_told_by_the_summary_too(self, ledger):
        path = sorted(ledger.iterdir())[0]
        lines = path.read_bytes().splitlines(keepends=True)
        path.write_bytes(b"".join(lines[:3] + lines[4:]))
        with pytest.raises(LedgerError, match=r"line 4: key is .*; no call of this key is open here"):
            list(exchanges(ledger))

    def test_a_second_header_is_told(self, ledger):
        path = sorted(ledger.iterdir())[0]
        path.write_bytes(path.read_bytes() * 2)
        with pytest.raises(LedgerError, match=r"a second header; files are put together by"):
            verify(path)
