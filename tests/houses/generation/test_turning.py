from adhoc.houses.facts import asset, assets_of
from adhoc.houses.generation.pieces import Piece, rotated
from adhoc.houses.generation.room_furnishing import Placed
from adhoc.houses.generation.turned_boxes import are_apart, rows_of
from adhoc.houses.generation.turning import turned_askew
from adhoc.houses.generation.walkways import Walkways
from adhoc.houses.house import Room
from adhoc.houses.procthor_writing import raise_walls

ROOM = Room("room|2", "LivingRoom", ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)))
CHAIR = assets_of("Chair")[0]
TABLE = "Dining_Table_203_1"


def stand(name, x, y, sway=0.0, turn=0):
    entry = asset(name)
    return Placed(Piece(entry, x, y, 0.0, turn, entry.size), None, sway)


def walkways_with(placed, room=ROOM):
    walls, _ = raise_walls([room], 2.5)
    walkways = Walkways([room], walls)
    for entry in placed:
        straight = entry.piece.straight()
        walkways.block(straight.rectangle, entry.piece.askew)
    return walkways


def turn(placed, kept_free=()):
    return turned_askew(placed, ROOM, walkways_with(placed), kept_free)


def test_what_has_space_is_turned_by_its_sway_and_the_rest_stays():
    before = [stand(CHAIR, 1.0, 1.0, 20.5), stand(CHAIR, 2.5, 2.5)]
    first, second = turn(before)
    assert first.piece.askew == 20.5
    assert first.piece.straight() == before[0].piece
    assert second == before[1]


def test_robots_find_it_turned():
    before = [stand("Armchair_203_1", 2.0, 2.0, 41.0)]
    walkways = walkways_with(before)
    straight = walkways.reached()
    after = turned_askew(before, ROOM, walkways, ())
    assert after[0].piece.askew == 41.0
    assert (walkways.reached() == walkways_with(after).reached()).all()
    assert (walkways.reached() != straight).any()


def test_near_a_wall_it_turns_less_or_not_at_all():
    width, _, _ = asset(CHAIR).size
    ((free),) = turn([stand(CHAIR, width / 2 + 0.2, 2.0, 30.0)])
    assert free.piece.askew == 30.0
    ((close),) = turn([stand(CHAIR, width / 2 + 0.06, 2.0, 30.0)])
    assert abs(close.piece.askew) in (10.0, 20.0)
    assert close.piece.rectangle[0] > 0.015 - 1e-9
    ((tight),) = turn([stand(CHAIR, width / 2 + 0.016, 2.0, 30.0)])
    assert tight.piece.askew == 0.0


def test_it_keeps_off_what_must_stay_free():
    width, _, _ = asset(CHAIR).size
    chair = stand(CHAIR, 2.0, 2.0, 30.0)
    edge = 2.0 + width / 2 + 0.006
    ((turned),) = turn([chair], [(edge, 0.0, 4.0, 4.0)])
    assert turned.piece.askew == 0.0
    ((turned),) = turn([chair], [(edge + 0.3, 0.0, 4.0, 4.0)])
    assert turned.piece.askew == 30.0


def test_neighbours_stay_clear_of_each_other_as_they_are_turned():
    width, _, _ = asset(CHAIR).size
    beside = [0.8, 0.8 + width + 0.03, 0.8 + 2 * width + 0.23, 0.8 + 3 * width + 0.43]
    row = [stand(CHAIR, x, 2.0, 25.0 * (-1) ** k) for k, x in enumerate(beside)]
    after = turn([*row, stand(TABLE, 2.0, 3.2)])
    assert 0 < sum(abs(entry.piece.askew) == 25.0 for entry in after) < 4
    for k, one in enumerate(after):
        for other in after[k + 1 :]:
            assert are_apart(rows_of(one.piece), rows_of(other.piece), 0.005)


def test_what_would_block_a_way_stays_straight():
    # A long piece leaves a passage from x = 1.28 to 1.74 along the wall: robots of 0.42 m pass, but not
    # by a piece that is askew. In a broader room it is turned.
    width, depth, _ = asset(TABLE).size
    assert width > depth
    table = stand(TABLE, 1.28 - depth / 2, 1.6, 12.0, turn=1)
    assert table.piece.rectangle[0] > 0.2
    for breadth, askew in ((1.75, 0.0), (2.25, 12.0)):
        room = Room("room|2", "LivingRoom", ((0.0, 0.0), (breadth, 0.0), (breadth, 3.2), (0.0, 3.2)))
        walkways = walkways_with([table], room)
        ((after),) = turned_askew([table], room, walkways, ())
        assert after.piece.askew == askew
        assert (walkways.reached() == walkways_with([after], room).reached()).all()


def test_the_opposite_angle_is_tried_before_smaller_ones():
    # A post stands where a corner of the chair would come.
    width, depth, _ = asset(CHAIR).size
    x, y = rotated(width / 2, depth / 2, 30.0)
    post = (2.0 + x - 0.01, 2.0 + y - 0.01, 2.0 + x + 0.01, 2.0 + y + 0.01)
    ((turned),) = turn([stand(CHAIR, 2.0, 2.0, 30.0)], [post])
    assert turned.piece.askew == -30.0
