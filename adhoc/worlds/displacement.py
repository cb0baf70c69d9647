"""Moving an object by an unseen hand, to set up a scenario."""

from __future__ import annotations

from adhoc.core.errors import WorldError
from adhoc.core.streams import stream
from adhoc.houses.house import FLOOR
from adhoc.houses.solids import SolidKind
from adhoc.worlds.placement import Placer, Places, shuffled
from adhoc.worlds.scene import Scene, Thing


def displace(scene: Scene, placer: Placer, object_id: str, receptacle_id: str, seed: int) -> bool:
    """Move an object to a random free place of a receptacle, `Floor` (any room's) or one room's floor.

    False, with the object where it was, if no place is free, or if the object is held or holds others.
    Raises WorldError if the house has no such object or receptacle.
    """
    thing = scene.things.get(object_id)
    if thing is None or not thing.pickupable:
        raise WorldError(f"displace: {object_id!r} is not a pickupable object of this house")
    if receptacle_id != FLOOR and receptacle_id not in scene.things:
        raise WorldError(f"displace: {receptacle_id!r} is neither {FLOOR!r} nor an object of this house")
    if thing.holder is not None or scene.contents(thing) or object_id == receptacle_id:
        return False
    before, receptacle_before, room_before = thing.placement, thing.receptacle, thing.room
    scene.take(thing, None)
    candidates, receptacle = _candidates(scene, placer, thing, receptacle_id)
    generator = stream(seed, "displace", object_id, receptacle_id)
    if placer.put(thing, shuffled(candidates, generator), receptacle):
        return True
    scene.put(thing, before, receptacle_before)
    thing.room = room_before
    return False


def _candidates(scene: Scene, placer: Placer, thing: Thing, receptacle_id: str) -> tuple[Places, str]:
    if receptacle_id == FLOOR:
        targets = [floor for floor in scene.things.values() if floor.kind is SolidKind.FLOOR]
    else:
        targets = [scene.things[receptacle_id]]
    surfaces = [surface for target in targets if target.holder is None for surface in target.surfaces]
    is_floor = all(target.kind is SolidKind.FLOOR for target in targets)
    return placer.on_surfaces(thing, surfaces), FLOOR if is_floor else receptacle_id
