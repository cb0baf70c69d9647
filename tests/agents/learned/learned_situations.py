"""Situations to vary."""

from __future__ import annotations

import math
from dataclasses import replace

from adhoc.agents.learned.situation import Detection, Other, OwnState, Situation
from adhoc.core.values import Capability, Pose

OWN = OwnState(
    name="b",
    capability=Capability(can_manipulate=True, camera_height=1.6, payload=10.0, max_steps=500),
    pose=Pose(1.0, 2.0, math.pi / 2),
    step=50,
    steps_left=250,
    holding=False,
    place_known=False,
    idle=False,
    frontiers=3,
    rooms_known=4,
    rooms_explored=1,
    room_types={"Kitchen": 0.75, "Bedroom": 0.25},
)
MUG = Detection("mug", (1.0, 5.0), 0.5, last_seen=40, handled=False, given_up=False, certainty=0.75)
FRIEND = Other("a", (1.0, 4.0), Capability(can_manipulate=True, payload=5.0), False, False, False)


def situation(detections=(), others=(), **own):
    """`OWN` with changes, and what is around it."""
    return Situation(replace(OWN, **own), tuple(detections), tuple(others))
