"""The language model of a team, whose questions are counted apart from the newcomer's."""

from __future__ import annotations

from dataclasses import replace

from adhoc.llm.model import LMRequest, LMResponse, Wrapper

TEAM_PREFIX = "team "
"""Before the stage of every call that a teammate makes."""


class TeamModel(Wrapper):
    """A language model as teammates ask it: their stages are called `team generate` and so on."""

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`."""
        return self._inner.complete(replace(request, stage=TEAM_PREFIX + request.stage))

    def note(self, stage: str, outcome: str) -> None:
        """See `LanguageModel`."""
        super().note(TEAM_PREFIX + stage, outcome)
