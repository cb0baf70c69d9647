"""Fitting: what can be learned is learned, the same each time, and nothing global is left changed."""

from __future__ import annotations

import numpy as np
import pytest

from adhoc.agents.learned.placement_networks import TwoLayers
from adhoc.core.errors import ConfigurationError
from adhoc.training.behaviour_cloning import Examples, FitSettings, accuracies, fit_classifier, predict

torch = pytest.importorskip("torch")

NETWORK = TwoLayers(2, 2, width=16)
QUICK = FitSettings(seed=1, epochs=30, batch=32, learning_rate=0.01)


def exclusive_or(count, seed=0):
    inputs = np.random.default_rng(seed).choice([-1.0, 1.0], (count, 2)).astype(np.float32)
    return Examples(inputs, (inputs[:, 0] * inputs[:, 1] > 0).astype(np.int64))


def test_exclusive_or_is_learned():
    fit = fit_classifier(NETWORK, exclusive_or(400), exclusive_or(50, 1), QUICK)
    test = exclusive_or(100, 2)
    assert (predict(NETWORK, fit.parameters, test.inputs).argmax(axis=1) == test.labels).all()
    assert fit.losses[-1] < fit.losses[0]
    assert len(fit.losses) == len(fit.held_out_losses) == 30
    assert fit.held_out_losses[fit.best_epoch] == min(fit.held_out_losses)
    assert fit.summary()["settings"]["seed"] == 1


def test_equal_seeds_give_equal_parameters_and_others_do_not():
    settings = FitSettings(seed=5, epochs=2)
    first, second = (fit_classifier(NETWORK, exclusive_or(99), exclusive_or(9), settings) for _ in range(2))
    other = fit_classifier(NETWORK, exclusive_or(99), exclusive_or(9), FitSettings(seed=6, epochs=2))
    for name, value in first.parameters.items():
        assert value.tobytes() == second.parameters[name].tobytes()
    assert first.losses != other.losses


@pytest.fixture
def three_threads():
    before = torch.get_num_threads()
    torch.set_num_threads(3)
    yield
    torch.set_num_threads(before)


@pytest.mark.usefixtures("three_threads")
def test_nothing_global_changes():
    before = (torch.get_rng_state().tolist(), torch.get_num_threads(), np.random.get_state()[1].tolist())
    fit_classifier(NETWORK, exclusive_or(40), exclusive_or(9), FitSettings(epochs=1))
    after = (torch.get_rng_state().tolist(), torch.get_num_threads(), np.random.get_state()[1].tolist())
    assert after == before


def test_several_targets_at_once():
    inputs = exclusive_or(300).inputs
    targets = np.stack([inputs[:, 0] > 0, inputs[:, 1] > 0], axis=1).astype(np.float32)
    fit = fit_classifier(NETWORK, Examples(inputs, targets), Examples(inputs, targets), QUICK)
    assert ((predict(NETWORK, fit.parameters, inputs) > 0) == (targets > 0)).all()


def test_weights_decide_what_is_contradictory():
    inputs = np.ones((40, 2), np.float32)
    labels = np.arange(40) % 2
    for favoured in (0, 1):
        weights = np.where(labels == favoured, 5.0, 1.0).astype(np.float32)
        examples = Examples(inputs, labels, weights)
        fit = fit_classifier(NETWORK, examples, examples, QUICK)
        assert predict(NETWORK, fit.parameters, inputs[:1]).argmax() == favoured


def test_balance_lets_the_rare_class_count():
    inputs = np.ones((40, 2), np.float32)
    labels = np.array([1] * 4 + [0] * 36)
    chances = []
    for balance in (0.0, 1.0):
        settings = FitSettings(epochs=60, batch=40, learning_rate=0.01, balance=balance)
        fit = fit_classifier(NETWORK, Examples(inputs, labels), Examples(inputs, labels), settings)
        (logits,) = predict(NETWORK, fit.parameters, inputs[:1])
        chances.append(1 / (1 + np.exp(logits[0] - logits[1])))
    assert chances == pytest.approx([0.1, 0.5], abs=0.05)


@pytest.mark.parametrize(
    "examples",
    [
        Examples(np.ones((3, 2), np.float32), np.zeros(2, np.int64)),
        Examples(np.ones((0, 2), np.float32), np.zeros(0, np.int64)),
        Examples(np.ones((3, 2), np.float32), np.zeros(3, np.int64), np.ones(2, np.float32)),
    ],
)
def test_examples_that_do_not_fit_each_other_are_refused(examples):
    with pytest.raises(ConfigurationError, match="as many inputs as labels"):
        fit_classifier(NETWORK, examples, exclusive_or(3))


def test_accuracies_by_hand():
    found = accuracies(np.array([0, 0, 1, 2]), np.array([0, 1, 1, 1]), ["a", "b", "c"])
    assert found["accuracy"] == 0.5
    assert found["by_class"] == {"a": 1.0, "b": pytest.approx(1 / 3), "c": None}
    assert found["balanced_accuracy"] == pytest.approx(2 / 3)
