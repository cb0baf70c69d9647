"""How soon a newcomer was of use: the first object that it brought from a wrong place to a right one."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.evaluation.trace import TraceEvent


def first_help(events: Sequence[TraceEvent], newcomer: str, join_step: int) -> int | None:
    """Steps from joining until a misplaced object lay in a right place by the newcomer's own hand.

    The paper speaks of help and does not say what counts as such. Here it is what %PS counts: the newcomer
    puts down an object, and the referee sees it dealt with in that very step. Putting back what it took
    from a right place is none. Finding things and telling the others helps as well, but whose word made a
    teammate go cannot be told from outside; so a robot that cannot manipulate has None.

    Args:
        events: Those of the episode's trace, in their order.
        newcomer: Its name.
        join_step: The step in which it joined.

    Returns:
        At least 1; None if it never helped so.
    """
    in_place: set[str] = set()
    taken_from_place: set[str] = set()
    put_down: dict[str, int] = {}
    for event in events:
        thing = event.object_id
        if thing is None:
            continue
        if event.kind == "picked up":
            taken_from_place.discard(thing)
            if event.agent == newcomer and thing in in_place:
                taken_from_place.add(thing)
            in_place.discard(thing)
        elif event.kind == "put down" and event.agent == newcomer:
            put_down[thing] = event.step
        elif event.kind == "replaced":
            in_place.add(thing)
            if put_down.get(thing) == event.step and thing not in taken_from_place:
                return event.step - join_step
    return None
