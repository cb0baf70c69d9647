"""Runs in which a person plays a robot: at a pseudo-terminal, from a pipe, and from scripts."""

from __future__ import annotations

import fcntl
import io
import json
import os
import pty
import select
import signal
import subprocess
import sys
import termios
from pathlib import Path

import pytest

from adhoc.cli.main import main
from adhoc.evaluation.records import checked_part

ROOT = Path(__file__).parents[2]
FAKES = str(ROOT / "tests" / "evaluation")
SMALL = (
    "world._target_=grid_world.GridWorld",
    "benchmark.draws=[{house: one_room, seed: 1, misplaced: 1, teammates: 3}]",
    "max_steps=12",
    "pictures=false",
    "transcript=false",
)
WALKERS = "team.agent._target_=grid_world.Script"
PATIENCE_S = 120


@pytest.fixture(autouse=True)
def _fakes(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(FAKES)
    monkeypatch.chdir(tmp_path)


def run(*arguments):
    return main(["run", *SMALL, *arguments])


def typing(monkeypatch, *lines):
    monkeypatch.setattr("sys.stdin", io.StringIO("".join(f"{line}\n" for line in lines)))


def records(folder):
    return [json.loads(line) for line in Path(folder, "episodes.jsonl").read_text().splitlines()]


def compared(record):
    """What a replay must give again: all but times, and the path of the script."""
    return {name: it for name, it in checked_part(record).items() if name not in ("config_hash", "crc")}


def test_a_person_as_newcomer_and_the_exact_replay(monkeypatch, capsys):
    typing(monkeypatch, "ww", "blah", "a", "say hello", "s", "wait 2")
    assert run(WALKERS, "policy=human", "join_step=2", "out=played") == 0
    assert "=== You play newcomer, seed 1." in capsys.readouterr().out
    assert (
        run(
            WALKERS,
            "policy=human",
            "join_step=2",
            "out=again",
            "+policy.agent.script=played/sessions/newcomer.txt",
        )
        == 0
    )
    assert "You play" not in capsys.readouterr().out
    played, again = records("played"), records("again")
    assert [compared(it) for it in played] == [compared(it) for it in again]
    assert played[1]["person"] == {"lines": 7, "refused": 1, "given_up": 0, "strayed": 0, "left": 1}
    assert played[0]["person"]["lines"] == 0


def test_a_person_in_a_team_plays_the_shared_past_once(monkeypatch, capsys):
    typing(monkeypatch, "w", "wait 4", "d", "stop")
    assert run("team=with_human", WALKERS, "policy=none", "out=mixed") == 0
    capsys.readouterr()
    typing(monkeypatch, "s", "leave")
    assert run("team=with_human", WALKERS, "policy=heuristic", "join_step=3", "out=mixed") == 0
    shown = capsys.readouterr().out
    assert shown.count("(as before)") == 2
    assert "happened: newcomer joined: " in shown
    log = Path("mixed/sessions/teammate_1.txt").read_text()
    assert [line.split(" ", 1)[1] for line in log.splitlines() if line.startswith("@")] == [
        *("w", "wait 4", "d", "stop"),
        *("w", "wait 4", "s", "leave"),
    ]


def test_a_recorded_teammate_meets_other_newcomers(monkeypatch, capsys):
    typing(monkeypatch, "w", "wait 4", "d", "leave")
    assert run("team=with_human", WALKERS, "policy=none", "out=alone") == 0
    script = "+team.seats.0.agent.script=alone/sessions/teammate_1.txt"
    assert (
        run("-m", "team=with_human", WALKERS, script, "policy=random,heuristic", "join_step=3", "out=met")
        == 0
    )
    assert [it["person"]["strayed"] for it in records("met")] == [0, 0, 2]


def test_a_script_that_was_changed_is_another_configuration(capsys):
    script = Path("script.txt")
    script.write_text("w\nwait 4\n")
    scripted = [WALKERS, "policy=human", "+policy.agent.script=script.txt", "out=scripted"]
    assert run(*scripted, "join_step=2") == 0
    script.write_text("# a comment\nw\nwait 4\n")
    assert run(*scripted, "join_step=3") == 0
    script.write_text("w\nwait 5\n")
    capsys.readouterr()
    assert run(*scripted, "join_step=4") == 2
    assert "policy=human (policy.fingerprint of policy: " in capsys.readouterr().err
    assert len(records("scripted")) == 3


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["policy=human", "workers=2"], "workers=2: policy.agent asks a person at the terminal"),
        (["team=with_human", "workers=2"], "workers=2: team.seats.0.agent asks a person"),
        (["policy=human", "dry_run=true"], "dry_run=true: policy.agent asks a person"),
        (
            ["policy=human", "policy.agent.asked=often"],
            "policy.agent.asked=often: must be one of steps, events, ends",
        ),
        (["policy=human", "policy.agent.tries=-1"], "error: policy.agent.tries=-1: must be at least 1"),
        (["policy=human", "+policy.agent.script=gone.txt"], "policy.agent.script=gone.txt: cannot be read"),
        (["team=with_human", "+team.seats.0.agent.script=x"], "team.seats.0.agent.script=x: cannot be read"),
    ],
)
def test_what_a_run_with_a_person_cannot_do(capsys, arguments, told):
    assert run(WALKERS, *arguments) == 2
    error = capsys.readouterr().err
    assert error.startswith("adhoc run: error: ")
    assert told in error
    assert error.count("\n") == 1
    assert not list(Path().rglob("episodes.jsonl"))


