"""Hard caps on calls, tokens and money, checked before a call is made."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from threading import Lock

from adhoc.core.errors import BudgetReached, ConfigurationError, ReplyError
from adhoc.llm.model import CHARACTERS_PER_TOKEN, LanguageModel, LMRequest, LMResponse, Wrapper
from adhoc.llm.prices import FREE, Price

REPAIR_FACTOR = 4
"""How much of a request's worst case a question may come to, its repair round included."""


@dataclass(frozen=True)
class Caps:
    """The most that may be spent; None is no cap. Tokens are those of prompts and replies together, money
    is in US dollars.

    Raises:
        ConfigurationError: a cap is no number or negative.
    """

    calls: int | None = None
    tokens: int | None = None
    usd: float | None = None

    def __post_init__(self) -> None:
        for unit, cap in asdict(self).items():
            if cap is None:
                continue
            is_whole = isinstance(cap, int) and not isinstance(cap, bool)
            if unit == "usd" and not (is_whole or isinstance(cap, float)):
                raise ConfigurationError(f"usd={cap!r}: must be a number of US dollars, or null for no cap")
            if unit != "usd" and not is_whole:
                raise ConfigurationError(f"{unit}={cap!r}: must be a whole number, or null for no cap")
            if not 0 <= cap < math.inf:
                raise ConfigurationError(f"{unit}={cap!r}: must be at least 0, or null for no cap")

    def __bool__(self) -> bool:
        """Whether there is any cap."""
        return any(cap is not None for cap in asdict(self).values())


@dataclass(frozen=True)
class Spent:
    """Calls, tokens (of prompts and replies) and US dollars that were spent, or may be."""

    calls: int = 0
    tokens: int = 0
    usd: float = 0.0

    def __add__(self, other: Spent) -> Spent:
        return Spent(self.calls + other.calls, self.tokens + other.tokens, self.usd + other.usd)

    def __sub__(self, other: Spent) -> Spent:
        return Spent(self.calls - other.calls, self.tokens - other.tokens, self.usd - other.usd)


NOTHING = Spent()

DIGITS = 9
"""Of amounts that are held against caps: the order in which prices were added up decides only later ones."""


class Account:
    """What was spent against caps, safe for threads.

    Every call claims its worst case before it is made, so that callers who ask at once do not pass a cap
    together, and gives back afterwards what it did not use.
    """

    def __init__(self, caps: Caps, spent: Spent = NOTHING) -> None:
        self._caps, self._spent, self._claimed = caps, spent, NOTHING
        self._lock = Lock()

    @property
    def spent(self) -> Spent:
        """What was used up, without the claims of calls that are under way."""
        return self._spent

    def claim(self, most: Spent, scope: str) -> None:
        """Raise BudgetReached if a call that uses `most` could pass a cap, else set that much aside."""
        with self._lock:
            unit = self._lacking(most)
            if unit is not None:
                raise BudgetReached(self._told(unit, most, scope), scope, f"budget.{scope}.{unit}")
            self._claimed += most

    def settle(self, most: Spent, used: Spent) -> None:
        """Book what a call used in place of what was set aside for it."""
        with self._lock:
            self._claimed -= most
            self._spent += used

    def has_room(self, most: Spent) -> bool:
        """Whether `most` could be claimed now."""
        with self._lock:
            return self._lacking(most) is None

    def _lacking(self, most: Spent) -> str | None:
        """The first unit of which there is not enough left."""
        wanted = asdict(self._spent + self._claimed + most)
        caps = asdict(self._caps)
        return next(
            (it for it, cap in caps.items() if cap is not None and round(wanted[it], DIGITS) > cap), None
        )

    def _told(self, unit: str, most: Spent, scope: str) -> str:
        def told(amounts: Spent) -> str:
            return f"{getattr(amounts, unit):.10g}" if unit != "usd" else f"{amounts.usd:.4f}"

        cap = getattr(self._caps, unit)
        under_way = (
            f", {told(self._claimed)} more set aside for calls under way" if self._claimed.calls else ""
        )
        return (
            f"budget.{scope}.{unit}={cap}: reached; {told(self._spent)} spent{under_way}, and the next call "
            f"may take {told(most)}"
        )


class CapModel(Wrapper):
    """A language model that asks `inner` only while that cannot pass a cap.

    The worst case of a call is its prompt and the reply's schema, estimated from their length, and a reply of
    `max_tokens`. The estimate is the same for every chain of models, so that a replayed or resumed run ends
    where the first one did. What an answer used is what the provider says; where it says nothing, the worst
    case counts. A reply that is of no use was paid; a call without a reply was not.

    Args:
        inner: The model that is asked.
        caps: What may be spent.
        price: For the worst case and for money; nothing costs anything by default.
        spent: What was spent before.
    """

    scope = ""
    """What the caps are for, in error texts."""

    def __init__(self, inner: LanguageModel, caps: Caps, price: Price = FREE, spent: Spent = NOTHING) -> None:
        super().__init__(inner)
        self._caps, self._price = caps, price
        self._account = Account(caps, spent)

    @property
    def spent(self) -> Spent:
        """What was spent so far."""
        return self._account.spent

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. Raises BudgetReached, without asking, if the answer could pass a cap."""
        account, most = self._account, self._most(request)
        account.claim(most, self.scope)
        used = NOTHING
        try:
            response = self._inner.complete(request)
            used = _used(response, most)
        except ReplyError as error:
            used = _used(error.response, most) if isinstance(error.response, LMResponse) else most
            raise
        finally:
            account.settle(most, used)
        return response

    def _most(self, request: LMRequest) -> Spent:
        """The most that a call may take."""
        prompt = LanguageModel.count_tokens(self, request.messages)
        if request.reply is not None:
            prompt += round(len(json.dumps(request.reply.schema, default=dict)) / CHARACTERS_PER_TOKEN)
        reply = request.max_tokens
        return Spent(1, prompt + reply, self._price.cost(prompt, reply))


class RunCapModel(CapModel):
    """Caps for a whole run; `spent` is what earlier sessions of it spent."""

    scope = "run"


class EpisodeCapModel(CapModel):
    """Caps for each episode. It counts answers from a ledger, too, at what they cost when they were paid, so
    that an episode that is resumed or replayed ends where it would have ended."""

    scope = "episode"

    def begin_episode(self, episode: str, seed: int) -> None:
        """See `LanguageModel`."""
        self._account = Account(self._caps)
        super().begin_episode(episode, seed)

    def may_go_together(self, requests: Sequence[LMRequest]) -> bool:
        """See `LanguageModel`. Not near a cap, where the order of answers would decide which call is the
        last."""
        most = sum(map(self._most, requests), NOTHING)
        questions = Spent(REPAIR_FACTOR * most.calls, REPAIR_FACTOR * most.tokens, REPAIR_FACTOR * most.usd)
        return self._account.has_room(questions) and super().may_go_together(requests)


def _used(response: LMResponse, most: Spent) -> Spent:
    usage = response.usage
    tokens = usage.prompt_tokens + usage.completion_tokens
    return Spent(1, tokens, usage.cost_usd) if tokens else most
