"""Telling a model which episode its requests belong to."""

from __future__ import annotations

from dataclasses import replace

from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper


class EpisodeModel(Wrapper):
    """A language model whose requests carry the episode, and the scenario's seed where they have none.

    So episodes of one scenario that ask the same are answered alike, and those of others are not.
    """

    def __init__(self, inner: LanguageModel) -> None:
        super().__init__(inner)
        self._episode = ""
        self._seed: int | None = None

    def begin_episode(self, episode: str, seed: int) -> None:
        """See `LanguageModel`."""
        self._episode, self._seed = episode, seed
        super().begin_episode(episode, seed)

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`."""
        seed = self._seed if request.seed is None else request.seed
        return self._inner.complete(replace(request, episode=request.episode or self._episode, seed=seed))
