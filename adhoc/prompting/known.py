"""What the arguments of a reply may name: the ids that its prompt shows.

Schema and reader of a reply both ask here, so that a model is offered exactly what is accepted.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType

from adhoc.core.calls import ParameterKind
from adhoc.core.chat import ChatMessage
from adhoc.core.plans import Context
from adhoc.prompting.clean import name

FLOOR = "Floor"
"""The receptacle and receptacle type of what lies on the floor; always known."""
LONGEST_TYPE = 40
"""Characters of a receptacle type or room type that the robot has not met."""
_WORD = re.compile(r"""[^\s;,()\[\]{}<>"'/=]+""")
_END_OF_SENTENCE = ".:!?"

Finder = Callable[[str], str | None]


class Known:
    """The ids and types of one context, as far as its prompt shows them.

    A prompt lists the nearest and most urgent things only, and its messages may name others that the robot
    knows of: an id counts as shown where the rendered prompt has it, whatever section that is in, but for the
    task's examples, which tell of another house. An unknown receptacle type or room type is legal, since a
    robot may look for a place that it has not seen.

    Args:
        context: What the robot knows.
        prompt: The rendered prompt.
        told: Further ids by kind, which only others know of (see `told_by_teammates`).
    """

    def __init__(
        self,
        context: Context,
        prompt: Sequence[ChatMessage],
        told: Mapping[ParameterKind, Iterable[str]] = MappingProxyType({}),
    ) -> None:
        words = "\n".join(message.content for message in prompt)
        for example in context.task.examples.values():
            words = words.replace(example, "")
        text = _Text(words)
        held = [context.holding] if context.holding else []
        ids = {
            ParameterKind.OBJECT: [*(it.id for it in context.objects), *held],
            ParameterKind.RECEPTACLE: [FLOOR, *(it.id for it in context.objects if it.is_receptacle)],
            ParameterKind.ROOM: [it.id for it in context.rooms],
        }
        self._ids = {kind: _Shown([*names, *told.get(kind, ())], text) for kind, names in ids.items()}
        self._types: dict[ParameterKind, Finder] = {
            ParameterKind.RECEPTACLE_TYPE: _type_finder({it.category for it in context.objects} | {FLOOR}),
            ParameterKind.ROOM_TYPE: _type_finder({it.room_type for it in context.rooms if it.room_type}),
        }
        self._teammates = _Shown([view.name for view in context.teammates], text)

    def ids(self, kind: ParameterKind) -> tuple[str, ...] | None:
        """What an argument of that kind may be, as the prompt writes it; None for kinds that are open."""
        return self._ids[kind].names if kind in self._ids else None

    def find(self, kind: ParameterKind, wanted: str) -> str | None:
        """The id or type that a model means; None if there is none. Not for numbers.

        Names are found whatever their case, as long as only one name fits.
        """
        return self._ids[kind].find(wanted) if kind in self._ids else self._types[kind](wanted)

    @property
    def teammates(self) -> tuple[str, ...]:
        """The teammates' names, as the prompt writes them."""
        return self._teammates.names

    def find_teammate(self, wanted: str) -> str | None:
        """The name of the teammate that a model means; None if there is none."""
        return self._teammates.find(wanted)


def told_by_teammates(context: Context) -> Mapping[ParameterKind, Sequence[str]]:
    """The ids in the plans that teammates told, by kind.

    They may name what this robot has not seen: it can expect them to do it, but cannot do it itself.
    """
    sub_tasks = {spec.name: spec.parameters for spec in context.task.sub_tasks}
    sub_skills = {spec.name: spec.parameters for spec in context.task.sub_skills}
    found: dict[ParameterKind, list[str]] = {}
    for view in context.teammates:
        for call, vocabulary in ((view.sub_task, sub_tasks), (view.sub_skill, sub_skills)):
            if call is not None:
                for parameter, argument in zip(vocabulary.get(call.name, ()), call.args):
                    found.setdefault(parameter.kind, []).append(str(argument))
    return found


class _Shown:
    """Names of one kind that a text shows, and how to find the ids that they stand for.

    Cleaning may make two ids look alike; such a name stands for neither.
    """

    def __init__(self, ids: Iterable[str], text: _Text) -> None:
        looks = [(name(it), it) for it in dict.fromkeys(ids)]
        self._exact = _unambiguous((look, it) for look, it in looks if it == FLOOR or text.shows(look))
        self._folded = _unambiguous((look.casefold(), it) for look, it in self._exact.items())

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self._exact)

    def find(self, wanted: str) -> str | None:
        return self._exact.get(wanted) or self._folded.get(wanted.casefold())


class _Text:
    """A text that is asked for many names."""

    def __init__(self, text: str) -> None:
        self._text = text
        words = _WORD.findall(text)
        self._words = {*words, *(word.rstrip(_END_OF_SENTENCE) for word in words)}

    def shows(self, look: str) -> bool:
        """Whether the text has the name, and not just a longer one that contains it."""
        return look in self._words if _WORD.fullmatch(look) else self._shows_phrase(look)

    def _shows_phrase(self, look: str) -> bool:
        start = self._text.find(look) if look else -1
        while start >= 0:
            end = start + len(look)
            if not (_goes_on(self._text[start - 1 : start]) or _goes_on(self._text[end : end + 1])):
                return True
            start = self._text.find(look, end)
        return False


def _goes_on(neighbour: str) -> bool:
    return neighbour.isalnum() or neighbour in ("_", "|")


def _unambiguous(pairs: Iterable[tuple[str, str]]) -> Mapping[str, str]:
    found: dict[str, str] = {}
    twice: set[str] = set()
    for look, meant in pairs:
        if look in found:
            twice.add(look)
        found[look] = meant
    return {look: meant for look, meant in found.items() if look not in twice}


def _type_finder(types: Iterable[str]) -> Finder:
    """Finds a type among the known ones whatever its case and spacing, or takes it as a new one.

    Teammates may tell of types that look alike; then only the exact name will do.
    """
    exact = frozenset(types)
    folded = _unambiguous((_squeeze(it), it) for it in exact)

    def find(wanted: str) -> str | None:
        known = wanted if wanted in exact else folded.get(_squeeze(wanted))
        if known is not None:
            return known
        words = wanted.replace("_", " ").split()
        named = "".join(word[:1].upper() + word[1:] for word in words)
        return named if named.isalnum() and len(named) <= LONGEST_TYPE else None

    return find


def _squeeze(text: str) -> str:
    return text.replace(" ", "").replace("_", "").casefold()
