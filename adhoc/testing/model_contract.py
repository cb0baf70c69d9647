"""The contract of `LanguageModel` as tests that every implementation inherits.

Subclass `LanguageModelContract`, implement `model`, and give it a request that the model can answer.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

from adhoc.core.chat import ChatMessage
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse


class LanguageModelContract(ABC):
    """Inherit as `class TestMine(LanguageModelContract)`."""

    @abstractmethod
    def model(self) -> LanguageModel:
        """A fresh model."""

    def request(self) -> LMRequest:
        """A request that the model answers."""
        return LMRequest((ChatMessage("system", "Be brief."), ChatMessage("user", "Say {}.")), "generate")

    def test_has_a_name_that_does_not_change(self) -> None:
        model = self.model()
        before = model.name
        model.complete(self.request())
        assert before
        assert model.name == before

    def test_answers_with_text_and_usage(self) -> None:
        response = self.model().complete(self.request())
        assert isinstance(response, LMResponse)
        assert response.text
        assert response.model
        assert response.finish_reason
        assert response.usage.prompt_tokens > 0
        assert response.usage.completion_tokens > 0
        assert response.usage.cost_usd >= 0.0

    def test_does_not_change_the_request(self) -> None:
        request = self.request()
        before = repr(request)
        self.model().complete(request)
        assert repr(request) == before

    def test_answers_the_same_when_told_of_invalid_replies(self) -> None:
        expected = self.model().complete(self.request())
        model = self.model()
        model.note("generate", "unreadable")
        model.note("generate", "repaired")
        assert model.complete(self.request()) == expected
