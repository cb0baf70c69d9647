"""The offline reasoner's mistakes: drawn from the prompt, the same for the same prompt on every machine."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

from adhoc.llm.offline.facts import Facts

_BITS = 32


@dataclass(frozen=True)
class MistakeRates:
    """How often each kind of mistake is made, as probabilities per call."""

    forget_capability: float
    ignore_teammate: float
    ignore_reply: float


def mistaken(facts: Facts, rates: MistakeRates, seed: int, prompt: str, sample: int) -> Facts:
    """The facts as a reader sees them who may forget what it can do, overlook a teammate or skip a reply.

    These are the paper's hallucinations (appendix, failure examples): a sub-task beyond the robot's ability,
    and one that conflicts with a teammate's.
    """
    digest = hashlib.sha256(f"{seed}\0{sample}\0{prompt}".encode()).digest()
    draws = [int.from_bytes(digest[4 * index : 4 * index + 4], "big") for index in range(5)]
    if draws[0] < rates.forget_capability * 2**_BITS:
        facts = facts._replace(manipulation=True, payload=float("inf"))
    if draws[1] < rates.ignore_teammate * 2**_BITS and facts.teammates:
        ignored = draws[3] % len(facts.teammates)
        facts = facts._replace(teammates=(*facts.teammates[:ignored], *facts.teammates[ignored + 1 :]))
    if draws[2] < rates.ignore_reply * 2**_BITS and facts.replies:
        ignored = draws[4] % len(facts.replies)
        facts = facts._replace(replies=(*facts.replies[:ignored], *facts.replies[ignored + 1 :]))
    return facts
