"""The decision module: one forward pass for two libraries, and only what the body is capable of."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from learned_situations import FRIEND, MUG, situation

from adhoc.agents.learned.decision import KINDS, DecisionModule, DecisionNetwork, SubSkillKind
from adhoc.agents.learned.features import DETECTION_SIZE, FEATURE_SIZE, OWN_SIZE, encode
from adhoc.agents.learned.layers import initial_parameters, largest, softmax
from adhoc.agents.learned.shipped import decision_in
from adhoc.core.values import Capability

NETWORK = DecisionNetwork()
PARAMETERS = initial_parameters(NETWORK.shapes, np.random.default_rng(3))


def biased(*scores):
    """A module that gives these logits whatever it sees."""
    blank = {name: np.zeros(shape, np.float32) for name, shape in NETWORK.shapes.items()}
    return DecisionModule({**blank, "logits.bias": np.array(scores, np.float32)})


def test_torch_and_numpy_agree():
    torch = pytest.importorskip("torch")
    rows = np.stack([encode(situation([MUG], [FRIEND])), encode(situation([MUG] * 7)), encode(situation())])
    by_torch = NETWORK.forward({k: torch.tensor(v) for k, v in PARAMETERS.items()}, torch.tensor(rows))
    by_numpy = NETWORK.forward(PARAMETERS, rows)
    assert by_numpy.shape == (3, len(KINDS))
    np.testing.assert_allclose(by_torch.numpy(), by_numpy, rtol=1e-4, atol=1e-5)


def test_the_largest_over_slots_is_the_maximum():
    values = np.random.default_rng(0).normal(size=(4, 5, 3)).astype(np.float32)
    np.testing.assert_allclose(largest(values), values.max(axis=1), rtol=1e-6)


def test_an_empty_slot_says_nothing_whatever_is_in_it():
    row = encode(situation([MUG]))
    strange = row.copy()
    strange[OWN_SIZE + DETECTION_SIZE + 1 : OWN_SIZE + 2 * DETECTION_SIZE] = 9.0
    rows = np.stack([row, strange])
    one, other = NETWORK.forward(PARAMETERS, rows)
    assert one.tolist() == pytest.approx(other.tolist())


def test_every_part_of_the_situation_counts():
    base = situation([MUG], [FRIEND])
    changed = [
        situation([MUG], [FRIEND], idle=True),
        situation([replace(MUG, handled=True)], [FRIEND]),
        situation([MUG], [replace(FRIEND, idle=True)]),
    ]
    (logits,) = NETWORK.forward(PARAMETERS, encode(base)[None])
    for other in changed:
        assert NETWORK.forward(PARAMETERS, encode(other)[None])[0].tolist() != logits.tolist()


def test_probabilities_are_those_of_the_logits():
    chances = biased(0.0, np.log(2.0), 0.0, 0.0).probabilities(situation())
    assert list(chances.values()) == pytest.approx([0.2, 0.4, 0.2, 0.2])
    assert softmax(np.array([[1000.0, 0.0]], np.float32)).tolist() == [[1.0, 0.0]]


@pytest.mark.parametrize(
    ("own", "chosen"),
    [
        ({"holding": True}, SubSkillKind.PUT_OBJECT),
        ({"holding": False}, SubSkillKind.PICKUP_OBJECT),
        ({"holding": False, "capability": Capability(can_manipulate=False)}, SubSkillKind.STOP),
    ],
)
def test_only_what_hand_and_abilities_allow_is_chosen(own, chosen):
    assert biased(0.0, 2.0, 3.0, 1.0).decide(situation(**own)) is chosen


def test_the_shipped_module_does_the_obvious():
    decide = decision_in()
    assert decide(situation()) is SubSkillKind.EXPLORE
    assert decide(situation([MUG])) is SubSkillKind.PICKUP_OBJECT
    assert decide(situation(holding=True, place_known=True)) is SubSkillKind.PUT_OBJECT
    nothing_left = {"idle": True, "frontiers": 0, "rooms_explored": 4}
    blind = {**nothing_left, "capability": Capability(can_manipulate=False)}
    assert decide(situation(**blind)) is SubSkillKind.STOP


def test_robots_need_no_torch():
    code = (
        "import sys; from adhoc.agents.learned.policy import LearnedPolicy; LearnedPolicy();"
        "assert 'torch' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_row_has_the_size_that_the_network_takes():
    assert sum(shape[0] for name, shape in NETWORK.shapes.items() if name in ("own.weight",)) == OWN_SIZE
    assert encode(situation()).shape == (FEATURE_SIZE,)
