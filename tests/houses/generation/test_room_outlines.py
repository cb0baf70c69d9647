import numpy as np

from adhoc.houses.generation.floor_judging import OUTSIDE
from adhoc.houses.generation.room_outlines import Contact, find_contacts, outline_rooms

FLOOR = np.array([[0, 0, 1], [0, 2, 1], [0, 2, OUTSIDE]], dtype=np.int8)
"""x is the row, y the column: an L, a strip of two cells, and another that sticks out."""


def test_outlines_have_their_corners_only_and_go_round_clockwise():
    rooms = outline_rooms(FLOOR, ["Kitchen", "Bedroom", "Bathroom"], 2.0)
    assert [room.id for room in rooms] == ["room|2", "room|3", "room|4"]
    assert [room.room_type for room in rooms] == ["Kitchen", "Bedroom", "Bathroom"]
    assert rooms[0].polygon == ((0, 0), (0, 4), (2, 4), (2, 2), (6, 2), (6, 0))
    assert rooms[1].polygon == ((0, 4), (0, 6), (4, 6), (4, 4))
    assert rooms[2].polygon == ((2, 2), (2, 4), (6, 4), (6, 2))


def test_corners_are_whole_millimetres():
    (room,) = outline_rooms(np.zeros((3, 1), dtype=np.int8), ["Kitchen"], 1.7777)
    assert max(x for x, _ in room.polygon) == 5.333


def test_contacts_are_the_stretches_between_two_neighbours():
    contacts = find_contacts(FLOOR, 2.0)
    between = {contact.rooms: [] for contact in contacts}
    for contact in contacts:
        between[contact.rooms].append((contact.start, contact.end))
    assert between[0, 1] == [((0, 4), (2, 4))]
    assert sorted(between[0, 2]) == [((2, 2), (2, 4)), ((2, 2), (6, 2))]
    assert between[1, 2] == [((2, 4), (4, 4))]
    assert sorted(between[OUTSIDE, 0]) == [((0, 0), (0, 4)), ((0, 0), (6, 0)), ((6, 0), (6, 2))]
    assert sorted(between[OUTSIDE, 1]) == [((0, 4), (0, 6)), ((0, 6), (4, 6)), ((4, 4), (4, 6))]
    assert sorted(between[OUTSIDE, 2]) == [((4, 4), (6, 4)), ((6, 2), (6, 4))]


def test_points_of_a_contact():
    along_y = Contact((0, 1), (2.0, 1.0), (2.0, 4.0))
    assert along_y.length == 3.0
    assert along_y.point(0.1234) == (2.0, 1.123)
    assert Contact((0, 1), (2.0, 1.0), (5.0, 1.0)).point(0.5) == (2.5, 1.0)
