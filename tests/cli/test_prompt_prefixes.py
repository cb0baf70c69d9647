"""The records of a whole episode: what providers can cache of the prompts, and what did not fit."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from adhoc.cli.main import main


@pytest.fixture(scope="module")
def episode(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """IRoT from the first step on, in the shipped house of eight rooms."""
    folder = tmp_path_factory.mktemp("results")
    main(
        [
            "run",
            "policy=irot",
            "join_step=0",
            "benchmark.draws=[{house: eight_rooms, seed: 0, misplaced: 4, teammates: 4}]",
            "pictures=false",
            f"out={folder}",
        ]
    )
    lines = Path(folder, "episodes.jsonl").read_text(encoding="utf-8").splitlines()
    found: dict[str, Any] = next(it for it in map(json.loads, lines) if it["policy"] == "irot")
    return found


def test_most_of_the_prompt_tokens_of_an_episode_repeat_the_beginning_of_the_prompt_before(episode) -> None:
    llm = episode["llm"]
    assert llm["calls"] > 20
    assert llm["prefix_tokens"] / llm["prompt_tokens"] >= 0.6


def test_without_a_window_nothing_is_left_out(episode) -> None:
    assert episode["llm"]["left_out_messages"] == 0
