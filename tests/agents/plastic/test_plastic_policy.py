"""The PLASTIC robot: keeps the contract, knows what a newcomer may know, acts as the likeliest type."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from adhoc import Call, Capability, HeuristicPolicy, MessageKind, Policy, TidyingUp, run_episode
from adhoc.agents import communication
from adhoc.agents.learned.checkpoint import save_checkpoint
from adhoc.agents.learned.decision import KINDS, SubSkillKind
from adhoc.agents.learned.layers import initial_parameters
from adhoc.agents.memory import Memory
from adhoc.agents.plastic.deeds import Heard
from adhoc.agents.plastic.library import SHIPPED, types_in
from adhoc.agents.plastic.models import DECISION, HEARD, KIND, type_shapes
from adhoc.agents.plastic.plastic_policy import PlasticPolicy
from adhoc.agents.plastic.strangers import Strangers
from adhoc.core.errors import CheckpointError, ConfigurationError
from adhoc.core.values import ActionName, Pose
from adhoc.evaluation.benchmark import Draw, SampleBenchmark
from adhoc.testing.policy_contract import PolicyContract
from adhoc.worlds.pybullet_world import PyBulletWorld


class TestPlastic(PolicyContract):
    make = PlasticPolicy


def library(folder, deed_of: dict[str, Heard], kind_of: dict[str, SubSkillKind]):
    """Types that hold one deed and one decision to be all there is."""
    for name, deed in deed_of.items():
        tensors = {part: np.zeros(shape, np.float32) for part, shape in type_shapes().items()}
        tensors[f"{HEARD}.logits.bias"][deed] = 8.0
        tensors[f"{DECISION}.logits.bias"][KINDS.index(kind_of[name])] = 8.0
        save_checkpoint(folder / f"{name}.safetensors", KIND, tensors, {"type": name})
    return str(folder)


def play(newcomer: Policy, team: type[HeuristicPolicy] = HeuristicPolicy, max_steps: int = 60):
    world = PyBulletWorld(image_size=64)
    draw = Draw("corridor", seed=0, misplaced=2, teammates=3)
    (scenario,) = SampleBenchmark([draw]).scenarios(world, 0)
    result = run_episode(
        world, scenario, TidyingUp(), [team() for _ in scenario.team], newcomer, 0, max_steps
    )
    world.close()
    return result


class Mute(HeuristicPolicy):
    """Says nothing to anybody and answers nothing."""

    def act(self, observation, inbox):
        return replace(super().act(observation, inbox), outbox=())

    def respond(self, message):
        return None


def test_it_comes_to_believe_in_the_type_that_fits_and_acts_by_it(tmp_path):
    deeds = {"searchers": Heard.SEARCHES_HERE, "stoppers": Heard.STOPS}
    kinds = {"searchers": SubSkillKind.EXPLORE, "stoppers": SubSkillKind.STOP}
    folder = library(tmp_path, deeds, kinds)
    newcomer = PlasticPolicy(checkpoints=folder)
    result = play(newcomer)
    actions = [step.actions.get("newcomer") for step in result.trace.steps]
    assert newcomer.beliefs["searchers"] > 0.8
    assert ActionName.STOP.value not in actions[:20]
    only = PlasticPolicy(checkpoints=folder, types=["stoppers"])
    actions = [step.actions.get("newcomer") for step in play(only, max_steps=5).trace.steps]
    assert actions[1] == ActionName.STOP.value


def test_beliefs_are_in_the_trace_with_what_changed_them(tmp_path):
    deeds = {"searchers": Heard.SEARCHES_HERE, "stoppers": Heard.STOPS}
    folder = library(tmp_path, deeds, dict.fromkeys(deeds, SubSkillKind.EXPLORE))
    newcomer = PlasticPolicy(checkpoints=folder)
    mine = [it for it in play(newcomer).trace.decisions if it.agent == "newcomer"]
    assert mine[0].step == 0
    assert set(mine[0].trace["beliefs"]) == {"searchers", "stoppers"}
    assert all(it.trace["behaviour"] for it in mine[1:])
    assert mine[-1].trace["beliefs"] == pytest.approx(dict(newcomer.beliefs), abs=1e-3)


def test_a_silent_team_is_known_by_sight_alone_and_these_types_look_alike(tmp_path, monkeypatch):
    deeds = {"searchers": Heard.SEARCHES_HERE, "stoppers": Heard.STOPS}
    folder = library(tmp_path, deeds, dict.fromkeys(deeds, SubSkillKind.EXPLORE))
    newcomer = PlasticPolicy(checkpoints=folder)
    decisions = [it for it in play(newcomer, Mute).trace.decisions if it.agent == "newcomer"]
    heard = [
        it for one in decisions for it in one.trace.get("behaviour", ()) if it["deed"] in Heard.__members__
    ]
    assert heard == []
    assert newcomer.beliefs == pytest.approx({"searchers": 0.5, "stoppers": 0.5})


def test_it_says_nothing_in_private_and_does_not_listen_to_private_talk():
    newcomer = PlasticPolicy()
    result = play(newcomer, max_steps=15)
    private = [it for it in result.trace.messages if it.kind is MessageKind.TEAM]
    assert private
    assert "newcomer" not in {message.sender for message in private}


def test_strangers_are_known_by_their_public_words_and_by_sight():
    memory = Memory("newcomer", TidyingUp())
    strangers = Strangers(memory, TidyingUp())
    call = Call("Re-place", ("Mug_1", "Sink", "Kitchen"))
    unable = Capability(can_manipulate=False)
    for name, sub_task, capability in (("a", call, Capability()), ("b", None, unable)):
        state = communication.state_payload(Pose(1.0, 2.0), capability, None, None, 400, sub_task, None)
        memory.hear([replace(communication.task_state_message("", state), sender=name, step=3)])
    strangers.look(4, {"b": (5.0, 5.0), "c": (0.0, 1.0)})
    assert {name: state.position for name, state in strangers.members.items()} == {
        "a": (1.0, 2.0),
        "b": (5.0, 5.0),
        "c": (0.0, 1.0),
    }
    assert [strangers.members[name].busy for name in "abc"] == ["Mug_1", None, None]
    assert not strangers.members["b"].capability.can_manipulate


def test_the_shipped_library_has_the_pre_defined_types():
    assert {"heuristic", "learned", "explore_only", "nearest_first", "room_by_room"} <= set(types_in())
    assert all(model.card["type"] == name for name, model in types_in().items())
    assert (SHIPPED / "MODEL_CARD.md").is_file()


def test_what_is_no_library_is_refused(tmp_path):
    with pytest.raises(CheckpointError, match="adhoc train plastic"):
        PlasticPolicy(checkpoints=str(tmp_path))
    with pytest.raises(ConfigurationError, match=r"no type 'dancers'.*heuristic"):
        PlasticPolicy(types=["dancers"])
    with pytest.raises(ConfigurationError, match="eta=2"):
        PlasticPolicy(eta=2.0)
    (tmp_path / "broken.safetensors").write_bytes(b"no tensors")
    with pytest.raises(CheckpointError, match="broken"):
        PlasticPolicy(checkpoints=str(tmp_path))


@pytest.mark.parametrize("spoil", ["kind", "missing", "shape", "extra", "absurd"])
def test_a_foreign_or_ill_shaped_type_is_refused_with_what_is_wrong(tmp_path, spoil):
    tensors = initial_parameters(type_shapes(), np.random.default_rng(0))
    name = f"{HEARD}.logits.weight"
    if spoil == "missing":
        del tensors[name]
    if spoil == "shape":
        tensors[name] = tensors[name][:, 1:]
    if spoil == "extra":
        tensors["more"] = np.zeros(1, np.float32)
    if spoil == "absurd":
        tensors[name][0, 0] = 3e38
    path = tmp_path / "type.safetensors"
    save_checkpoint(path, "other" if spoil == "kind" else KIND, tensors, {})
    told = {"kind": "kind", "missing": name, "shape": name, "extra": "more", "absurd": name}[spoil]
    with pytest.raises(CheckpointError, match=told) as error:
        types_in(tmp_path)
    assert str(path) in str(error.value)
