"""The terminal, however it behaves."""

from __future__ import annotations

import io
import os
import pty

import pytest

from adhoc.agents.human.terminal import MAX_LINE, Terminal


@pytest.fixture
def pipe():
    """A reader, and what writes to it."""
    reading, writing = os.pipe()
    with open(reading, encoding="utf-8") as source, open(writing, "wb", buffering=0) as sink:
        yield source, sink


def test_lines_come_one_by_one_and_are_shown_where_no_terminal_echoes_them(pipe):
    source, sink = pipe
    sink.write(b"explore\r\n\nlast")
    sink.close()
    shown = io.StringIO()
    terminal = Terminal(source, shown)
    assert [terminal.ask("> ") for _ in range(5)] == ["explore", "", "last", None, None]
    assert shown.getvalue() == "> explore\n> \n> last\n> \n> \n"


def test_nothing_is_read_ahead_so_that_two_can_take_turns(pipe):
    source, sink = pipe
    sink.write(b"one\ntwo\n")
    shown = io.StringIO()
    assert Terminal(source, shown).ask("> ") == "one"
    assert Terminal(source, shown).ask("> ") == "two"


def test_a_line_without_end_comes_in_pieces(pipe):
    source, sink = pipe
    sink.write(b"x" * (MAX_LINE + 3) + b"\n")
    terminal = Terminal(source, io.StringIO())
    assert [len(terminal.ask("")) for _ in range(2)] == [MAX_LINE, 3]


def test_bytes_that_are_no_text_are_replaced(pipe):
    source, sink = pipe
    sink.write(b"w\xff\n")
    assert Terminal(source, io.StringIO()).ask("") == "w\N{REPLACEMENT CHARACTER}"


def test_a_source_without_a_file_is_read_as_well():
    terminal = Terminal(io.StringIO("w\n"), io.StringIO())
    assert [terminal.ask(""), terminal.ask("")] == ["w", None]


def test_a_terminal_that_was_closed_is_the_end(pipe):
    source, sink = pipe
    sink.write(b"w\n")
    shown = io.StringIO()
    shown.close()
    assert Terminal(source, shown).ask("> ") is None
    closed = io.StringIO("w\n")
    closed.close()
    assert Terminal(closed, io.StringIO()).ask("> ") is None


def test_a_source_that_cannot_be_read_is_the_end(pipe):
    for_writing_only = pipe[1]
    assert Terminal(for_writing_only, io.StringIO()).ask("> ") is None


class HungUp(io.StringIO):
    def flush(self):
        raise BrokenPipeError


def test_a_person_whose_terminal_is_gone_has_left_and_is_not_nobody():
    terminal = Terminal(io.StringIO("w\n"), HungUp(), must_begin=True)
    assert (terminal.ask("> "), terminal.is_empty) == (None, False)


def test_what_a_terminal_cannot_show_is_replaced(pipe):
    narrow = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    Terminal(pipe[0], narrow).show("Kü\u4e2d|\n")
    narrow.seek(0)
    assert narrow.read() == "K??|\n"


def test_no_standard_input_at_all_is_the_end(monkeypatch):
    monkeypatch.setattr("sys.stdin", None)
    assert Terminal(None, io.StringIO()).ask("> ") is None


def test_an_input_that_never_began_is_empty_and_one_that_ended_is_not(pipe):
    source, sink = pipe
    sink.close()
    nobody = Terminal(source, io.StringIO(), must_begin=True)
    assert (nobody.ask(""), nobody.is_empty) == (None, True)
    somebody = Terminal(io.StringIO("\n"), io.StringIO(), must_begin=True)
    assert [somebody.ask(""), somebody.ask("")] == ["", None]
    assert not somebody.is_empty
    usual = Terminal(io.StringIO(), io.StringIO())
    assert (usual.ask(""), usual.is_empty) == (None, False)


def test_a_person_at_a_terminal_is_there_even_if_the_first_thing_is_to_leave():
    ours, theirs = pty.openpty()
    with open(theirs, encoding="utf-8") as source, open(ours, "wb", buffering=0) as sink:
        sink.write(b"\x04")
        terminal = Terminal(source, io.StringIO(), must_begin=True)
        assert (terminal.ask(""), terminal.is_empty) == (None, False)


def test_what_a_terminal_echoes_is_not_shown_again():
    ours, theirs = pty.openpty()
    with open(theirs, encoding="utf-8") as source, open(ours, "wb", buffering=0) as sink:
        sink.write(b"explore\n")
        shown = io.StringIO()
        assert Terminal(source, shown).ask("> ") == "explore"
    assert shown.getvalue() == "> "
