"""Scripts and logs of sessions."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents.human.person import MAX_CHARACTERS
from adhoc.agents.human.script import Answer, Line, Script, SessionLog, read_script
from adhoc.core.errors import ConfigurationError
from adhoc.prompting.clean import one_line


def write(path, text):
    file = path / "script.txt"
    file.write_text(text, encoding="utf-8")
    return file


def test_comments_and_blank_lines_are_left_out(tmp_path):
    file = write(tmp_path, "# hello\n\n  explore  \n@12 stop\r\n[two]\n@3:ab12 go 4\n@4:00 \n")
    assert read_script(file) == [
        [Line("explore"), Line("stop", 12)],
        [Line("go 4", 3, "ab12"), Line("", 4, "00")],
    ]


def test_plain_lines_come_in_order_and_not_before_their_step(tmp_path):
    script = Script(write(tmp_path, "explore\n@5 w\ns\n"))
    assert script.answer(0, "x") == Answer("explore")
    assert script.answer(3, "x") == Answer("", is_typed=False)
    assert script.answer(5, "x") == Answer("w")
    assert script.answer(5, "x") == Answer("s")
    assert script.answer(9, "x") is None
    assert script.answer(10, "x") is None


SESSION = "[one]\n@0:aa w\n@2:bb s\n@9:cc a\n[two]\n@0:dd q\n@1:ee e\n"


def test_a_recorded_line_is_given_in_its_situation(tmp_path):
    script = Script(write(tmp_path, SESSION))
    assert script.answer(0, "dd") == Answer("q")
    assert script.answer(1, "ee") == Answer("e")
    assert script.answer(2, "ff") is None
    assert script.answer(2, "bb") == Answer("s")


def test_where_an_episode_goes_another_way_the_lines_go_on_and_are_counted(tmp_path):
    script = Script(write(tmp_path, SESSION))
    assert script.answer(0, "aa") == Answer("w")
    assert script.answer(1, "xx") == Answer("", is_typed=False)
    assert script.answer(3, "xx") == Answer("s", is_strayed=True)
    assert script.answer(9, "cc") == Answer("a")
    assert script.answer(12, "xx") is None


def test_a_session_of_other_episodes_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match="none of its episodes begins as this one does"):
        Script(write(tmp_path, SESSION)).answer(0, "xx")


def test_an_empty_script_is_at_its_end(tmp_path):
    assert Script(write(tmp_path, "# nothing\n")).answer(0, "xx") is None


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"\xff\xfe", "is no text in UTF-8"),
        (b"w\n@soon stop\n", "line 2: '@soon stop': after @ a step must come"),
        (b"@3stop\n", "after @ a step must come"),
        (b"w\n" * 5_000_001, "no script"),
    ],
)
def test_what_is_no_script_is_refused(tmp_path, content, told):
    file = tmp_path / "script.txt"
    file.write_bytes(content)
    with pytest.raises(ConfigurationError, match=r"script=.*script\.txt") as error:
        Script(file)
    assert told in str(error.value)


@pytest.mark.parametrize("name", ["missing.txt", "."])
def test_a_script_that_cannot_be_read_is_named(tmp_path, name):
    with pytest.raises(ConfigurationError, match="cannot be read"):
        Script(tmp_path / name)


def test_a_log_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigurationError, match=r"session=.*cannot be written"):
        SessionLog(tmp_path / "file" / "log.txt", "x").add(Line("w", 0, "aa"))


@given(st.lists(st.text(), min_size=1, max_size=5))
def test_whatever_is_typed_is_read_back(tmp_path_factory, typed):
    path = tmp_path_factory.mktemp("logs") / "log.txt"
    log = SessionLog(path, "robot, seed 0")
    lines = [Line(one_line(text, MAX_CHARACTERS), step, f"{step:x}") for step, text in enumerate(typed)]
    for line in lines:
        log.add(line)
    SessionLog(path, "robot, seed 0").add(Line("stop", 0, "abc"))
    assert read_script(path) == [lines, [Line("stop", 0, "abc")]]
