"""Ledgers that were cut off, damaged or are none."""

from __future__ import annotations

import json
import os
import random
import warnings

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from recorded_calls import Counting, asked, entries_of, only_file, outcome, record

from adhoc.core.errors import LedgerError
from adhoc.core.line_checksum import checked_line
from adhoc.llm.ledger.entry import Answer, Header, to_json
from adhoc.llm.ledger.index import open_ledger
from adhoc.llm.ledger.line import encoded
from adhoc.llm.ledger.reader import TornLedgerWarning, ledger_files
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.ledger.replaying import ReplayModel
from adhoc.llm.ledger.spending import Spending, spent

TEXTS = ("a", "Wohin, bitte?", '\u2028\n"\\', "!cut", "!empty", "!busy", "\ud800 half a pair", "😀")


def small_file(folder, seed):
    """One to three calls of a kind that depends on the seed."""
    rng = random.Random(seed)
    record(folder, *(asked(rng.choice(TEXTS), sample=number) for number in range(rng.randint(1, 3))))
    return only_file(folder)


@pytest.mark.parametrize("seed", range(20))
def test_a_ledger_cut_at_any_byte_loses_the_cut_line_at_most_and_says_so(tmp_path, seed):
    path = small_file(tmp_path, seed)
    whole, entries = path.read_bytes(), entries_of(tmp_path)
    breaks = [place for place, byte in enumerate(whole) if byte == ord("\n")]
    for length in range(len(whole) - 1, -1, -1):
        os.truncate(path, length)
        kept = sum(length >= place for place in breaks) - 1  # a line without its break is whole
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            assert entries_of(tmp_path) == entries[: max(0, kept)]
            assert len(open_ledger(tmp_path)) == sum(isinstance(it, Answer) for it in entries[: max(0, kept)])
        is_clean = length in breaks or length - 1 in breaks
        assert bool(told) != is_clean
        assert all(it.category is TornLedgerWarning and str(path) in str(it.message) for it in told)


def test_a_warning_names_file_and_line(tmp_path):
    path = small_file(tmp_path, 0)
    lines = path.read_bytes().count(b"\n")
    path.write_bytes(path.read_bytes()[:-9])
    with pytest.warns(TornLedgerWarning, match=rf"{path}, line {lines}: incomplete last line left out"):
        entries_of(tmp_path)
    path.write_bytes(b"")
    with pytest.warns(TornLedgerWarning, match=rf"{path}: is empty"):
        assert ledger_files(tmp_path) == []


@pytest.mark.filterwarnings("ignore::adhoc.llm.ledger.reader.TornLedgerWarning")
def test_after_a_cut_only_lost_answers_are_paid_again_and_the_file_stays(tmp_path):
    requests = [asked("a"), asked("b"), asked("!cut")]
    record(tmp_path, *requests)
    path = only_file(tmp_path)
    whole = path.read_bytes()
    ends = [place + 1 for place, byte in enumerate(whole) if byte == ord("\n")]
    for length in [*ends, *(end - 20 for end in ends)]:
        path.write_bytes(whole[:length])
        answered = len(open_ledger(tmp_path))
        inner = Counting()
        model = LedgerModel(inner, tmp_path)
        for request in requests:
            outcome(model, request)
        assert len(inner.asked) == 3 - answered
        assert path.read_bytes() == whole[:length]
        for other in set(tmp_path.iterdir()) - {path}:
            other.unlink()


def test_every_flipped_bit_is_an_error_that_names_file_and_line(tmp_path):
    path = small_file(tmp_path, 1)
    whole = path.read_bytes()
    with open(path, "rb+", buffering=0) as file:
        for place, byte in enumerate(whole):
            line = whole[:place].count(b"\n") + 1
            for bit in range(8):
                os.pwrite(file.fileno(), bytes([byte ^ (1 << bit)]), place)
                assert error_text(path).startswith(f"{path}, line {line}: ")
            os.pwrite(file.fileno(), bytes([byte]), place)


def error_text(path):
    try:
        open_ledger(path)
    except LedgerError as error:
        return str(error)
    return "none"


def test_nothing_is_asked_and_nothing_written_beside_a_damaged_ledger(tmp_path):
    path = small_file(tmp_path, 0)
    damaged = path.read_bytes().replace(b"generate", b"generatf", 1)
    path.write_bytes(damaged)
    inner = Counting()
    for make in (
        lambda: LedgerModel(inner, tmp_path),
        lambda: ReplayModel(tmp_path),
        lambda: spent(tmp_path),
    ):
        with pytest.raises(LedgerError, match=r"line 4: the checksum \('crc'\) does not fit the line"):
            make()
    assert inner.asked == []
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == damaged


def header_of(path) -> dict:
    return json.loads(path.read_bytes().splitlines()[0])


