from __future__ import annotations

from pathlib import Path

import pytest
from grid_world import scenario

from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.lazy_scenarios import LazyScenarios, scenario_ids

IDS = [f"s{number}" for number in range(6)]


class Loader:
    def __init__(self):
        self.loaded = []

    def __call__(self, position):
        self.loaded.append(position)
        return scenario(id=IDS[position])


@pytest.fixture
def loader():
    return Loader()


def test_ids_and_length_load_nothing(loader):
    lazy = LazyScenarios(IDS, loader)
    assert (len(lazy), lazy.ids, scenario_ids(lazy)) == (6, tuple(IDS), tuple(IDS))
    assert scenario_ids(lazy[1:3]) == ("s1", "s2")
    assert loader.loaded == []


def test_items_are_loaded_on_access_and_a_few_are_kept(loader):
    lazy = LazyScenarios(IDS, loader, kept=2)
    assert lazy[1].id == "s1"
    assert lazy[-1].id == "s5"
    assert lazy[1].id == "s1"
    assert loader.loaded == [1, 5]
    assert lazy[0].id == "s0"
    assert lazy[1].id == "s1"
    assert lazy[5].id == "s5"
    assert loader.loaded == [1, 5, 0, 5]


def test_it_is_a_sequence(loader):
    lazy = LazyScenarios(IDS, loader)
    assert [it.id for it in lazy] == IDS
    assert [it.id for it in lazy[::-2]] == ["s5", "s3", "s1"]
    assert [it.id for it in lazy[1:4][1:]] == ["s2", "s3"]
    with pytest.raises(IndexError):
        lazy[6]


def test_another_scenario_than_announced_is_an_error():
    lazy = LazyScenarios(["a"], lambda position: scenario(id="b"))
    with pytest.raises(ConfigurationError, match="announced as 'a', but is 'b'"):
        lazy[0]


def test_other_sequences_have_ids_too():
    assert scenario_ids([scenario(id="a"), scenario(id="b")]) == ["a", "b"]


def test_a_run_loads_one_scenario_at_a_time(loader, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "experiments"))
    from test_run import run

    _, progress = run(tmp_path, scenarios=LazyScenarios(IDS[:2], loader, kept=1))
    assert loader.loaded == [0, 1]
    assert progress.total == 4
    with pytest.raises(ConfigurationError, match="must be unique: 'a'"):
        run(tmp_path, scenarios=LazyScenarios(["a", "b", "a"], loader))
    assert loader.loaded == [0, 1]
