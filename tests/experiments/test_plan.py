from __future__ import annotations

from dataclasses import replace

import pytest
from grid_world import GridWorld, scenario
from test_run import HELPER, IDLER, SCENARIOS, TEAM, conditions

from adhoc.core.errors import ConfigurationError, RecordError
from adhoc.evaluation.lazy_scenarios import LazyScenarios
from adhoc.evaluation.records import RecordFile
from adhoc.experiments.comparison import Comparison, Comparisons, Entrant
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.plan import Shard, Unit, make_plan
from adhoc.experiments.run import run_comparison, run_plan
from adhoc.llm.counting import CountingModel
from adhoc.llm.scripted import ScriptedModel

SPRINTERS = replace(TEAM, name="sprinters")
MANY = [scenario(id=f"two_rooms-s{seed}", seed=seed) for seed in range(12)]


def comparison(*entrants: Entrant, scenarios=SCENARIOS, **changes) -> Comparison:
    return Comparison(GridWorld(), scenarios, conditions(**changes), entrants)


def plan_of(folder, *comparisons, **options):
    return make_plan(list(comparisons), RunFolder(folder), **options)


def test_every_scenario_of_every_comparison_is_a_unit(tmp_path):
    plan = plan_of(tmp_path, comparison(Entrant(HELPER, 5)), comparison(team=SPRINTERS))
    assert sorted(plan.units, key=vars_of) == [Unit(0, 0), Unit(0, 1), Unit(1, 0), Unit(1, 1)]
    assert (plan.missing, plan.done, plan.to_run) == ({"No ad hoc": 4, "Helper": 2}, 0, 6)


def vars_of(unit: Unit) -> tuple[int, int]:
    return unit.comparison, unit.position


def test_units_are_shuffled_by_the_seed_alone(tmp_path):
    first, again, other = (
        plan_of(tmp_path, comparison(scenarios=MANY), seed=seed).units for seed in (0, 0, 1)
    )
    assert first == again != other
    assert first != tuple(sorted(first, key=vars_of))


def test_shards_part_the_units(tmp_path):
    parts = [plan_of(tmp_path, comparison(scenarios=MANY), shard=Shard(n, 5)).units for n in range(1, 6)]
    whole = plan_of(tmp_path, comparison(scenarios=MANY)).units
    assert [len(part) for part in parts] == [3, 3, 2, 2, 2]
    assert sorted(sum(parts, ()), key=vars_of) == sorted(whole, key=vars_of)


def test_shards_stay_the_same_when_episodes_are_recorded(tmp_path):
    shard = Shard(2, 3)
    before = plan_of(tmp_path, comparison(scenarios=MANY), shard=shard)
    one = before.units[0].position
    run_comparison(comparison(scenarios=MANY[one : one + 1]), RunFolder(tmp_path))
    after = plan_of(tmp_path, comparison(scenarios=MANY), shard=shard)
    assert after.units == before.units[1:]
    assert (after.done, after.to_run, after.scenarios) == (1, 3, 4)


@pytest.mark.parametrize(("number", "count"), [(0, 2), (3, 2), (-1, 1)])
def test_there_is_no_shard_beyond_the_parts(number, count):
    with pytest.raises(ConfigurationError, match="must be i/n"):
        Shard(number, count)


def test_what_is_recorded_is_not_run_again_and_needs_no_scenario(tmp_path):
    run_comparison(comparison(Entrant(HELPER, 5)), RunFolder(tmp_path))
    loaded = []

    def load(position):
        loaded.append(position)
        return SCENARIOS[position]

    lazy = LazyScenarios([it.id for it in SCENARIOS], load)
    plan = plan_of(tmp_path, comparison(Entrant(HELPER, 5), scenarios=lazy))
    assert (plan.units, plan.done) == ((), 4)
    assert len(loaded) == 1  # a sample: whether it is the same scenario


def test_a_policy_more_needs_the_scenarios_but_not_the_team_alone(tmp_path):
    run_comparison(comparison(Entrant(HELPER, 5)), RunFolder(tmp_path))
    plan = plan_of(tmp_path, comparison(Entrant(HELPER, 5), Entrant(IDLER, 5)))
    assert (plan.missing["Idler"], plan.missing.get("No ad hoc"), plan.done) == (2, None, 4)


