"""Stage 2 of the offline reasoner: what each generated sub-task would do for the team."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from adhoc.llm.offline.facts import CallText, Facts, ObjectFact, SpecFact
from adhoc.llm.offline.knowledge import failures

_RIVAL = 5.0
"""Metres that a free teammate counts who is nearer and as able, or stands in the room already."""
_SEARCH = 10.0
"""Metres that a receptacle counts of which none is known: it must be found first."""

NOTHING, FINDING, SETTLING, FINISHING = range(4)
"""Progress of the task: none; something may be found; a thing is settled; a thing in the hand is settled."""


class Effect(NamedTuple):
    """What doing one candidate would mean, best first in the order of `worth`."""

    call: CallText
    obstacle: str | None
    """Why this robot is not able to do it, or why it is of no use."""
    conflict: str | None
    """Whose work it would repeat."""
    progress: int
    way: float
    """Metres to go and to carry, and what counts as much."""

    @property
    def hopeless(self) -> bool:
        """Whether it would help nobody."""
        return self.obstacle is not None or self.conflict is not None

    @property
    def worth(self) -> tuple[bool, bool, int, float]:
        """Sorts the best first: possible, without conflict, more progress, less way."""
        return self.obstacle is not None, self.conflict is not None, -self.progress, self.way

    def __str__(self) -> str:
        outcome = ("brings nothing", "may find something", "settles a thing", "finishes what is in my hand")
        return (
            f"{self.call}: {self.obstacle or self.conflict or f'{outcome[self.progress]}, {self.way:.1f} m'}"
        )


def evaluate(facts: Facts) -> tuple[Effect, ...]:
    """The effect of every generated sub-task, in the order of the prompt.

    Generation (`offline.options`) fills the vocabulary, and prefers by kind and by the way to the thing.
    Here each candidate stands for itself, as the prompt lists it, whoever generated it: the call is looked up
    among the facts, and weighed by this robot's ability, by what the teammates are at, hold and could do, by
    the progress that it brings, and by the whole way, carrying included. Memory of failures makes the way
    longer. No code, order or place of generation enters, and no prior knowledge of where things belong.
    """
    return tuple(_effect(facts, call) for call in facts.candidates)


def _effect(facts: Facts, call: CallText) -> Effect:
    spec = next((it for it in facts.sub_tasks if it.name == call.name), None)
    if spec is None or len(spec.parameters) != len(call.args):
        return Effect(call, "it is not in the list of sub-tasks", None, NOTHING, 0.0)
    arguments = dict(zip(spec.parameters.values(), call.args))
    thing = _thing(facts, arguments.get("object id"))
    obstacle = _inability(facts, spec, arguments, thing) or _needlessness(facts, arguments, thing)
    conflict = next(_conflicts(facts, arguments), None)
    return Effect(
        call, obstacle, conflict, _progress(facts, arguments, thing), _way(facts, spec, arguments, thing)
    )


def _thing(facts: Facts, identifier: str | None) -> ObjectFact | None:
    return next((it for it in facts.objects if it.id == identifier), None)


def _inability(
    facts: Facts, spec: SpecFact, arguments: dict[str, str], thing: ObjectFact | None
) -> str | None:
    identifier = arguments.get("object id")
    if spec.needs_manipulation and not facts.manipulation:
        return "I have no manipulation ability"
    if spec.needs_manipulation and facts.holding not in (None, identifier):
        return f"my hand is full with {facts.holding}"
    if identifier is not None and thing is None and identifier != facts.holding:
        return f"I know of no {identifier}"
    if thing is not None and thing.mass > facts.payload:
        return f"{thing.id} weighs more than I can lift"
    return None


def _needlessness(facts: Facts, arguments: dict[str, str], thing: ObjectFact | None) -> str | None:
    if thing is not None and thing.attention is False and thing.id != facts.holding:
        return f"{thing.id} needs no attention"
    room = arguments.get("room id")
    if "object id" not in arguments and any(it.id == room and it.explored for it in facts.rooms):
        return f"{room} is explored"
    return None


def _conflicts(facts: Facts, arguments: dict[str, str]) -> Iterator[str]:
    """What teammates hold, or are at by sub-task or sub-skill."""
    for kind in ("object id", "room id"):
        for teammate in facts.teammates:
            if arguments.get(kind) in teammate.claims:
                yield f"{teammate.name} is at {arguments[kind]}"


def _progress(facts: Facts, arguments: dict[str, str], thing: ObjectFact | None) -> int:
    if "object id" in arguments:
        if arguments["object id"] == facts.holding:
            return FINISHING
        return SETTLING if thing is not None and thing.attention else FINDING
    return FINDING if arguments else NOTHING


def _way(facts: Facts, spec: SpecFact, arguments: dict[str, str], thing: ObjectFact | None) -> float:
    way = 0.0
    if thing is not None and thing.id != facts.holding:
        way += thing.distance + _RIVAL * _rivals(facts, spec, thing)
    if "receptacle type" in arguments:
        way += _carrying(facts, arguments)
    room = next((it for it in facts.rooms if it.id == arguments.get("room id")), None)
    if room is not None and thing is None:
        way += room.distance + _RIVAL * sum(1 for it in facts.teammates if it.room == room.id)
    subject = arguments.get("object id") or arguments.get("room id")
    return way * (1 + failures(facts, subject)) if subject else way


def _carrying(facts: Facts, arguments: dict[str, str]) -> float:
    """The distance of the nearest known receptacle of the wanted type in a room of the wanted type."""
    wanted = arguments.get("room type")
    known: Sequence[float] = [
        it.distance
        for it in facts.receptacles.get(arguments["receptacle type"], ())
        if wanted is None or it.room_type == wanted
    ]
    return min(known, default=_SEARCH)


def _rivals(facts: Facts, spec: SpecFact, thing: ObjectFact) -> int:
    """Teammates with a free hand that are nearer to the thing and able to do the same."""
    if thing.position is None:
        return 0
    x, y = thing.position
    return sum(
        1
        for it in facts.teammates
        if it.holding is None
        and it.position is not None
        and (it.position[0] - x) ** 2 + (it.position[1] - y) ** 2 < thing.distance**2
        and (not spec.needs_manipulation or (it.manipulation and it.payload >= thing.mass))
    )
