"""What a token costs: what was configured, the paper's models, else litellm's list."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage, Wrapper

MILLION = 1_000_000


@dataclass(frozen=True)
class Price:
    """US dollars for a million tokens.

    Raises:
        ConfigurationError: one of them is negative or not finite.
    """

    prompt: float
    completion: float

    def __post_init__(self) -> None:
        for name, value in (("prompt", self.prompt), ("completion", self.completion)):
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < math.inf:
                raise ConfigurationError(
                    f"llm.price.{name}={value!r}: must be a number of US dollars for a million tokens, at "
                    "least 0"
                )

    def cost(self, prompt_tokens: int, completion_tokens: int) -> float:
        """US dollars."""
        return (self.prompt * prompt_tokens + self.completion * completion_tokens) / MILLION


FREE = Price(0.0, 0.0)
PAPER_PRICES: Mapping[str, Price] = {
    "gpt-4-1106-preview": Price(10.0, 30.0),
    "gpt-3.5-turbo-1106": Price(1.0, 2.0),
}
"""Of the paper's models, so that their cost can be told without litellm."""


def listed_price(model: str) -> Price | None:
    """The price of a model of the paper, or litellm's if litellm is loaded; None if it is in neither list.

    Never imports litellm: that takes seconds, and only a run with a real model needs it.
    """
    return PAPER_PRICES.get(model.rpartition("/")[2]) or _price_of_litellm(model)


def _price_of_litellm(model: str) -> Price | None:
    prices: Mapping[str, Any] = getattr(sys.modules.get("litellm"), "model_cost", {})
    entry = prices.get(model) or prices.get(model.rpartition("/")[2])
    if entry is None or entry.get("input_cost_per_token") is None:
        return None
    return Price(
        MILLION * float(entry["input_cost_per_token"]),
        MILLION * float(entry.get("output_cost_per_token") or 0.0),
    )


class PricedModel(Wrapper):
    """A language model whose answers cost what `price` says, whatever it says itself."""

    def __init__(self, inner: LanguageModel, price: Price) -> None:
        super().__init__(inner)
        self._price = price

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`."""
        try:
            return self._priced(self._inner.complete(request))
        except ReplyError as error:
            if isinstance(error.response, LMResponse):
                error.response = self._priced(error.response)
            raise

    def _priced(self, response: LMResponse) -> LMResponse:
        prompt, completion = response.usage.prompt_tokens, response.usage.completion_tokens
        return replace(response, usage=Usage(prompt, completion, self._price.cost(prompt, completion)))
