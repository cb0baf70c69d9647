"""Every configuration file composes, and what it describes can be built."""

from __future__ import annotations

import inspect
from typing import ClassVar

import pytest
import yaml
from hydra import compose, initialize_config_dir

from adhoc.agents.policy import Policy
from adhoc.cli.build import build, locate, parameters_of
from adhoc.cli.contestants import Components
from adhoc.cli.replaced import drop_foreign_settings
from adhoc.cli.schema import register_schema
from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError
from adhoc.core.resources import data_dir
from adhoc.core.values import Pose
from adhoc.evaluation.benchmark import Benchmark
from adhoc.llm.model import LanguageModel, LMRequest
from adhoc.planning.interfaces import Evaluator, SubTaskGenerator
from adhoc.worlds.world import World

ROOT = data_dir("configs")
FILES = sorted(str(path.relative_to(ROOT).with_suffix("")) for path in ROOT.rglob("*.yaml"))
NEEDED = {
    "llm/litellm": ["llm.model=some-model"],
    "llm/local": ["llm.path=model.gguf"],
    "benchmark/house": ["benchmark.path=house.json"],
    "team/agent/llm": ["team=llm"],
    "team/negotiator/llm": ["team=llm"],
}
WITH_A_MODEL = {"cot", "gpl", "irot", "naive", "no_subtask_planner"}


def components(*overrides: str) -> Components:
    register_schema()
    with initialize_config_dir(str(ROOT), version_base="1.3"):
        return Components(compose("run", list(overrides)))


def test_there_are_the_files_that_the_tests_know():
    assert len(FILES) > 25
    assert {"policy/irot", "team/heuristic", "llm/gpt4_paper", "benchmark/demo", "run"} <= set(FILES)


@pytest.mark.parametrize("file", FILES)
def test_every_file_composes_and_builds(file):
    group, _, choice = file.rpartition("/")
    made = components(*([f"{group}={choice}"] if group else []), *NEEDED.get(file, []))
    assert isinstance(made.conditions.team.make(), Policy)
    assert isinstance(made.benchmark, Benchmark)
    if file != "policy/none":
        assert made.newcomer is not None
        assert isinstance(made.newcomer.make(), Policy)
    if group == "world":
        assert isinstance(made.world, World)
        made.world.close()


@pytest.mark.parametrize("file", [file for file in FILES if file.count("/") == 1 and "policy/" in file])
def test_policies_have_the_name_of_their_file(file):
    name = file.removeprefix("policy/")
    newcomer = components(f"policy={name}").newcomer
    assert (name if newcomer else "none") == (newcomer.name if newcomer else name)


@pytest.mark.parametrize("name", sorted(WITH_A_MODEL))
def test_policies_with_a_model_name_it(name):
    newcomer = components(f"policy={name}", "llm=gpt4_paper").newcomer
    assert newcomer is not None
    assert newcomer.model_name == "gpt-4-1106-preview"
    assert newcomer.settings["llm"]["temperature"] == 0.3


def test_the_offline_reasoner_is_labelled_as_no_language_model():
    newcomer = components().newcomer
    assert newcomer is not None
    assert newcomer.model_name == "offline (not a language model)"


def test_policies_without_a_model_build_none():
    """So that a heuristic robot needs no key whatever `llm` says."""
    newcomer = components("policy=heuristic", "llm=litellm").newcomer
    assert newcomer is not None
    assert newcomer.model is None
    assert "llm" not in newcomer.settings


class Probe:
    """A stage that remembers what it was given."""

    models: ClassVar[list[LanguageModel]] = []

    def __init__(self, model: LanguageModel) -> None:
        self.models.append(model)


class GeneratorProbe(Probe, SubTaskGenerator):
    def generate(self, context):
        raise NotImplementedError

    def __init__(self, model: LanguageModel, n: int) -> None:
        super().__init__(model)


class EvaluatorProbe(Probe, Evaluator):
    def rank(self, context, candidates):
        raise NotImplementedError


def test_all_stages_and_policies_share_one_model(monkeypatch):
    Probe.models.clear()
    monkeypatch.setattr("adhoc.planning.generate.LLMGenerator", GeneratorProbe)
    monkeypatch.setattr("adhoc.planning.evaluate.LLMEvaluator", EvaluatorProbe)
    newcomer = components().newcomer
    assert newcomer is not None
    assert newcomer.make() is not newcomer.make()
    assert len(Probe.models) == 2 * 3
    (shared,) = {id(model): model for model in Probe.models}.values()
    assert newcomer.model is not None
    newcomer.model.begin_episode("an episode", 0)
    shared.complete(LMRequest((ChatMessage("user", "hello"),), "generate"))
    assert newcomer.model.total.calls == 1


