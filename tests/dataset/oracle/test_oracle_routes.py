"""Routes in space and time on a row and on a plain."""

from __future__ import annotations

import numpy as np
from test_oracle_fields import LINE

from adhoc.dataset.oracle.fields import FAR, stance_field
from adhoc.dataset.oracle.routes import Reservations, battery_of, route_aside, route_to_deed, stances_along
from adhoc.dataset.oracle.stances import AIMS, Deed

ROW_NEAR = np.array([[0, 1, -1], [0, 1, 2], [1, 2, 3], [2, 3, -1]], np.int32)


def to_the_end_of_the_row(taken, end=20, delay=10):
    rest = np.full((4, AIMS), FAR, np.int32)
    rest[3, 0] = 1
    value = stance_field(LINE, rest)
    return route_to_deed(0, 0, end, value, rest, LINE, taken, delay, 10_000)


def nobody(horizon=30, cells=4):
    return np.zeros((horizon, cells), np.uint8)


def test_an_open_way_is_taken_at_once():
    assert to_the_end_of_the_row(nobody()) == [Deed.EAST] * 3 + [Deed.ACT]


def test_a_robot_waits_until_a_cell_is_free():
    taken = nobody()
    taken[:6, 2] = 1
    deeds = to_the_end_of_the_row(taken)
    assert deeds is not None
    assert len(deeds) == 8
    assert battery_of(deeds) == 4, "waiting costs nothing"
    cells = [stance // AIMS for stance in stances_along(0, deeds, LINE)]
    assert not any(taken[time, cell] for time, cell in enumerate(cells))


def test_the_step_of_the_act_itself_has_to_be_free():
    taken = nobody()
    taken[4, 3] = 1
    deeds = to_the_end_of_the_row(taken)
    assert deeds is not None
    assert len(deeds) == 6


def test_no_way_within_the_time_or_the_delay_is_no_route():
    taken = nobody()
    taken[:12, 2] = 1
    assert to_the_end_of_the_row(taken, end=8) is None
    assert to_the_end_of_the_row(taken, delay=3) is None
    assert to_the_end_of_the_row(taken) is not None
    taken[:, 2] = 1
    assert to_the_end_of_the_row(taken) is None


def test_a_robot_takes_its_surroundings_one_step_longer_on_both_sides():
    reserved = Reservations(ROW_NEAR, 10)
    reserved.add(np.array([0], np.int64), 4)
    assert np.argwhere(reserved.taken).tolist() == [[time, cell] for time in (3, 4, 5) for cell in (0, 1)]
    reserved.add(np.array([0], np.int64), 4, -1)
    assert not reserved.taken.any()


def test_a_robot_in_nobodys_way_stays():
    cells = route_aside(1, 0, 5, LINE, nobody(), 10)
    assert cells is not None
    assert cells.tolist() == [1] * 6


def test_a_robot_steps_aside_with_the_fewest_moves():
    taken = nobody()
    taken[3:, :2] = 1
    cells = route_aside(0, 0, 6, LINE, taken, 10)
    assert cells is not None
    assert cells[0] == 0
    assert cells[-1] == 2
    assert (np.diff(cells) != 0).sum() == 2
    assert not any(taken[time, cell] for time, cell in enumerate(cells))


def test_a_robot_comes_back_when_it_has_to():
    taken = nobody()
    taken[2:4, 0] = 1
    taken[4:, 1:] = 1
    cells = route_aside(0, 0, 6, LINE, taken, 10)
    assert cells is not None
    assert cells.tolist() == [0, 0, 1, 1, 0, 0, 0]


def test_a_battery_that_is_too_short_keeps_a_robot_in_the_way():
    taken = nobody()
    taken[3:, :2] = 1
    assert route_aside(0, 0, 6, LINE, taken, 1) is None
    assert route_aside(0, 0, 6, LINE, taken, 2) is not None
