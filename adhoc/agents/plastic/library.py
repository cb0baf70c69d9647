"""The library of known types of teams."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

from adhoc.agents.learned.checkpoint import SUFFIX, digest_of
from adhoc.agents.plastic.models import TypeModel
from adhoc.core.errors import CheckpointError, ConfigurationError

SHIPPED = Path(__file__).parent / "checkpoints"
"""The folder of the types that come with the library."""


def types_in(folder: str | Path | None = None, names: Sequence[str] | None = None) -> Mapping[str, TypeModel]:
    """The types of a folder by name, in the order of their names; of the shipped ones if None.

    Every checkpoint in the folder is a type, so that a type is added by adding a file. `names` takes only
    some of them. Raises CheckpointError if there is none or one cannot be read, ConfigurationError for an
    unknown name.
    """
    found = _types(SHIPPED if folder is None else Path(folder))
    if names is None:
        return found
    for name in names:
        if name not in found:
            raise ConfigurationError(f"types: no type {name!r} of team; there are {', '.join(found)}")
    return {name: found[name] for name in names}


@cache
def library_fingerprint(folder: str | Path | None = None) -> str:
    """A hash of the types in a folder; of the shipped ones if None."""
    return digest_of(SHIPPED if folder is None else Path(folder))


@cache
def _types(folder: Path) -> Mapping[str, TypeModel]:
    paths = sorted(folder.glob(f"*{SUFFIX}"))
    if not paths:
        raise CheckpointError(
            f"{folder}: there is no type of team (*{SUFFIX}); `adhoc train plastic --out {folder}` makes some"
        )
    return {path.stem: TypeModel.load(path) for path in paths}
