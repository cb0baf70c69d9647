"""The closest able robot takes each object."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents.assignment import Worker, assign
from adhoc.core.values import Capability, ObjectRecord


def book(name: str, x: float, mass: float = 1.0) -> ObjectRecord:
    return ObjectRecord(name, "Book", (x, 0.0, 0.5), mass=mass, is_pickupable=True)


def worker(name: str, x: float, *, able: bool = True, payload: float = 5.0, free: bool = True) -> Worker:
    return Worker(name, (x, 0.0), Capability(can_manipulate=able, payload=payload), free)


def test_the_closest_able_robot_takes_the_object():
    workers = [worker("near_unable", 1, able=False), worker("near_weak", 1.5, payload=0.5), worker("far", 4)]
    assert assign([book("b", 0)], workers) == {"far": "b"}


def test_each_robot_takes_one_object_and_the_rest_waits():
    assert assign([book("b1", 0), book("b2", 1), book("b3", 2)], [worker("r", 0.4)]) == {"r": "b1"}


def test_a_busy_robot_takes_nothing():
    assert assign([book("b", 0)], [worker("busy", 0, free=False), worker("other", 9)]) == {"other": "b"}


def test_two_objects_are_divided():
    assigned = assign([book("left", 0), book("right", 10)], [worker("a", 9), worker("b", 8)])
    assert assigned == {"a": "right", "b": "left"}


@given(
    st.lists(st.floats(0, 20), min_size=0, max_size=6),
    st.lists(st.floats(0, 20), min_size=0, max_size=6),
    st.randoms(use_true_random=False),
)
def test_the_order_of_hearing_does_not_matter(objects, workers, random):
    books = [book(f"b{i}", x) for i, x in enumerate(objects)]
    robots = [worker(f"r{i}", x) for i, x in enumerate(workers)]
    expected = assign(books, robots)
    random.shuffle(books)
    random.shuffle(robots)
    assert assign(books, robots) == expected
    assert len(expected) == min(len(books), len(robots))