def test_what_the_team_asks_is_counted_apart():
    made = components("team=llm", "policy=none")
    assert made.conditions.team.model_name == "offline (not a language model)"
    assert made.conditions.team.settings["llm"]["forget_capability"] == 0.05
    assert not components("team=heuristic", "policy=none").conditions.team.model


VISIBLE = {
    "policy/generator/candidates": {"n"},
    "policy/generator/gpl": {"n"},
    "policy/planner/staged": {"max_rounds"},
    "policy/agent/llm": {"patience", "pause"},
    "team/agent/llm": {"adaptive", "rounds", "patience", "pause"},
    "llm/offline": {"seed", "forget_capability", "ignore_teammate", "ignore_reply"},
    "llm/litellm": {"temperature", "timeout", "max_tokens", "api_base", "structured", "window"},
    "llm/local": {"temperature", "max_tokens", "structured", "window", "threads", "at_once", "gpu_layers"},
    "imperfections/none": {
        *("loss", "delay", "jitter", "range"),
        *("silent", "wrong", "untruthful", "breaks_down", "battery", "leaves"),
    },
    "task/common_sense/llm": {"repairs", "max_tokens"},
    "world/pybullet": {"image_size", "renderer", "mass_scale"},
    "benchmark/paper": {"dataset", "split", "subset", "mass_scale", "folder"},
    "benchmark/procthor10k": {"path", "split", "houses_per_count", "counts", "seed"},
}
"""The main parameters of components: they must be in the files, so that they are seen and can be set."""
CHOSEN = {
    ("policy/generator/cot", "n"),
    ("policy/generator/cot", "template"),
    ("policy/generator/naive", "n"),
    ("policy/generator/naive", "template"),
    ("policy/sub_skill_planner/direct", "template"),
    ("policy/heuristic", "member"),
}
"""What files set to something else than the class, which is what makes them another choice."""


def written_settings():
    """Every component in every file: `(file, target, settings)`."""
    for file in FILES:
        content = yaml.safe_load((ROOT / f"{file}.yaml").read_text(encoding="utf-8"))
        for config in (content, *(part for part in content.values() if isinstance(part, dict))):
            if "_target_" in config:
                yield file, config["_target_"], {key: config[key] for key in config if key != "_target_"}


def test_the_main_parameters_are_in_the_files():
    settings = {file: set(keys) for file, _, keys in written_settings()}
    assert {file: keys & settings[file] for file, keys in VISIBLE.items()} == VISIBLE


def test_what_files_say_is_what_classes_do_without_them():
    compared = set()
    for file, path, settings in written_settings():
        parameters = parameters_of(locate({"_target_": path}, file), file)
        for name, value in settings.items():
            default = parameters[name].default if name in parameters else inspect.Parameter.empty
            default = list(default) if isinstance(default, tuple) else default
            if default is not inspect.Parameter.empty and name != "name":
                differs = (type(value), value) != (type(default), default)
                assert differs == ((file, name) in CHOSEN), f"{file}: {name}: {value!r}, not {default!r}"
                compared.add((file, name))
    assert compared >= CHOSEN
    assert compared >= {(file, name) for file, names in VISIBLE.items() for name in names}


def test_the_sample_is_the_paper_but_for_the_subset():
    sample, paper = (components(f"benchmark={name}").benchmark for name in ("sample", "paper"))
    assert vars(sample) == {**vars(paper), "_subset": "sample"}


class OwnWorld:
    def __init__(self, image_size: int = 3, own: int = 4) -> None:
        self.image_size, self.own = image_size, own


class Greedy:
    def __init__(self, **settings: object) -> None:
        self.settings = settings


