"""Whether what a run folder says that it was made of may be built: folders are sent, and building runs code.

A configuration names components by `_target_`. Those of this library do what its documentation says. Any
other name may be anything, such as `os.system`, so whoever replays the run of another must say that its code
may run.
"""

from __future__ import annotations

import argparse
import inspect
from collections.abc import Iterator, Mapping, Sequence

from adhoc.cli.build import TARGET, is_component, locate
from adhoc.core.errors import ConfigurationError

LIBRARY = "adhoc."


def check_trusted(config: Mapping[str, object]) -> None:
    """Raise ConfigurationError for a component that is no class of this library. Nothing else is imported."""
    for where, component in _components(config, ""):
        path = component[TARGET]
        if not isinstance(path, str) or not path.startswith(LIBRARY) or not _is_own(component, where):
            raise ConfigurationError(
                f"{where}.{TARGET}={path}: is no class of this library; --trust builds it, which runs its "
                "code: only for folders whose origin you know"
            )


def add_trust(parser: argparse.ArgumentParser) -> None:
    """Ask whether code that is not of the library may run."""
    parser.add_argument(
        "--trust",
        action="store_true",
        help="build components that are not of this library, too, which runs their code",
    )


def _is_own(component: Mapping[str, object], where: str) -> bool:
    """Whether it is defined here, not only imported."""
    target = locate(component, where)
    return inspect.isclass(target) and target.__module__.startswith(LIBRARY)


def _components(value: object, where: str) -> Iterator[tuple[str, Mapping[str, object]]]:
    if isinstance(value, Mapping):
        if is_component(value):
            yield where, value
        inside = ((str(name), inner) for name, inner in value.items())
    elif isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        inside = ((str(place), inner) for place, inner in enumerate(value))
    else:
        return
    for name, inner in inside:
        yield from _components(inner, f"{where}.{name}" if where else name)
