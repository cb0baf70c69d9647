"""A refused action, as a value."""

from __future__ import annotations

from dataclasses import dataclass

from adhoc.core.values import Failure


@dataclass(frozen=True)
class Refusal:
    """Why an action changes nothing: the kind of failure, and the particulars in words."""

    failure: Failure
    detail: str = ""
