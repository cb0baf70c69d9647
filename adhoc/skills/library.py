"""The seven sub-skills of the paper by name."""

from __future__ import annotations

from collections.abc import Callable

from adhoc.skills.explore import Explore
from adhoc.skills.go_to import GoToObject, GoToPoint, GoToRoom
from adhoc.skills.pick_up import PickupObject
from adhoc.skills.put_object import PutObject
from adhoc.skills.skill import Skill
from adhoc.skills.stop import Stop


def standard_skills() -> dict[str, Callable[[], Skill]]:
    """Constructors of the paper's sub-skills (appendix, Description of Sub-Skills), with their defaults."""
    return {
        "GoToObject": GoToObject,
        "GoToPoint": GoToPoint,
        "GoToRoom": GoToRoom,
        "PickupObject": PickupObject,
        "PutObject": PutObject,
        "Explore": Explore,
        "Stop": Stop,
    }
