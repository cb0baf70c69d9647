"""The houses that the package brings along, in ProcTHOR's own format.

Their layouts are declared in `scripts/make_samples.py`: nothing is misplaced in them, and no two things
penetrate each other.
"""

from __future__ import annotations

from pathlib import Path

from adhoc.core.errors import HouseError
from adhoc.houses.house import House
from adhoc.houses.procthor import read_house

FOLDER = Path(__file__).parent / "samples"


def sample_names() -> tuple[str, ...]:
    """The names of the sample houses, sorted."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.json")))


def sample_house(name: str) -> House:
    """A sample house. Raises HouseError if there is none of that name.

    `corridor` is after the paper's physical set-up, two rooms joined by a corridor; `one_room`, `four_rooms`
    and `eight_rooms` are of ProcTHOR's scale.
    """
    return read_house(sample_path(name))


def sample_path(name: str) -> Path:
    """The file of a sample house. Raises HouseError if there is none of that name."""
    if name not in sample_names():
        raise HouseError(f"no sample house {name!r}; there are {', '.join(sample_names())}")
    return FOLDER / f"{name}.json"
