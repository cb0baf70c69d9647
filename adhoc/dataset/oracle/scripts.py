"""From a plan to the actions of every step."""

from __future__ import annotations

from collections.abc import Mapping

from adhoc.core.values import Action, ActionName
from adhoc.dataset.oracle.legs import Leg
from adhoc.dataset.oracle.plans import Plan
from adhoc.dataset.oracle.situation import Situation
from adhoc.dataset.oracle.stances import AIMS, TILTS, Deed, action_of
from adhoc.houses.house import FLOOR


def script_of(plan: Plan, situation: Situation, heights: Mapping[str, float]) -> list[dict[str, Action]]:
    """The actions of each step by robot; who waits is left out.

    `heights` are the camera heights of all robots, in metres; robots act in that order.
    """
    script: list[dict[str, Action]] = [{} for _ in range(plan.steps)]
    for name, height in heights.items():
        legs, route = iter(plan.legs.get(name, ())), plan.routes[name]
        for actions, deed, stance in zip(script, route.deeds, route.stances):
            if deed == Deed.ACT:
                actions[name] = _act(next(legs), situation, height, stance)
                continue
            action = action_of(Deed(deed), stance % AIMS // TILTS)
            if action is not None:
                actions[name] = action
    return script


def _act(leg: Leg, situation: Situation, height: float, stance: int) -> Action:
    if leg.picks_up:
        return Action(ActionName.PICK_UP, leg.object_id)
    target = situation.target_at(leg.object_id, height, stance)
    return Action(ActionName.DROP) if target == FLOOR else Action(ActionName.PUT_DOWN, target)
