from __future__ import annotations

import io
from types import SimpleNamespace

import pytest
from rich.console import Console

from adhoc.experiments.console_progress import ConsoleProgress
from adhoc.experiments.plan import Plan, Unit
from adhoc.experiments.tally import Tally, clock_time

PLAN = Plan((Unit(0, 0),), 4, {"IRoT": 2}, {"No ad hoc": 4, "IRoT": 4})


def record(label="IRoT", success=True, cost=0.25):
    return {
        "episode_id": f"house--{label}",
        "policy_label": label,
        "success": success,
        "ending": "out of steps",
        "replaced": 1,
        "misplaced": 2,
        "steps": 30,
        "wall_s": 0.5,
        "llm": {"cost_usd": cost},
    }


def tally(*seconds: float) -> Tally:
    times = iter(seconds)
    return Tally(PLAN, lambda: next(times))


def test_the_rate_is_that_of_this_run_and_time_left_that_of_the_whole():
    counted = tally(100.0, 104.0, 104.0, 104.0)
    counted.add(record())
    counted.add(record())
    assert counted.rate == 0.5
    assert counted.seconds_left == (10 - 4) / 0.5
    assert (counted.done, counted.total) == (4, 10)


def test_before_the_first_episode_there_is_no_rate():
    counted = tally(0.0, 1.0, 1.0)
    assert counted.rate is None
    assert str(tally(0.0, 1.0)) == "2/10"


def test_success_and_money_are_added_up():
    counted = tally(0.0)
    for one in (record(), record(success=False), record("No ad hoc", cost=0.0)):
        counted.add(one)
    assert counted.success() == ["IRoT 50% of 2", "No ad hoc 100% of 1"]
    assert counted.spent == 0.5


def test_a_line_says_it_all():
    counted = tally(0.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0)
    counted.add(record())
    counted.add_failed()
    assert str(counted) == "4/10, 1 episodes/s, 0:06 left, $0.25, 1 failed"


@pytest.mark.parametrize(("seconds", "text"), [(0.4, "0:00"), (65, "1:05"), (3723, "1:02:03")])
def test_times_are_read_as_clocks_show_them(seconds, text):
    assert clock_time(seconds) == text


def told(width=200, terminal=False):
    output = io.StringIO()
    console = Console(file=output, width=width, force_terminal=terminal)
    with ConsoleProgress(console) as progress:
        progress.begin(PLAN)
        progress.started("house--IRoT")
        progress.finished(record())
        progress.failed(SimpleNamespace(episode_id="house--b", error="WorldError", message="[no] room"))
    return output.getvalue()


def test_without_a_terminal_lines_are_plain():
    lines = told().splitlines()
    assert lines[0] == "10 episodes in 4 scenarios; recorded: 2; to run: 8 (No ad hoc 4, IRoT 4)"
    assert lines[1].startswith("3/10, ")
    assert "house--IRoT: success, 1/2 re-placed, 30 steps, 0.5 s" in lines[1]
    assert lines[2].endswith("house--b: failed, WorldError: [no] room")
    assert lines[3] == "success in this run: IRoT 100% of 1"
    assert "\x1b" not in told()


def test_without_a_terminal_success_is_told_now_and_then():
    output = io.StringIO()
    with ConsoleProgress(Console(file=output, width=200)) as progress:
        progress.begin(Plan((Unit(0, 0),), 240, {}, {"IRoT": 240}))
        for number in range(240):
            progress.finished(record(success=number % 2 == 0))
    told = [line for line in output.getvalue().splitlines() if line.startswith("success so far")]
    assert told == [f"success so far: IRoT 50% of {24 * part}" for part in range(1, 10)]


def test_a_short_run_tells_success_at_its_end_alone():
    assert "so far" not in told()


def test_in_a_terminal_what_runs_is_shown_and_taken_away():
    shown = told(terminal=True)
    assert "running: house--IRoT" in shown
    assert shown.rstrip().endswith("IRoT 100% of 1\x1b[0m")
