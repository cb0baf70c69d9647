"""Proof that two episodes share their past: a chain of hashes, one link a step."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence

from adhoc.core.errors import EpisodeError
from adhoc.core.messages import Message
from adhoc.core.values import Action
from adhoc.evaluation.channel import message_text


class History:
    """Link t depends on the initial state and on every action, message and state before step t.

    Equal links mean equal pasts; once two chains differ they differ for ever.
    """

    def __init__(self, initial_fingerprint: str) -> None:
        self.links = [_hash(initial_fingerprint)]

    def add_step(self, actions: Mapping[str, Action], messages: Iterable[Message], fingerprint: str) -> None:
        """Append the link of one step: what was done, what was said, and the world's state after it."""
        done = [f"{name}: {action}" for name, action in actions.items()]
        said = [message_text(message) for message in messages]
        self.links.append(_hash("\n".join([self.links[-1], *done, *said, fingerprint])))


def check_shared_past(links: Sequence[str], reference: Sequence[str], episode: str) -> None:
    """Check that an episode with a newcomer is, up to its joining, the episode of the team alone.

    `links` are those up to and including the joining step; `reference` those of the team alone. Raises
    EpisodeError naming the first step at which they part.
    """
    for step, (link, expected) in enumerate(zip(links, reference)):
        if link != expected:
            raise EpisodeError(
                f"{episode}: the history parts from that of the team alone at step {step}, before the "
                "newcomer joined; something in the world, the team or the task is not deterministic"
            )
    if len(links) > len(reference):
        raise EpisodeError(
            f"{episode}: ran to step {len(links) - 1} without the newcomer, but the team alone ended at "
            f"step {len(reference) - 1}"
        )


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]
