"""Recordings are kept house by house, read again, and do not depend on how often a training is begun."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from adhoc.agents.random_policy import RandomPolicy
from adhoc.core.errors import CheckpointError
from adhoc.training.demonstrations import Cast, DemonstrationSettings, Recorder, demonstrate
from adhoc.training.training_houses import FIT, house_draws


class Counting(RandomPolicy):
    """Acts at random, and has its steps taken down."""

    def __init__(self, recorder):
        super().__init__()
        self._recorder = recorder

    def act(self, observation, inbox):
        self._recorder.note(np.array([observation.step, len(inbox)], np.float32), observation.step % 2)
        return super().act(observation, inbox)


def counting_team(calls, world, scenario):
    calls.append(scenario.id)
    recorders = [Recorder() for _ in scenario.team]
    return Cast([Counting(recorder) for recorder in recorders], recorders)


def settings(calls):
    return DemonstrationSettings("count", partial(counting_team, calls), 2, scenarios=1, max_steps=3)


DRAWS = house_draws(FIT, 3, 0)[1:]


def test_every_decision_of_every_robot_is_there(tmp_path):
    calls = []
    made = demonstrate(DRAWS, settings(calls), tmp_path, workers=1)
    assert sorted(calls) == ["fit-0001-0", "fit-0002-0"]
    assert made.episodes == 2
    assert made.inputs.shape[1] == 2
    assert made.inputs[:3].tolist() == [[0, 0], [1, 0], [2, 0]]
    assert made.labels[:3].tolist() == [0, 1, 0]
    assert len(made.labels) % 3 == 0


def test_what_was_recorded_is_not_run_again(tmp_path):
    calls = []
    first = demonstrate(DRAWS[:1], settings(calls), tmp_path, workers=1)
    both = demonstrate(DRAWS, settings(calls), tmp_path, workers=1)
    assert calls == ["fit-0001-0", "fit-0002-0"]
    assert both.inputs[: len(first.inputs)].tolist() == first.inputs.tolist()
    again = demonstrate(DRAWS, settings(calls), tmp_path, workers=1)
    assert len(calls) == 2
    assert (again.inputs == both.inputs).all()
    assert (again.episodes, again.successes) == (both.episodes, both.successes)


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    folder = tmp_path_factory.mktemp("recording")
    demonstrate(DRAWS[:1], settings([]), folder, workers=1)
    (path,) = folder.iterdir()
    return path


@pytest.mark.parametrize("content", [b"", b"PK nonsense", b"\x80\x04."])
def test_a_broken_recording_is_named(tmp_path, recording, content):
    path = tmp_path / recording.name
    path.write_bytes(content)
    with pytest.raises(CheckpointError, match="remove it") as caught:
        demonstrate(DRAWS[:1], settings([]), tmp_path, workers=1)
    assert str(path) in str(caught.value)


def test_a_recording_of_other_features_is_refused(recording):
    other = DemonstrationSettings("count", partial(counting_team, []), 7, scenarios=1, max_steps=3)
    with pytest.raises(CheckpointError, match="7 features a row"):
        demonstrate(DRAWS[:1], other, recording.parent, workers=1)
