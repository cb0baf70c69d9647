"""Fitting a classifier to examples: behaviour cloning where the examples are an expert's decisions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.learned.layers import Network, initial_parameters
from adhoc.core.errors import ConfigurationError, MissingDependency
from adhoc.core.streams import stream


@dataclass(frozen=True)
class Examples:
    """Inputs (N, features) float32, and the class (N,) int64 of each, or one target for every class (N, C)
    float32 in [0, 1]. `weights` (N,) float32 says how much each counts; equally if None."""

    inputs: NDArray[np.float32]
    labels: NDArray[Any]
    weights: NDArray[np.float32] | None = None

    def __len__(self) -> int:
        return len(self.inputs)


@dataclass(frozen=True)
class FitSettings:
    """How a network is fitted: Adam over shuffled batches, the learning rate falling to 0 as a cosine."""

    seed: int = 0
    epochs: int = 40
    batch: int = 256
    learning_rate: float = 3e-3
    weight_decay: float = 1e-4
    balance: float = 0.0
    """Exponent of the inverse frequency with which classes are weighted: 0 not at all, 1 all classes alike.
    For one class per example only."""


@dataclass(frozen=True)
class Fit:
    """A fitted network: the parameters of the epoch of the lowest held-out loss, and how it got there."""

    parameters: Mapping[str, NDArray[np.float32]]
    losses: tuple[float, ...]
    """Mean training loss of each epoch."""
    held_out_losses: tuple[float, ...]
    best_epoch: int
    settings: FitSettings

    def summary(self) -> dict[str, Any]:
        """For a model card, as JSON values."""
        return {
            "settings": asdict(self.settings),
            "best_epoch": self.best_epoch,
            "losses": [round(loss, 6) for loss in self.losses],
            "held_out_losses": [round(loss, 6) for loss in self.held_out_losses],
        }


def fit_classifier(
    network: Network, training: Examples, held_out: Examples, settings: FitSettings = FitSettings()
) -> Fit:
    """Fit a network by cross entropy; equal arguments give equal results on one machine.

    Everything random is drawn with numpy from `settings.seed`; torch's own generator is not touched.

    Args:
        network: What is fitted.
        training: What it is fitted to.
        held_out: By which the best epoch is chosen; not for reporting.
        settings: How.

    Raises:
        ConfigurationError: There are no examples, or they do not fit each other.
        MissingDependency: torch is not installed.
    """
    _check(training, held_out)
    torch = _torch()
    generator = stream(settings.seed, "fit")
    with _one_thread(torch):
        return _Fitting(torch, network, settings, generator).run(training, held_out)


def predict(
    network: Network, parameters: Mapping[str, NDArray[np.float32]], inputs: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Logits (N, classes), computed as robots do, with numpy."""
    return np.asarray(network.forward(parameters, inputs))


def accuracies(
    predicted: NDArray[np.int64], labels: NDArray[np.int64], names: Sequence[str]
) -> dict[str, Any]:
    """The share of right predictions, over all, and by the true class (None for a class without examples)."""
    right = predicted == labels
    recall = {
        name: float(right[labels == number].mean()) if (labels == number).any() else None
        for number, name in enumerate(names)
    }
    known = [share for share in recall.values() if share is not None]
    return {
        "examples": len(labels),
        "accuracy": float(right.mean()) if len(labels) else None,
        "balanced_accuracy": float(np.mean(known)) if known else None,
        "by_class": recall,
    }


class _Fitting:
    def __init__(
        self, torch: Any, network: Network, settings: FitSettings, generator: np.random.Generator
    ) -> None:
        self._torch, self._network, self._settings = torch, network, settings
        self._generator = generator
        initial = initial_parameters(network.shapes, generator)
        self._parameters = {name: torch.tensor(value, requires_grad=True) for name, value in initial.items()}
        self._class_weights: Any = None

    def run(self, training: Examples, held_out: Examples) -> Fit:
        self._class_weights = self._weights_of(training)
        inputs, labels, weights = self._tensors(training)
        test = self._tensors(held_out)
        optimizer = self._torch.optim.AdamW(
            list(self._parameters.values()),
            lr=self._settings.learning_rate,
            weight_decay=self._settings.weight_decay,
        )
        per_epoch = -(-len(training) // self._settings.batch)
        schedule = self._torch.optim.lr_scheduler.CosineAnnealingLR(
            optimizer, self._settings.epochs * per_epoch
        )
        losses: list[float] = []
        held_out_losses: list[float] = []
        best, best_epoch = self._snapshot(), 0
        for epoch in range(self._settings.epochs):
            total = 0.0
            order = self._torch.from_numpy(self._generator.permutation(len(training)))
            for start in range(0, len(training), self._settings.batch):
                chosen = order[start : start + self._settings.batch]
                loss = self._loss(inputs[chosen], labels[chosen], weights[chosen])
                optimizer.zero_grad()
                loss.backward()
                optimizer.step()
                schedule.step()
                total += float(loss.detach()) * len(chosen)
            losses.append(total / len(training))
            with self._torch.no_grad():
                held_out_losses.append(float(self._loss(*test)))
            if held_out_losses[-1] <= min(held_out_losses):
                best, best_epoch = self._snapshot(), epoch
        return Fit(best, tuple(losses), tuple(held_out_losses), best_epoch, self._settings)

    def _loss(self, inputs: Any, labels: Any, weights: Any) -> Any:
        logits = self._network.forward(self._parameters, inputs)
        functional = self._torch.nn.functional
        if labels.dim() == 1:
            each = functional.cross_entropy(logits, labels, reduction="none")
            weights = weights * self._class_weights[labels]
        else:
            each = functional.binary_cross_entropy_with_logits(logits, labels, reduction="none").mean(1)
        return (each * weights).sum() / weights.sum()

    def _weights_of(self, training: Examples) -> Any:
        if training.labels.ndim != 1:
            return None
        probe = self._network.forward(self._parameters, self._torch.from_numpy(training.inputs[:1]))
        counts = np.bincount(training.labels, minlength=probe.shape[1]).astype(np.float64)
        weights = np.where(counts > 0, np.maximum(counts, 1.0) ** -self._settings.balance, 0.0)
        return self._torch.from_numpy((weights / weights.max()).astype(np.float32))

    def _tensors(self, examples: Examples) -> tuple[Any, Any, Any]:
        weights = np.ones(len(examples), np.float32) if examples.weights is None else examples.weights
        return tuple(map(self._torch.from_numpy, (examples.inputs, examples.labels, weights)))

    def _snapshot(self) -> dict[str, NDArray[np.float32]]:
        return {name: value.detach().numpy().copy() for name, value in self._parameters.items()}


def _check(*sets: Examples) -> None:
    for examples in sets:
        sizes = {len(examples.inputs), len(examples.labels)}
        if examples.weights is not None:
            sizes.add(len(examples.weights))
        if len(sizes) > 1 or 0 in sizes:
            raise ConfigurationError(
                f"examples need as many inputs as labels and weights, at least one: {sorted(sizes)}"
            )


@contextmanager
def _one_thread(torch: Any) -> Iterator[None]:
    """Threads gain nothing with layers this small, and take the processor from others."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def _torch() -> Any:
    try:
        return import_module("torch")
    except ImportError as error:
        raise MissingDependency("training needs the package torch: pip install 'adhoc[learned]'") from error
