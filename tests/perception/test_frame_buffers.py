from __future__ import annotations

from dataclasses import replace

from tiny_scene import TinyScene

from adhoc.core.values import Label, Observation, Pose
from adhoc.perception.frame_buffers import FrameBuffers
from adhoc.perception.object_table import ObjectTable

LOOK: Observation = TinyScene({}).look(Pose(0.0, 0.0), size=4)
APPLE, BOOK = Label("Apple|1", "Apple"), Label("Book|1", "Book")


def slots_after(*frames: tuple[dict[int, Label], str | None]) -> tuple[dict[int, int], ObjectTable]:
    """The slots of instances after some frames, each given by its labels and by what is held."""
    buffers, table = FrameBuffers(), ObjectTable()
    for labels, held in frames:
        buffers.read_labels(replace(LOOK, labels=labels, held=held), table)
    return {key: slot for key, slot in enumerate(buffers.slot_of.tolist()) if slot >= 0}, table


def test_an_instance_that_left_the_frame_has_no_slot():
    slots, _ = slots_after(({3: APPLE, 5: BOOK}, None), ({5: BOOK}, None))
    assert slots == {5: 1}


def test_an_instance_number_may_come_to_mean_another_object():
    slots, table = slots_after(({3: APPLE}, None), ({3: BOOK}, None))
    assert slots == {3: table.slots["Book|1"]}


def test_what_is_in_the_hand_has_no_slot_until_it_is_put_down():
    frame = {3: APPLE, 5: BOOK}
    assert slots_after((frame, None), (frame, APPLE.id))[0] == {5: 1}
    assert slots_after((frame, None), (frame, APPLE.id), (frame, None))[0] == {3: 0, 5: 1}


def test_large_instance_numbers_keep_the_slots_of_small_ones():
    slots, _ = slots_after(({3: APPLE}, None), ({3: APPLE, 5000: BOOK}, None))
    assert slots == {3: 0, 5000: 1}
