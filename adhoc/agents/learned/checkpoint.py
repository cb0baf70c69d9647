"""Checkpoints: named float32 tensors with a model card, as safetensors files. No pickle is ever read."""

from __future__ import annotations

import hashlib
import json
import math
import reprlib
import stat
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import CheckpointError
from adhoc.core.whole_file import write_whole

SUFFIX = ".safetensors"
"""Of the names of checkpoints."""
VERSION = "1"
"""Of the meaning of the tensors and their order; a file of another version is refused."""

METADATA = "adhoc"
"""The one entry of a file's metadata: kind, version and card as JSON. With several, safetensors writes them
in an order that changes from file to file, and equal trainings would not give equal bytes."""

CARD_BYTES = 4 * 2**20
"""Room in a file for all that is no number: metadata and the names of tensors. A larger file is refused."""
LARGEST_WEIGHT = 1e4
"""Absolute value. Weights that were learned stay below 10; enormous ones overflow to beliefs that are no
numbers."""

Tensors = Mapping[str, NDArray[np.float32]]
Shapes = Mapping[str, tuple[int, ...]]
_NUMBER = "F32"
"""The type of all tensors, as safetensors names it."""
_CHUNK = 2**20


@dataclass(frozen=True)
class Checkpoint:
    """What a file holds: the tensors by name, and the model card as JSON values."""

    tensors: Tensors
    card: Mapping[str, Any]


def save_checkpoint(path: str | Path, kind: str, tensors: Tensors, card: Mapping[str, Any]) -> None:
    """Write a checkpoint; an old file is replaced at once or not at all.

    Args:
        path: A file name that ends in `.safetensors`; its folder must exist.
        kind: What the tensors are for, e.g. `sub_skill_decision`; `load_checkpoint` asks for it.
        tensors: Written as float32.
        card: The model card, JSON values: data, seeds, losses, accuracies.

    Raises:
        CheckpointError: The card is so large that `load_checkpoint` would refuse the file.
    """
    from safetensors.numpy import save

    content = json.dumps({"kind": kind, "version": VERSION, "card": card}, sort_keys=True)
    plain = {name: np.ascontiguousarray(tensors[name], np.float32) for name in sorted(tensors)}
    path = Path(path)
    written = save(plain, {METADATA: content})
    _check_size(path, len(written), {name: value.shape for name, value in plain.items()})
    write_whole(path, written)


def load_checkpoint(path: str | Path, kind: str, expected_shapes: Shapes) -> Checkpoint:
    """Read a checkpoint of that kind with exactly those tensors.

    Nothing is read of a file that is larger than such a checkpoint can be, and no tensor before kind,
    version, names, types and shapes of all are right.

    Raises:
        CheckpointError: The file cannot be read, is damaged, is of another kind or version, is larger than
            it can be, or lacks a tensor, has one too many, or one of another shape or type or with numbers
            that are not finite or beyond `LARGEST_WEIGHT`. The text names file, tensor, what was found and
            what is needed.
    """
    from safetensors import SafetensorError, safe_open

    path = Path(path)
    _check_size(path, _size_of(path), expected_shapes)
    try:
        with safe_open(str(path), framework="numpy") as file:
            card = _card(path, file.metadata() or {}, kind)
            _check_header(path, file, expected_shapes)
            tensors = {name: file.get_tensor(name) for name in expected_shapes}
    except OSError as error:
        raise _unreadable(path, error) from error
    except (SafetensorError, TypeError, ValueError) as error:
        raise CheckpointError(f"{path}: damaged, or no safetensors file: {error}") from error
    for name, value in tensors.items():
        _check_numbers(path, name, value)
    return Checkpoint(tensors, card)


def digest_of(folder: Path) -> str:
    """A hash of all checkpoints in a folder, their names included. Raises CheckpointError."""
    digest = hashlib.sha256()
    for path in sorted(folder.glob(f"*{SUFFIX}")):
        digest.update(path.name.encode() + b"\0" + _digest_of_file(path))
    return digest.hexdigest()[:16]


def _digest_of_file(path: Path) -> bytes:
    _size_of(path)
    digest = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while chunk := file.read(_CHUNK):
                digest.update(chunk)
    except OSError as error:
        raise _unreadable(path, error) from error
    return digest.digest()


def _size_of(path: Path) -> int:
    """In bytes. Pipes and devices are refused unopened: reading from one may never end."""
    try:
        found = path.stat()
    except OSError as error:
        raise _unreadable(path, error) from error
    except ValueError as error:
        raise CheckpointError(f"{str(path)!r}: cannot be read: {error}") from error
    if not stat.S_ISREG(found.st_mode):
        raise CheckpointError(f"{path}: cannot be read: it is no regular file")
    return found.st_size


def _unreadable(path: Path, error: OSError) -> CheckpointError:
    absent = isinstance(error, FileNotFoundError)
    return CheckpointError(
        f"{path}: cannot be read: {'there is no such file' if absent else error.strerror or error}"
    )


def _check_size(path: Path, size: int, shapes: Shapes) -> None:
    most = CARD_BYTES + np.dtype(np.float32).itemsize * sum(math.prod(shape) for shape in shapes.values())
    if size > most:
        raise CheckpointError(
            f"{path}: {size} bytes; a checkpoint with these tensors has at most {most}, "
            f"{CARD_BYTES} of them for the card"
        )


def _card(path: Path, metadata: Mapping[str, str], kind: str) -> Mapping[str, Any]:
    """The card of a file of that kind and of this version."""
    try:
        content = json.loads(metadata.get(METADATA, "null"))
    except (ValueError, RecursionError) as error:
        raise CheckpointError(
            f"{path}: metadata field {METADATA!r} cannot be read as JSON: {error}"
        ) from error
    if not isinstance(content, dict) or not isinstance(content.get("card"), dict):
        raise CheckpointError(
            f"{path}: metadata field {METADATA!r} should be an object with kind, version and card: "
            "the file was not written by this library"
        )
    for field, wanted in (("kind", kind), ("version", VERSION)):
        found = content.get(field)
        if found != wanted:
            raise CheckpointError(f"{path}: {field} is {reprlib.repr(found)}; it should be {wanted!r}")
    card: Mapping[str, Any] = content["card"]
    return card


def _check_header(path: Path, file: Any, expected: Shapes) -> None:
    """Names, types and shapes, by the header alone."""
    names = set(file.keys())
    for name, shape in expected.items():
        if name not in names:
            raise CheckpointError(f"{path}: tensor {name!r} is missing; its shape should be {list(shape)}")
        tensor = file.get_slice(name)
        found_type, found = tensor.get_dtype(), list(tensor.get_shape())
        if found_type != _NUMBER or found != list(shape):
            raise CheckpointError(
                f"{path}: tensor {name!r} is {found_type} {found}; it should be {_NUMBER} {list(shape)}"
            )
    for name in sorted(names - expected.keys()):
        raise CheckpointError(
            f"{path}: tensor {reprlib.repr(name)} is unknown; there should be {', '.join(sorted(expected))}"
        )


def _check_numbers(path: Path, name: str, values: NDArray[np.float32]) -> None:
    if not np.isfinite(values).all():
        raise CheckpointError(f"{path}: tensor {name!r} has numbers that are not finite")
    largest = float(np.abs(values).max(initial=0.0))
    if largest > LARGEST_WEIGHT:
        raise CheckpointError(
            f"{path}: tensor {name!r} has a number of size {largest:g}; "
            f"none should be larger than {LARGEST_WEIGHT:g}"
        )