def with_header(path, **changes):
    header = {name: value for name, value in {**header_of(path), **changes}.items() if name != "crc"}
    path.write_bytes(checked_line(header) + b"".join(path.read_bytes().splitlines(keepends=True)[1:]))


def test_another_version_is_told(tmp_path):
    path = small_file(tmp_path, 0)
    with_header(path, version=2, library_version="9.1")
    with pytest.raises(
        LedgerError,
        match=r"line 1: version is 2; this release .* reads version 1: use the release .* \('9.1'\)",
    ):
        open_ledger(tmp_path)


def test_a_wrong_field_is_told(tmp_path):
    path = small_file(tmp_path, 0)
    with_header(path, window="wide")
    with pytest.raises(LedgerError, match="line 1: window is 'wide'; it should be a whole number or null"):
        open_ledger(tmp_path)
    with_header(path, window=None, more=1)
    with pytest.raises(LedgerError, match="line 1: there is no field 'more'"):
        open_ledger(tmp_path)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"entry": "note"}, "entry is 'note'; it should be one of header, text, call, answer, failure"),
        ({"messages": [["user"]]}, r"messages is \[\['user'\]\]; it should be a list of pairs of texts"),
        ({"messages": "none"}, "messages is 'none'; it should be a list of pairs of texts"),
        ({"sample": True}, "sample is True; it should be a whole number"),
        ({"seed": 1.5}, "seed is 1.5; it should be a whole number or null"),
    ],
)
def test_a_wrong_field_of_an_entry_is_told_with_its_line(tmp_path, change, told):
    path = small_file(tmp_path, 0)
    lines = path.read_bytes().splitlines(keepends=True)
    call = {name: value for name, value in {**json.loads(lines[3]), **change}.items() if name != "crc"}
    path.write_bytes(b"".join([*lines[:3], checked_line(call), *lines[4:]]))
    with pytest.raises(LedgerError, match=f"line 4: {told}"):
        entries_of(tmp_path)


def test_a_missing_field_is_told(tmp_path):
    path = small_file(tmp_path, 0)
    header = {name: value for name, value in header_of(path).items() if name not in ("crc", "model")}
    path.write_bytes(checked_line(header))
    with pytest.raises(LedgerError, match="line 1: field 'model' is missing"):
        open_ledger(tmp_path)


@pytest.mark.parametrize(
    "content", [b"hello", b"hello\n", b"[]\n", b"{}\n", b'{"entry":"call"}\n', b"\xff\n", b"\n"]
)
def test_a_foreign_file_is_told(tmp_path, content):
    (tmp_path / "foreign.jsonl").write_bytes(content)
    with pytest.raises(LedgerError, match=r"foreign\.jsonl, line 1: "):
        open_ledger(tmp_path)


@given(content=st.binary(min_size=1, max_size=200))
def test_any_foreign_file_is_told(tmp_path_factory, content):
    assume(not b'{"entry":"header","format":"adhoc ledger"'.startswith(content))  # the beginning of a ledger
    path = tmp_path_factory.mktemp("foreign") / "foreign.jsonl"
    path.write_bytes(content)
    with pytest.raises(LedgerError, match=r"foreign\.jsonl, line 1: "):
        open_ledger(path)


def test_a_file_that_begins_with_no_header_is_told(tmp_path):
    answer = to_json(Answer("0" * 64, "m", 1, 1, 0.0, "stop", 0.0, "x", None, None, None, "now"))
    (tmp_path / "odd.jsonl").write_bytes(checked_line({**answer, "format": "adhoc ledger", "version": 1}))
    with pytest.raises(LedgerError, match="line 1: "):
        open_ledger(tmp_path)


def test_other_files_in_the_folder_are_left_alone(tmp_path):
    small_file(tmp_path, 0)
    (tmp_path / "README.md").write_text("mine")
    (tmp_path / "notes.json").write_text("{}")
    assert len(ledger_files(tmp_path)) == 1


def test_a_folder_that_is_not_there_is_empty(tmp_path):
    assert len(open_ledger(tmp_path / "none")) == 0
    assert spent(tmp_path / "none") == Spending()


def test_files_are_read_in_the_order_in_which_they_were_begun(tmp_path):
    for name, time in (("a", "2026-01-02"), ("b", "2026-01-01"), ("c", "2026-01-02")):
        header = Header("adhoc ledger", 1, "0", name, None, {}, time)
        (tmp_path / f"{name}.jsonl").write_bytes(encoded(header))
    assert [file.header.model for file in ledger_files(tmp_path)] == ["b", "a", "c"]


def test_a_file_that_changed_behind_the_index_is_told(tmp_path):
    path = small_file(tmp_path, 0)
    ledger = open_ledger(tmp_path)
    key = next(entry.key for entry in entries_of(tmp_path) if isinstance(entry, Answer))
    path.write_bytes(path.read_bytes().replace(b"answer 1", b"answer 9"))
    with pytest.raises(LedgerError, match=r"checksum|was changed"):
        ledger.find(key)
