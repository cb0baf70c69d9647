"""The division of errands on a row of cells, with costs counted by hand."""

from __future__ import annotations

import numpy as np
from test_oracle_fields import LINE

from adhoc.dataset.oracle.errands import Carrier, divide, tours

CELLS = {"a": 1, "b": 3}


def at(cell):
    return np.arange(4) == cell


def tours_of(carrier, home=0, moves=lambda lying: LINE):
    return tours(moves, ["a", "b"], carrier, lambda name, _: at(CELLS[name]), lambda *_: at(home))


def carrier(name="one", cell=0, steps_left=100, carries=("a", "b"), holds=None):
    return Carrier(name, cell, 1.6, steps_left, frozenset(carries), holds)


def test_a_tour_costs_its_moves_and_two_acts_for_each_object():
    found = tours_of(carrier())
    assert {"".join(sorted(key)): steps for key, (steps, _) in found.items()} == {
        "": 0,
        "a": 1 + 1 + 1 + 1,
        "b": 3 + 1 + 3 + 1,
        "ab": 12,
    }


def test_the_order_of_a_tour_is_the_shorter_one():
    assert tours_of(carrier(cell=3))[frozenset("ab")] == (5 + 4, ("b", "a"))


def test_what_is_held_is_put_away_first():
    found = tours_of(carrier(cell=2, holds="b"))
    assert found[frozenset("b")] == (3, ("b",))
    assert found[frozenset("ab")] == (3 + 4, ("b", "a"))
    assert frozenset("a") not in found


def test_what_a_robot_cannot_carry_is_in_none_of_its_tours():
    assert set(tours_of(carrier(carries=("b",)))) == {frozenset(), frozenset("b")}


def test_an_object_in_the_way_is_there_until_it_is_picked_up():
    blocked = LINE.copy()
    blocked[1, 0] = blocked[2, 1] = -1

    def moves(lying):
        return blocked if "a" in lying else LINE

    found = tours_of(carrier(), moves=moves)
    assert frozenset("b") not in found
    assert found[frozenset("ab")] == (12, ("a", "b"))


def cost_of(**shares):
    return {name: {frozenset(key): steps for key, steps in found.items()} for name, found in shares.items()}


def test_the_last_robot_is_done_as_early_as_possible():
    costs = cost_of(one={"": 0, "a": 4, "b": 8, "ab": 12}, two={"": 0, "a": 9, "b": 7, "ab": 16})
    division = divide(["a", "b"], [carrier("one"), carrier("two")], costs, 500)
    assert (division.orders, division.steps, division.left) == (
        {"one": ("a",), "two": ("b",)},
        7,
        frozenset(),
    )


def test_batteries_and_the_step_limit_bind():
    costs = cost_of(one={"": 0, "a": 4, "b": 8, "ab": 12})
    weak = divide(["a", "b"], [carrier("one", steps_left=8)], costs, 500)
    assert len(weak.left) == 1
    assert divide(["a", "b"], [carrier("one")], costs, 3).left == {"a", "b"}
    assert divide(["a", "b"], [carrier("one")], costs, 12).left == frozenset()


def test_as_few_objects_as_possible_are_left():
    costs = cost_of(one={"": 0, "a": 4, "ab": 90})
    assert divide(["a", "b"], [carrier("one")], costs, 500).steps == 90
