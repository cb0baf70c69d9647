"""A bound from below: fewer steps than these no team needs that hands nothing over."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.dataset.oracle.errands import Carrier, divide, tours
from adhoc.dataset.oracle.knowledge import Rules
from adhoc.dataset.oracle.situation import Situation
from adhoc.evaluation.scenario import Member
from adhoc.worlds.world import World


def least_steps(
    situation: Situation, world: World, members: Sequence[Member], max_steps: int, rules: Rules
) -> int | None:
    """The steps of the best division if everything was easier than it is; None if even then there is none.

    Easier: robots pass through each other and through what lies on the floor, never turn, pick an object up
    from any cell within reach of its outline that no wall parts from it, and put it away in the same manner
    at any right place, with room or without. Batteries and `max_steps` count. Nothing real is faster
    unless it puts something down on the way, for another robot or for later.
    """
    agents = world.agents()
    lattice = situation.lattice
    near = {name: situation.near(name) for name in situation.objects}
    places = {name: situation.near_places(name) for name in situation.objects}
    carriers = []
    for member in members:
        ability, pose = member.capability, agents[member.name].pose
        cell = lattice.cell_at(pose.x, pose.y)
        if not ability.can_manipulate or cell is None:
            continue
        carries = frozenset(
            name
            for name in situation.objects
            if situation.house.mass(name) * rules.mass_scale <= ability.payload
        )
        carriers.append(Carrier(member.name, cell, ability.camera_height, ability.max_steps, carries))
    known = {
        carrier.name: tours(
            lambda _: lattice.moves(()),
            situation.objects,
            carrier,
            lambda name, _: near[name],
            lambda name, _: places[name],
        )
        for carrier in carriers
    }
    costs = {name: {share: steps for share, (steps, _) in found.items()} for name, found in known.items()}
    division = divide(situation.objects, carriers, costs, max_steps)
    return None if division.left else division.steps
