from __future__ import annotations

import gzip
import json
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from adhoc.core.errors import ConfigurationError, HouseError, MissingDependency
from adhoc.core.streams import derive_seed
from adhoc.dataset.house_choice import choose
from adhoc.dataset.procthor10k import ProcThor10kBenchmark
from adhoc.evaluation.lazy_scenarios import scenario_ids
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.scenario import prepare
from adhoc.houses import samples
from adhoc.worlds.pybullet_world import PyBulletWorld

SAMPLES = Path(samples.__file__).parent / "samples"
REAL = Path(__file__).parents[2].parent / "shared" / "data"


def document(name):
    return json.loads((SAMPLES / f"{name}.json").read_text())


def bare(name):
    """A house with nothing to misplace; `salt` makes it another house."""
    house = document(name)
    house["objects"] = []
    return house


def variants(name, count):
    """Houses that differ in what does not matter."""
    return [{**document(name), "metadata": {"schema": "1.0.0", "number": number}} for number in range(count)]


def write(path, houses):
    path.write_text("".join(json.dumps(house) + "\n" for house in houses))
    return str(path)


@pytest.fixture
def world():
    world = PyBulletWorld(image_size=2)
    yield world
    world.close()


class TestChoice:
    def chosen(self, houses, seed=0, most=3):
        listed = [(f"line {number}", house) for number, house in enumerate(houses)]
        return {
            rooms: [it.rank for it in found] for rooms, found in choose(listed, (1, 4), most, seed).items()
        }

    def test_the_order_plays_no_role(self):
        houses = [*variants("one_room", 6), *variants("four_rooms", 2), *variants("eight_rooms", 1)]
        assert self.chosen(houses) == self.chosen(houses[::-1])
        assert [len(found) for found in self.chosen(houses).values()] == [3, 2]

    def test_other_houses_play_no_role_but_by_coming_first(self):
        houses = variants("one_room", 6)
        everything = self.chosen(houses, most=6)[1]
        assert self.chosen(houses, most=3)[1] == everything[:3] == sorted(everything)[:3]

    def test_the_order_of_fields_and_copies_play_no_role(self):
        houses = variants("one_room", 3)
        turned = [dict(reversed(house.items())) for house in houses]
        assert self.chosen([*houses, *turned]) == self.chosen(houses)
        assert len(self.chosen([*houses, *turned])[1]) == 3

    def test_another_seed_chooses_others(self):
        houses = variants("one_room", 12)
        assert self.chosen(houses) != self.chosen(houses, seed=1)

    def test_what_is_no_house_is_left_out(self):
        assert self.chosen([3, [], {"rooms": 3}, {"rooms": []}, "x"]) == {1: [], 4: []}


class TestBenchmark:
    def benchmark(self, path, **options):
        return ProcThor10kBenchmark(path, **{"houses_per_count": 1, "counts": (1, 4), **options})

    def test_ids_are_known_before_anything_is_drawn(self, tmp_path, world):
        path = write(tmp_path / "houses.jsonl", [*variants("one_room", 2), *variants("four_rooms", 1)])
        scenarios = self.benchmark(path).scenarios(world, 0)
        ids = scenario_ids(scenarios)
        assert len(ids) == 30
        assert (ids[0], ids[-1]) == ("procthor10k-test-01-00-k1-t3", "procthor10k-test-04-00-k5-t5")
        assert scenario_ids(self.benchmark(path, seed=2).scenarios(world, 0))[0] == (
            "procthor10k-test-s2-01-00-k1-t3"
        )

    def test_tasks_can_be_set_up_and_do_not_depend_on_the_order_of_access(self, tmp_path, world):
        path = write(tmp_path / "houses.jsonl", variants("one_room", 2))
        benchmark = self.benchmark(path, counts=(1,))
        forth = benchmark.scenarios(world, 0)
        scenario = forth[14]
        assert (len(scenario.misplaced), len(scenario.team)) == (5, 5)
        assert scenario.house.id == "procthor10k-test-01-00"
        prepare(world, scenario)
        assert PlacementReferee(world, scenario).replaced() == ()
        back = benchmark.scenarios(world, 0)
        assert back[0] == forth[0]
        assert back[14] == scenario
        again = benchmark.scenarios(world, 7)[14]
        assert (again.seed, again.placement_seed) == (derive_seed(7, "episode", scenario.seed), scenario.seed)

    def test_houses_that_do_not_suit_are_passed_over(self, tmp_path, world):
        """Whichever comes first: the bare house never makes tasks."""
        good = variants("one_room", 1)[0]
        for number in range(4):
            empty = {**bare("one_room"), "metadata": {"schema": "1.0.0", "number": number}}
            path = write(tmp_path / "houses.jsonl", [empty, good])
            scenarios = self.benchmark(path, counts=(1,)).scenarios(world, 0)
            assert len(scenarios[0].misplaced) == 1

    def test_a_house_is_not_taken_twice(self, tmp_path, world):
        path = write(tmp_path / "houses.jsonl", variants("one_room", 2))
        scenarios = self.benchmark(path, counts=(1,), houses_per_count=2).scenarios(world, 0)
        assert scenarios[29].house.source != scenarios[0].house.source
        assert scenarios[0].house.id == "procthor10k-test-01-00"

    def test_too_few_houses_are_told(self, tmp_path, world):
        path = write(tmp_path / "houses.jsonl", variants("one_room", 2))
        with pytest.raises(ConfigurationError, match="0 houses with 4 rooms were found, 1 are needed"):
            self.benchmark(path).scenarios(world, 0)
        path = write(tmp_path / "bare.jsonl", [bare("one_room")])
        scenarios = self.benchmark(path, counts=(1,)).scenarios(world, 0)
        with pytest.raises(
            ConfigurationError, match="'procthor10k-test-01-00': tasks can be drawn in only 0 of"
        ):
            scenarios[0]

    def test_a_broken_file_is_told(self, tmp_path, world):
        (tmp_path / "houses.jsonl").write_text("{")
        with pytest.raises(HouseError, match=r"houses\.jsonl line 1"):
            self.benchmark(str(tmp_path / "houses.jsonl")).scenarios(world, 0)

    @pytest.mark.parametrize(
        "options", [{"split": "dev"}, {"houses_per_count": 0}, {"counts": ()}, {"counts": ("1",)}]
    )
    def test_impossible_arguments_are_refused(self, options):
        (name,) = options
        with pytest.raises(ConfigurationError, match=f"benchmark.{name}="):
            ProcThor10kBenchmark(**options)