@pytest.mark.parametrize(
    ("target", "more", "left"),
    [
        ("test_configs.OwnWorld", [], {"image_size"}),
        ("test_configs.OwnWorld", ["world.renderer=tiny"], {"image_size", "renderer"}),
        ("test_configs.OwnWorld", ["+world.own=5"], {"image_size", "own"}),
        ("test_configs.Greedy", [], {"image_size", "renderer", "mass_scale"}),
        ("test_configs.Nothing", [], {"image_size", "renderer", "mass_scale"}),
    ],
)
def test_a_replaced_class_keeps_what_fits_it_and_what_was_given(target, more, left):
    register_schema()
    overrides = [f"world._target_={target}", *more]
    with initialize_config_dir(str(ROOT), version_base="1.3"):
        config = compose("run", overrides)
    drop_foreign_settings(config, overrides)
    assert set(config.world) == {"_target_", "name", *left}
    assert set(config.llm) > {"_target_", "name"}


class TestBuild:
    def test_offers_fill_parameters_by_name_but_not_over_settings(self):
        target = "adhoc.core.values.Pose"
        offers = {"x": lambda: 5.0, "yaw": lambda: 1.0, "other": lambda: 1 / 0}
        assert build({"_target_": target, "y": 2.0, "yaw": 3.0}, "here", offers) == Pose(5.0, 2.0, 3.0)

    def test_nested_targets_are_built_and_values_stay_plain(self):
        member = {
            "_target_": "adhoc.evaluation.scenario.Member",
            "name": "me",
            "capability": {"plain": 1},
            "pose": {"_target_": "adhoc.core.values.Pose", "x": 1.0, "y": 2.0},
        }
        built = build(member, "here")
        assert built.pose == Pose(1.0, 2.0)
        assert built.capability == {"plain": 1}

    @pytest.mark.parametrize(
        ("config", "told"),
        [
            ({}, "here._target_=None: must be the dotted name"),
            ({"_target_": "Pose"}, "must be the dotted name"),
            ({"_target_": "adhoc.nothing.Pose"}, "cannot be imported"),
            ({"_target_": "adhoc.core.values.Nothing"}, "cannot be imported"),
            ({"_target_": "adhoc.core.values.MANIPULATION"}, "is no class or function"),
            ({"_target_": "adhoc.core.values.Pose", "x": 1}, "missing a required argument: 'y'"),
            ({"_target_": "adhoc.core.values.Pose", "z": 1}, "its parameters are: x, y, yaw, pitch"),
        ],
    )
    def test_errors_name_the_place_and_what_would_be_right(self, config, told):
        with pytest.raises(ConfigurationError, match="here") as error:
            build(config, "here")
        assert told in str(error.value)

    @pytest.mark.parametrize(
        ("settings", "told"),
        [
            ({"whole": "4"}, "here.whole='4': must be int"),
            ({"whole": True}, "here.whole=True: must be int"),
            ({"real": "x"}, "here.real='x': must be float or null"),
            ({"flag": 1}, "here.flag=1: must be bool"),
            ({"text": 3}, "here.text=3: must be str"),
            ({"limit": -1}, "here.limit=-1: test_configs.Typed cannot be made of this: ValueError: too low"),
        ],
    )
    def test_a_value_that_does_not_fit_is_named(self, settings, told):
        with pytest.raises(ConfigurationError) as error:
            build({"_target_": "test_configs.Typed", **settings}, "here")
        assert str(error.value).startswith(told)

    @pytest.mark.parametrize(
        "settings", [{"real": 1}, {"real": None}, {"whole": 3, "flag": True}, {"any": 3}]
    )
    def test_a_value_that_fits_is_taken(self, settings):
        assert isinstance(build({"_target_": "test_configs.TypedHeir", **settings}, "here"), Typed)

    def test_an_heir_is_checked_as_its_parent_is(self):
        with pytest.raises(ConfigurationError, match="must be int"):
            build({"_target_": "test_configs.TypedHeir", "whole": "4"}, "here")

    def test_the_cause_and_its_line_are_kept(self):
        with pytest.raises(ConfigurationError, match=r"test_configs\.py, line \d+") as error:
            build({"_target_": "test_configs.Typed", "limit": -1}, "here")
        assert isinstance(error.value.__cause__, ValueError)

    def test_the_kind_is_checked(self):
        assert isinstance(build({"_target_": "test_configs.Typed"}, "here", kind=Typed), Typed)
        with pytest.raises(ConfigurationError, match="here: Typed is no Policy"):
            build({"_target_": "test_configs.Typed"}, "here", kind=Policy)


class Typed:
    def __init__(
        self,
        whole: int = 1,
        real: float | None = None,
        flag: bool = False,
        text: str = "",
        any: object = None,
        limit: int = 0,
    ) -> None:
        if limit < 0:
            raise ValueError("too low")


class TypedHeir(Typed):
    pass
