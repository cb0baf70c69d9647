import math

import numpy as np
import pytest

from adhoc.houses.facts import assets_of
from adhoc.houses.facts_furniture import furniture_groups
from adhoc.houses.generation.furniture_groups import arrange, largest_size, single

BAT = assets_of("BaseballBat")[0]
GROUPS = {group.name: group for group in furniture_groups()}


def arrangements(name, count=25):
    generator = np.random.default_rng(3)
    found = [arrange(GROUPS[name], generator) for _ in range(count)]
    return [arrangement for arrangement in found if arrangement is not None]


def of(pieces, category):
    return [piece for piece in pieces if piece.facts.category == category]


def faces(piece, other) -> bool:
    """Whether the other's middle is ahead of the piece."""
    dx, dy = piece.front
    return dx * (other.x - piece.x) + dy * (other.y - piece.y) > 0


@pytest.mark.parametrize("chairs", range(1, 8))
def test_chairs_stand_around_their_table_and_face_it(chairs):
    name = "chair-diningtable" + (f"-{chairs}" if chairs > 1 else "")
    # The group called 5 has four chairs, 6 has five and 7 has six.
    expected = chairs if chairs < 5 else chairs - 1
    found = arrangements(name)
    assert found
    for arrangement in found:
        (table,) = of(arrangement.pieces, "DiningTable")
        seats = of(arrangement.pieces, "Chair")
        assert len(seats) == expected
        assert len({seat.facts.asset for seat in seats}) == 1
        assert all(faces(seat, table) for seat in seats)


@pytest.mark.parametrize("turn", range(4))
def test_the_sofa_and_the_television_face_each_other_however_the_group_is_turned(turn):
    for arrangement in arrangements("television-sofa-armchair-2"):
        pieces = arrangement.placed(3.0, 4.0, turn)
        (television,), (stand,), (sofa,) = (of(pieces, name) for name in ("Television", "TVStand", "Sofa"))
        assert faces(sofa, television)
        assert faces(television, sofa)
        assert television.bottom == pytest.approx(stand.size[2] + 0.001)
        assert arrangement.carried[arrangement.pieces.index(of(arrangement.pieces, "Television")[0])] == 0
        apart = math.hypot(sofa.x - stand.x, sofa.y - stand.y)
        assert apart - sofa.size[1] / 2 - stand.size[1] / 2 == pytest.approx(2.23, abs=0.01)
        assert not any(
            faces(chair, television) is False and faces(chair, sofa) is False for chair in pieces[3:]
        )


def test_the_chair_faces_its_desk():
    for arrangement in arrangements("desk-with-chair"):
        (desk,), (chair,) = of(arrangement.pieces, "Desk"), of(arrangement.pieces, "Chair")
        assert faces(chair, desk) or chair.turn in (1, 3)
        assert chair.y > desk.y


def test_pillows_lie_on_the_mattress_at_the_head():
    for arrangement in arrangements("double-pillow"):
        (bed,) = of(arrangement.pieces, "Bed")
        pillows = of(arrangement.pieces, "Pillow")
        assert len(pillows) == 2
        for pillow in pillows:
            assert pillow.bottom == pytest.approx(max(part.z for part in bed.supports()) + 0.001)
            assert pillow.y < bed.y


def test_no_member_cuts_another():
    for group in GROUPS.values():
        for arrangement in arrangements(group.name, 10):
            pieces = arrangement.pieces
            for i, first in enumerate(pieces):
                for second in pieces[i + 1 :]:
                    for one in first.boxes():
                        for other in second.boxes():
                            deep = min(
                                min(one[k + 3], other[k + 3]) - max(one[k], other[k]) for k in range(3)
                            )
                            assert deep <= 0, (group.name, first.facts.asset, second.facts.asset)


def test_the_extents_enclose_every_member_about_the_origin():
    for group in GROUPS.values():
        for arrangement in arrangements(group.name, 5):
            for piece in arrangement.pieces:
                x0, y0, x1, y1 = piece.rectangle
                assert max(abs(x0), abs(x1)) <= arrangement.width / 2 + 1e-9
                assert max(abs(y0), abs(y1)) <= arrangement.depth / 2 + 1e-9


def test_the_largest_size_is_that_of_the_broadest_and_of_the_deepest_asset_that_count():
    # The broadest stand is outsized; the broadest television reaches beyond the others.
    width, depth = largest_size(GROUPS["television"])
    assert (width, depth) == pytest.approx((1.703, 0.8968), abs=1e-3)


def test_a_single_piece_and_a_lying_one():
    upright = single(BAT)
    lying = single(BAT, lying=True)
    assert (lying.width, lying.depth) == (upright.pieces[0].size[2], upright.depth)