def test_another_version_of_a_scenario_is_noticed_though_nothing_is_to_be_run(tmp_path):
    run_comparison(comparison(), RunFolder(tmp_path))
    other = [replace(it, team=it.team[:1]) for it in SCENARIOS]
    with pytest.raises(RecordError, match="another version of scenario"):
        plan_of(tmp_path, comparison(scenarios=other))


def test_another_configuration_is_noticed_though_nothing_is_recorded_of_it(tmp_path):
    run_comparison(comparison(), RunFolder(tmp_path))
    fresh = [scenario(id="two_rooms-s9", seed=9)]
    with pytest.raises(RecordError, match="max_steps: 30 there, 31 here"):
        plan_of(tmp_path, comparison(scenarios=fresh, max_steps=31))


def test_comparisons_are_built_when_they_are_needed_and_once():
    built = []

    def make(name):
        built.append(name)
        return comparison()

    comparisons = Comparisons([lambda: make("a"), lambda: make("b")])
    assert (len(comparisons), built) == (2, [])
    assert comparisons[1] is comparisons[1]
    assert comparisons[:] == [comparisons[0], comparisons[1]]
    assert built == ["b", "a"]


def test_a_plan_of_several_comparisons_runs_the_team_alone_once_for_all_entrants(tmp_path):
    both = comparison(Entrant(HELPER, 5), Entrant(IDLER, 5), Entrant(IDLER, 7))
    folder = RunFolder(tmp_path)
    summary = run_plan(make_plan([both], folder), [both], folder)
    assert summary.run == 8
    assert [it["policy"] for it in folder.records[:4]] == ["none", "helper", "idler", "idler"]


def test_the_cost_of_what_is_missing_goes_by_what_is_recorded(tmp_path):
    model = CountingModel(ScriptedModel([], name="tiny"))
    asking = replace(HELPER, model=model)
    run_comparison(comparison(Entrant(asking, 5), scenarios=MANY[:2]), RunFolder(tmp_path))
    records = RecordFile(tmp_path).read()
    dear = [{**it, "llm": {**it["llm"], "cost_usd": 0.5 if it["join_step"] else 0.25}} for it in records]
    RecordFile(tmp_path).replace(dear)
    plan = plan_of(tmp_path, comparison(Entrant(asking, 5), scenarios=MANY[:5]))
    assert (plan.models, plan.usd) == (("tiny",), 3 * 0.75)
    fresh = plan_of(tmp_path / "fresh", comparison(Entrant(asking, 5)))
    assert (fresh.models, fresh.usd) == (("tiny",), None)
    assert plan_of(tmp_path, comparison(scenarios=MANY[:5])).models == ()


def test_a_sweep_over_the_number_of_scenarios_runs_each_once(tmp_path):
    few, all_of_them = comparison(scenarios=MANY[:2]), comparison(scenarios=MANY[:5])
    plan = plan_of(tmp_path, few, all_of_them)
    assert (plan.to_run, plan.scenarios) == (5, 5)


def test_an_episode_that_two_parts_of_a_sweep_share_is_refused(tmp_path):
    """Each of two workers would run the team alone."""
    one, two = comparison(Entrant(HELPER, 5)), comparison(Entrant(IDLER, 5))
    with pytest.raises(ConfigurationError, match="'two_rooms-s0--walkers--alone' is in two parts"):
        plan_of(tmp_path, one, two)


def test_two_configurations_of_one_name_are_refused_before_anything_is_run(tmp_path):
    other = replace(HELPER, settings={"name": "helper", "n": 5})
    with pytest.raises(ConfigurationError, match=r"policy=helper.*n: None in one, 5 in the other"):
        plan_of(tmp_path, comparison(Entrant(HELPER, 5), Entrant(other, 6)))
    with pytest.raises(ConfigurationError, match=r"max_steps: 30 in one, 20 in the other"):
        plan_of(tmp_path, comparison(), comparison(max_steps=20))
