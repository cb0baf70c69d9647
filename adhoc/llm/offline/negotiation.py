"""What speaks against the plans that teammates have made, by what the prompt says."""

from __future__ import annotations

from collections.abc import Iterator

from adhoc.llm.offline.facts import CallText, Facts, TeammateFact


def disagreements(facts: Facts) -> Iterator[tuple[str, str]]:
    """Whose plan should be made again, and why: it is beyond that teammate's ability, somebody has the thing
    in the hand already, or an earlier plan is about the same thing."""
    teammates = {it.name: it for it in facts.teammates}
    taken: dict[str, str] = {}
    for name, call in facts.plans.items():
        teammate = teammates.get(name)
        if teammate is None:
            continue
        reason = _beyond(facts, teammate, call) or _in_a_hand(facts, teammate, call)
        things = _things(facts, call)
        reason = reason or next((f"{taken[it]} plans to handle {it}" for it in things if it in taken), None)
        if reason is not None:
            yield name, reason
        else:
            taken.update(dict.fromkeys(things, name))


def _beyond(facts: Facts, teammate: TeammateFact, call: CallText) -> str | None:
    spec = next((it for it in facts.sub_tasks if it.name == call.name), None)
    if spec is None or not spec.needs_manipulation:
        return None
    if not teammate.manipulation:
        return f"{teammate.name} cannot manipulate"
    masses = {it.id: it.mass for it in facts.objects}
    heavy = next((it for it in call.args if masses.get(it, 0.0) > teammate.payload), None)
    return None if heavy is None else f"{heavy} is too heavy for {teammate.name}"


def _in_a_hand(facts: Facts, teammate: TeammateFact, call: CallText) -> str | None:
    if facts.holding is not None and facts.holding in call.args:
        return f"I hold {facts.holding}"
    holders = (it for it in facts.teammates if it.name != teammate.name and it.holding in call.args)
    holder = next(holders, None)
    return None if holder is None else f"{holder.name} holds {holder.holding}"


def _things(facts: Facts, call: CallText) -> tuple[str, ...]:
    """The ids of objects that a plan is about."""
    spec = next((it for it in facts.sub_tasks if it.name == call.name), None)
    kinds = () if spec is None else spec.parameters.values()
    return tuple(value for kind, value in zip(kinds, call.args) if kind == "object id")