def test_a_run_whose_input_is_empty_has_no_person(monkeypatch, capsys):
    typing(monkeypatch)
    assert run(WALKERS, "policy=human", "out=nobody") == 2
    told = "adhoc run: error: no person: standard input is empty; give +policy.agent.script=FILE"
    assert told in capsys.readouterr().err
    assert [it["policy"] for it in records("nobody")] == ["none"]
    typing(monkeypatch, "w")
    assert run(WALKERS, "policy=human", "out=nobody") == 0
    assert records("nobody")[1]["person"] == {**records("nobody")[0]["person"], "lines": 2, "left": 1}


def test_lines_that_end_in_an_early_episode_are_enough_for_a_person(monkeypatch):
    draws = (
        "benchmark.draws=[{house: one_room, seed: 1, misplaced: 1}, {house: one_room, seed: 2, misplaced: 1}]"
    )
    typing(monkeypatch, "w")
    assert run(WALKERS, draws, "policy=human", "out=short") == 0
    assert [it["person"]["left"] for it in records("short")] == [0, 1, 0, 1]


class Terminal:
    """`adhoc run` at a pseudo-terminal."""

    def __init__(self, *arguments):
        self._ours, theirs = pty.openpty()
        environment = {**os.environ, "TERM": "xterm", "PYTHONPATH": f"{ROOT}{os.pathsep}{FAKES}"}
        command = [sys.executable, "-m", "adhoc.cli.main", "run", *SMALL, *arguments]
        self.process = subprocess.Popen(
            command,
            stdin=theirs,
            stdout=theirs,
            stderr=theirs,
            env=environment,
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),  # keys send signals
        )
        os.close(theirs)
        self.shown = ""

    def read_until(self, mark, seen=0):
        """All that is shown up to the mark, from the character `seen` on."""
        while mark not in self.shown[seen:]:
            assert select.select([self._ours], [], [], PATIENCE_S)[0], self.shown
            try:
                self.shown += os.read(self._ours, 4096).decode()
            except OSError:  # the other end is closed
                break
        return self.shown

    def type(self, text):
        seen = len(self.shown)
        os.write(self._ours, text.encode())
        return seen

    def end(self):
        self.read_until("\0")
        code = self.process.wait(PATIENCE_S)
        os.close(self._ours)
        return code

    def hang_up(self):
        os.close(self._ours)
        return self.process.wait(PATIENCE_S)


def test_a_dialog_at_a_terminal_that_is_interrupted_and_goes_on():
    terminal = Terminal(WALKERS, "policy=human", "out=played")
    terminal.read_until("\n> ")
    seen = terminal.type("wx\x7f\n")
    terminal.read_until("\n> ", seen)
    seen = terminal.type("blah\n")
    assert "`blah` is no command" in terminal.read_until("\n> ", seen)
    terminal.type("\x03")
    assert terminal.end() == 130
    assert "\x1b[?25l" not in terminal.shown, "a live line would garble what is typed"
    assert len(records("played")) == 1

    terminal = Terminal(WALKERS, "policy=human", "out=played")
    seen = terminal.read_until("> blah   (as before)").index("> blah")
    terminal.read_until("\n> ", seen)
    terminal.type("\x04")
    assert terminal.end() == 0
    assert records("played")[1]["person"] == {
        "lines": 3,
        "refused": 1,
        "given_up": 0,
        "strayed": 0,
        "left": 1,
    }
    typed = [line.partition(" ")[2] for line in Path("played/sessions/newcomer.txt").read_text().splitlines()]
    assert [line for line in typed if line] == ["seed 1]", "w", "blah", "seed 1]", "w", "blah", "leave"]


def test_a_terminal_that_is_closed_ends_the_run():
    terminal = Terminal(WALKERS, "policy=human", "out=played")
    terminal.read_until("\n> ")
    assert terminal.hang_up() == -signal.SIGHUP
    assert [it["policy"] for it in records("played")] == ["none"]
