"""The paper's formulas against numbers worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest
from grid_world import scenario

from adhoc.core.errors import ConfigurationError
from adhoc.core.values import Pose
from adhoc.evaluation.episode_result import Ending, EpisodeResult
from adhoc.evaluation.metrics import (
    EpisodeScore,
    FailedShare,
    average,
    efficiency,
    improvement,
    score,
)
from adhoc.evaluation.trace import Trace


def result(**changes):
    """The team of two alone, both objects re-placed in 120 steps."""
    default = EpisodeResult(
        scenario=scenario(),
        max_steps=500,
        ending=Ending.REPLACED,
        steps=120,
        watched=("apple", "knife"),
        replaced=("apple", "knife"),
        join_step=None,
        joined=False,
        joined_at=None,
        moved=False,
        agent_steps={"teammate_1": 120, "teammate_2": 80},
        messages=0,
        undeliverable=0,
        history=("0", "1"),
        trace=Trace(),
    )
    return replace(default, **changes)


def with_newcomer(**changes):
    joined = {"join_step": 50, "joined": True, "joined_at": Pose(6.0, 2.0)}
    agent_steps = {"teammate_1": 90, "teammate_2": 80, "newcomer": 40}
    return result(**{**joined, "steps": 90, "agent_steps": agent_steps, **changes})


class TestScore:
    def test_success_of_the_team_alone(self):
        assert score(result()) == EpisodeScore(True, 1.0, 120, 200, None)

    def test_success_with_a_newcomer(self):
        scored = score(with_newcomer(), reference_temporal_steps=120)
        assert scored == EpisodeScore(True, 1.0, 90, 210, 0.25)

    def test_a_failure_counts_every_step_of_every_agent(self):
        failed = result(ending=Ending.STOPPED, replaced=("apple",), steps=77)
        assert score(failed) == EpisodeScore(False, 0.5, 500, 1000, None)

    def test_a_failed_newcomer_counts_from_its_joining(self):
        failed = with_newcomer(ending=Ending.MAX_STEPS, replaced=(), steps=500)
        assert score(failed, 500) == EpisodeScore(False, 0.0, 500, 1450, 0.0)
        assert score(failed, 500, FailedShare.FULL).action_steps == 1500

    def test_a_newcomer_that_never_joined_has_no_share(self):
        missed = result(ending=Ending.STOPPED, replaced=(), join_step=50)
        assert score(missed, 500).action_steps == 1000

    @pytest.mark.parametrize(
        ("team", "ad_hoc", "success", "expected"),
        [(200, 150, True, 0.25), (200, 150, False, 0.0), (150, 200, True, 0.0), (500, 100, True, 0.8)],
    )
    def test_efficiency(self, team, ad_hoc, success, expected):
        assert efficiency(team, ad_hoc, success) == expected

    def test_efficiency_of_nothing_to_do(self):
        assert efficiency(0, 0, True) == 0.0


class TestAverage:
    episodes = (
        EpisodeScore(True, 1.0, 100, 300, 0.5),
        EpisodeScore(False, 0.5, 500, 1500, 0.0),
        EpisodeScore(False, 0.0, 500, 1500, 0.0),
        EpisodeScore(True, 1.0, 300, 700, 0.25),
    )

    def test_means_over_four_episodes(self):
        means = average(self.episodes)
        assert means.episodes == 4
        assert means.success == 50.0
        assert means.partial_success == 62.5
        assert means.temporal_steps == 350.0
        assert means.action_steps == 1000.0
        assert means.efficiency == 18.75

    def test_the_team_alone_has_no_efficiency(self):
        assert average([EpisodeScore(True, 1.0, 100, 300, None)]).efficiency is None

    def test_nothing_has_no_mean(self):
        with pytest.raises(ConfigurationError):
            average([])


class TestImprovement:
    def test_a_row_of_the_papers_first_table(self):
        """Heuristic team, heuristic newcomer, joining at step 0: 18.3, 26.3, 6.8 and -10.0 in brackets."""
        team = replace(
            average(TestAverage.episodes),
            success=15.3,
            partial_success=21.7,
            temporal_steps=467.3,
            action_steps=1863.2,
        )
        ad_hoc = replace(team, success=18.1, partial_success=27.4, temporal_steps=435.6, action_steps=2049.3)
        gain = improvement(team, ad_hoc)
        assert gain.success == pytest.approx(18.3, abs=0.05)
        assert gain.partial_success == pytest.approx(26.3, abs=0.05)
        assert gain.temporal_steps == pytest.approx(6.8, abs=0.05)
        assert gain.action_steps == pytest.approx(-10.0, abs=0.05)

    def test_there_is_no_percentage_of_nothing(self):
        team = replace(average(TestAverage.episodes), success=0.0)
        assert improvement(team, replace(team, success=25.0)).success is None
        assert improvement(team, team).success == 0.0
