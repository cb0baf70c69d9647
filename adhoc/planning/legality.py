"""What a robot may do, as planners check it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from adhoc.core.calls import Call, CallSpec
from adhoc.core.values import Capability

Legal = Callable[[Call, Capability], str | None]
"""None if a robot of that capability may do the call, else the reason: `Task.legal` or `Task.legal_skill`."""


def refusal_by(
    legal: Legal | None, vocabulary: Sequence[CallSpec], capability: Capability
) -> Callable[[Call], str | None]:
    """Why a robot of that capability may not do a call, or None.

    `legal` decides; without one, only the vocabulary's need for manipulation is checked.
    """
    if legal is not None:
        return lambda call: legal(call, capability)
    return lambda call: _by_vocabulary(call, vocabulary, capability)


def _by_vocabulary(call: Call, vocabulary: Sequence[CallSpec], capability: Capability) -> str | None:
    spec = next((it for it in vocabulary if it.name == call.name), None)
    if spec is None:
        return f"{call.name!r} is not one of {sorted(it.name for it in vocabulary)}"
    if spec.needs_manipulation and not capability.can_manipulate:
        return f"{spec.name} needs manipulation ability, which the robot lacks"
    return None
