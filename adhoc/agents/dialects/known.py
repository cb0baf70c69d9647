"""The dialects that come with the library, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from adhoc.agents.dialects.codes import Codes
from adhoc.agents.dialects.dialect import Dialect
from adhoc.agents.dialects.sentences import Sentences
from adhoc.agents.dialects.structured import Silent, Structured
from adhoc.core.errors import ConfigurationError

DIALECTS: Mapping[str, Callable[[], Dialect]] = {
    dialect.name: dialect for dialect in (Structured, Codes, Sentences, Silent)
}


def dialect_named(name: object) -> Dialect:
    """The dialect of that name. Raises ConfigurationError for an unknown one."""
    if not isinstance(name, str) or name not in DIALECTS:
        raise ConfigurationError(f"dialect={name!r}: must be one of {', '.join(DIALECTS)}")
    return DIALECTS[name]()
