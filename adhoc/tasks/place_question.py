"""One question about where things belong: what is asked, and what is read from the reply."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from adhoc.core.errors import ReplyError
from adhoc.core.replies import DUPLICATE, ILLEGAL, UNKNOWN_ID, UNREADABLE, Fault, Reading, ReplyFormat
from adhoc.core.values import Place
from adhoc.prompting import clean
from adhoc.prompting.extract import read_object
from adhoc.prompting.read_call import shown
from adhoc.prompting.reply_schema import bounded_list, closed_object, one_of


@dataclass(frozen=True)
class PlaceQuestion:
    """In which of these receptacle types, in which of these room types, do objects of a category belong?"""

    category: str
    receptacles: tuple[str, ...]
    room_types: tuple[str, ...]

    @property
    def told(self) -> Mapping[str, Any]:
        """What the prompt says, by the names of the template's variables: each name as it may stand there."""
        return {
            "category": clean.name(self.category),
            "receptacles": _clean(self.receptacles),
            "room_types": _clean(self.room_types),
        }

    @property
    def reply(self) -> ReplyFormat:
        """The form of the answer; its value are the `Place`s named, in order."""
        return ReplyFormat("places", self._schema, self.read)

    def read(self, text: str) -> Reading:
        """The places that a reply names, as `tuple[Place, ...]`.

        Names are compared without regard to case, blanks, `-` and `_`. An entry that is unknown, ill-formed
        or there before is a fault, and the others count.

        Raises ReplyError if there is no list of places, or entries and none of use.
        """
        entries = read_object(text).get("places")
        if not isinstance(entries, list):
            raise ReplyError(f"field 'places' must be a list, not {shown(entries)}", UNREADABLE)
        most = len(self.receptacles) * len(self.room_types)
        if len(entries) > most:
            raise ReplyError(f"field 'places' has {len(entries)} entries; there are {most} places", ILLEGAL)
        places: dict[Place, None] = {}
        faults: list[Fault] = []
        for entry in entries:
            for found in self._read_entry(entry):
                if isinstance(found, Fault):
                    faults.append(found)
                elif found in places:
                    faults.append(Fault(DUPLICATE, f"{found.receptacle} in {found.room_type} is there twice"))
                else:
                    places[found] = None
        if faults and not places:
            raise ReplyError(faults[0].detail, faults[0].outcome)
        return Reading(tuple(places), tuple(faults))

    def _read_entry(self, entry: object) -> Iterator[Place | Fault]:
        fields = entry if isinstance(entry, dict) else {}
        receptacle, room_types = fields.get("receptacle"), fields.get("room_types")
        if not isinstance(receptacle, str) or not isinstance(room_types, list) or not room_types:
            yield Fault(
                ILLEGAL, f"an entry of 'places' needs a 'receptacle' and 'room_types': {shown(entry)}"
            )
            return
        known = _find(receptacle, self.receptacles)
        if known is None:
            yield Fault(UNKNOWN_ID, f"{shown(receptacle)} is none of the receptacle types")
            return
        for name in room_types[: len(self.room_types) + 1]:
            room_type = _find(name, self.room_types) if isinstance(name, str) else None
            if room_type is None:
                yield Fault(UNKNOWN_ID, f"{shown(name)} is none of the room types")
            else:
                yield Place(known, room_type)

    @property
    def _schema(self) -> Mapping[str, Any]:
        room_types = bounded_list(one_of(_clean(self.room_types)), 1, len(self.room_types))
        place = closed_object({"receptacle": one_of(_clean(self.receptacles)), "room_types": room_types})
        return closed_object({"places": bounded_list(place, 0, len(self.receptacles))})


def _clean(names: Iterable[str]) -> list[str]:
    return [clean.name(name) for name in names]


def _find(text: str, names: Iterable[str]) -> str | None:
    wanted = _plain(text)
    return next((name for name in names if _plain(clean.name(name)) == wanted), None)


def _plain(text: str) -> str:
    return text.casefold().replace(" ", "").replace("_", "").replace("-", "")
