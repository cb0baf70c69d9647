"""What a person's words may name: what the robot knows, by id, by short number, or by type."""

from __future__ import annotations

from collections.abc import Iterable

from adhoc.agents.human.short_numbers import ShortNumbers
from adhoc.agents.memory import Memory
from adhoc.core.calls import Argument, Call, CallSpec, Parameter, ParameterKind
from adhoc.core.errors import CommandError, ReplyError
from adhoc.houses.house import FLOOR
from adhoc.prompting.clean import one_line
from adhoc.prompting.read_call import read_number

_TYPES = (ParameterKind.RECEPTACLE_TYPE, ParameterKind.ROOM_TYPE)
_SHOWN = 60


class ArgumentCountError(CommandError):
    """There are more arguments than a call takes, or fewer."""


class Names:
    """Turns words into arguments.

    Args:
        memory: What the robot knows.
        numbers: Short numbers of ids.
    """

    def __init__(self, memory: Memory, numbers: ShortNumbers) -> None:
        self._memory, self._numbers = memory, numbers

    def call(self, spec: CallSpec, words: list[str]) -> Call:
        """The call of this kind with these arguments.

        What is plain need not be said: the object in the hand as the first of the arguments, the room of a
        named receptacle as the last. Raises CommandError, ArgumentCountError for too few or many.
        """
        parameters = list(spec.parameters)
        held = self._memory.held
        kinds = [parameter.kind for parameter in parameters]
        if len(words) < len(kinds) and held is not None and kinds[0] is ParameterKind.OBJECT:
            words = [held.id, *words]
        if len(words) == len(kinds) - 1 and kinds[-2:] == [ParameterKind.RECEPTACLE, ParameterKind.ROOM]:
            words = [*words, self._room_of(words[-1])]
        if len(words) != len(parameters):
            count = f"{len(parameters)} argument{'' if len(parameters) == 1 else 's'}"
            raise ArgumentCountError(f"{spec.signature} takes {count}, not {len(words)}.")
        return Call(spec.name, tuple(map(self._argument, words, parameters)))

    def target(self, word: str) -> str:
        """The object or receptacle of a low-level action. Raises CommandError."""
        return str(self._argument(word, Parameter("target", ParameterKind.OBJECT)))

    def _argument(self, word: str, parameter: Parameter) -> Argument:
        kind = parameter.kind
        if kind is ParameterKind.NUMBER:
            try:
                return read_number(word, f"<{parameter.name}>")
            except ReplyError as error:
                raise CommandError(f"{error}.") from error
        if kind in _TYPES:
            return self._type(word, parameter)
        found = self._find(word, self._ids(kind))
        if found is None:
            raise CommandError(f"your robot knows no {kind.value} {one_line(word, _SHOWN)!r}.")
        return found

    def _find(self, word: str, ids: list[str]) -> str | None:
        """The id of a short number, or the one that is spelt so, whatever its case."""
        numbered = self._numbers.id(word)
        if numbered in ids:
            return numbered
        if word in ids:
            return word
        alike = [it for it in ids if it.casefold() == word.casefold()]
        return alike[0] if len(alike) == 1 else None

    def _ids(self, kind: ParameterKind) -> list[str]:
        if kind is ParameterKind.ROOM:
            return list(self._memory.perception.rooms)
        objects = self._memory.perception.objects
        if kind is ParameterKind.RECEPTACLE:
            return [FLOOR, *(it.id for it in objects.values() if it.is_receptacle)]
        held = self._memory.held
        return [*objects, *([] if held is None else [held.id])]

    def _type(self, word: str, parameter: Parameter) -> str:
        if parameter.kind is ParameterKind.ROOM_TYPE:
            known: Iterable[str | None] = (it.room_type for it in self._memory.perception.rooms.values())
        else:
            known = (it.category for it in self._memory.receptacles())
        for name in sorted({it for it in known if it}):
            if name.casefold() == word.casefold():
                return name
        if not word.isalnum():
            raise CommandError(f"<{parameter.name}> must be one word, not {one_line(word, _SHOWN)!r}.")
        return word[:1].upper() + word[1:]

    def _room_of(self, receptacle: str) -> str:
        found = self._memory.record(self._find(receptacle, self._ids(ParameterKind.RECEPTACLE)) or "")
        if found is None or found.room is None:
            raise CommandError(f"which room {one_line(receptacle, _SHOWN)!r} is in must be said.")
        return found.room