class TestPrior:
    def test_without_the_package_it_is_said_what_to_install(self, monkeypatch, world):
        monkeypatch.setitem(sys.modules, "prior", None)
        with pytest.raises(MissingDependency, match=r"pip install .*adhoc\[procthor\].* benchmark.path=FILE"):
            ProcThor10kBenchmark().scenarios(world, 0)

    def fake(self, monkeypatch, load):
        module = ModuleType("prior")
        module.load_dataset = load
        monkeypatch.setitem(sys.modules, "prior", module)

    def test_its_houses_are_those_of_a_file(self, monkeypatch, tmp_path, world):
        houses = variants("one_room", 3)
        asked = []

        def load(name):
            asked.append(name)
            lines = [json.dumps(house).encode() for house in houses]
            return {"test": SimpleNamespace(data=lines), "val": houses}

        self.fake(monkeypatch, load)
        path = write(tmp_path / "houses.jsonl", houses)
        options = {"houses_per_count": 1, "counts": (1,)}
        by_prior = ProcThor10kBenchmark(**options).scenarios(world, 0, limit=1)[0]
        by_file = ProcThor10kBenchmark(path, **options).scenarios(world, 0, limit=1)[0]
        assert by_prior.content_hash() == by_file.content_hash()
        assert by_prior.house.source.startswith("procthor-10k, test, house ")
        assert asked == ["procthor-10k"]
        decoded = ProcThor10kBenchmark(split="val", **options).scenarios(world, 0, limit=1)
        assert decoded[0].house.id == "procthor10k-val-01-00"

    def test_what_it_cannot_load_is_one_error(self, monkeypatch, world):
        def load(name):
            raise ConnectionError("no network")

        self.fake(monkeypatch, load)
        with pytest.raises(ConfigurationError, match=r"procthor-10k: `prior` cannot load it: .*no network"):
            ProcThor10kBenchmark().scenarios(world, 0)

    def test_a_broken_line_is_told(self, monkeypatch, world):
        self.fake(monkeypatch, lambda name: {"test": SimpleNamespace(data=[b"{"])})
        with pytest.raises(HouseError, match="procthor-10k, test, house 0: not valid JSON"):
            ProcThor10kBenchmark().scenarios(world, 0)


@pytest.mark.real_houses
def test_tasks_are_made_in_real_houses(tmp_path, world):
    single, ten = REAL / "procthor-single-room-500.jsonl.gz", REAL / "procthor-train-1-ten-rooms.json.gz"
    if not (single.is_file() and ten.is_file()):
        pytest.skip(f"the real houses are not beside the checkout: no {single.name} or {ten.name}")
    lines = gzip.decompress(single.read_bytes()).splitlines()[:12]
    lines.append(json.dumps(json.loads(gzip.decompress(ten.read_bytes()))).encode())
    path = tmp_path / "houses.jsonl.gz"
    path.write_bytes(gzip.compress(b"\n".join(lines)))
    benchmark = ProcThor10kBenchmark(str(path), houses_per_count=1, counts=(1, 10))
    scenarios = benchmark.scenarios(world, 0)
    assert len(scenarios) == 30
    for position in (0, 7, 14, 15, 29):
        scenario = scenarios[position]
        prepare(world, scenario)
        assert PlacementReferee(world, scenario).replaced() == ()
    assert len(scenarios[29].house.rooms) == 10
