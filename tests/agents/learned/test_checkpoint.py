"""Checkpoints come back as they were written, and nothing else passes for one."""

from __future__ import annotations

import json
import os
import pickle
import struct
import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents.learned.checkpoint import CARD_BYTES, digest_of, load_checkpoint, save_checkpoint
from adhoc.core.errors import CheckpointError

SHAPES = {"hidden.weight": (3, 2), "hidden.bias": (2,)}
CARD = {"seed": 7, "accuracy": 0.5}


def tensors(**changes):
    made = {
        name: np.arange(np.prod(shape), dtype=np.float32).reshape(shape) for name, shape in SHAPES.items()
    }
    return {**made, **changes}


@pytest.fixture
def path(tmp_path):
    made = tmp_path / "some.safetensors"
    save_checkpoint(made, "judge", tensors(), CARD)
    return made


def test_what_was_written_comes_back(path):
    loaded = load_checkpoint(path, "judge", SHAPES)
    assert loaded.card == CARD
    assert {name: value.tolist() for name, value in loaded.tensors.items()} == {
        "hidden.weight": [[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]],
        "hidden.bias": [0.0, 1.0],
    }


def test_equal_content_gives_equal_bytes(path):
    before = path.read_bytes()
    for _ in range(8):
        save_checkpoint(path, "judge", tensors(), CARD)
        assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {"hidden.bias": np.zeros(3, np.float32)},
            r"'hidden.bias' is F32 \[3\]; it should be F32 \[2\]",
        ),
        (
            {"extra": np.zeros(1, np.float32)},
            "'extra' is unknown; there should be hidden.bias, hidden.weight",
        ),
        (
            {"hidden.bias": np.array([1.0, np.nan], np.float32)},
            "'hidden.bias' has numbers that are not finite",
        ),
        (
            {"hidden.bias": np.array([1.0, -3e38], np.float32)},
            r"'hidden.bias' has a number of size 3e\+38; none should be larger than 10000",
        ),
    ],
)
def test_other_tensors_are_refused(tmp_path, changes, told):
    path = tmp_path / "other.safetensors"
    save_checkpoint(path, "judge", tensors(**changes), CARD)
    with pytest.raises(CheckpointError, match=told) as caught:
        load_checkpoint(path, "judge", SHAPES)
    assert str(path) in str(caught.value)


def test_a_missing_tensor_is_named_with_its_shape(path):
    with pytest.raises(CheckpointError, match=r"'logits' is missing; its shape should be \[2, 9\]"):
        load_checkpoint(path, "judge", {**SHAPES, "logits": (2, 9)})


def test_another_type_of_numbers_is_refused(tmp_path):
    from safetensors.numpy import save_file

    path = tmp_path / "double.safetensors"
    content = '{"kind": "judge", "version": "1", "card": {}}'
    doubles = {name: value.astype(np.float64) for name, value in tensors().items()}
    save_file(doubles, str(path), {"adhoc": content})
    with pytest.raises(CheckpointError, match=r"F64 \[3, 2\]; it should be F32"):
        load_checkpoint(path, "judge", SHAPES)


def test_another_kind_is_refused(path):
    with pytest.raises(CheckpointError, match="kind is 'judge'; it should be 'decision'"):
        load_checkpoint(path, "decision", SHAPES)


@pytest.mark.parametrize(
    "metadata", [None, {"adhoc": "{"}, {"adhoc": "[]"}, {"adhoc": '{"kind": "judge"}'}, {"format": "pt"}]
)
def test_a_foreign_safetensors_file_is_refused(tmp_path, metadata):
    from safetensors.numpy import save_file

    path = tmp_path / "foreign.safetensors"
    save_file(tensors(), str(path), metadata)
    with pytest.raises(CheckpointError, match="metadata field 'adhoc'"):
        load_checkpoint(path, "judge", SHAPES)


def test_no_pickle_is_read(tmp_path):
    path = tmp_path / "pickled.safetensors"
    path.write_bytes(pickle.dumps(tensors()))
    with pytest.raises(CheckpointError, match="damaged, or no safetensors file"):
        load_checkpoint(path, "judge", SHAPES)


@pytest.mark.parametrize("name", ["nothing.safetensors", ""])
def test_a_file_that_cannot_be_read_is_named(tmp_path, name):
    with pytest.raises(CheckpointError, match=r"cannot be read|damaged"):
        load_checkpoint(tmp_path / name, "judge", SHAPES)


def write_by_hand(path, metadata, dtype="F32", item=4, length=1, shape=None):
    """A file of one tensor `a` of zeros, which take no room on the disk."""
    size = item * length
    tensor = {"dtype": dtype, "shape": [length] if shape is None else shape, "data_offsets": [0, size]}
    header = json.dumps({"__metadata__": {"adhoc": metadata}, "a": tensor}).encode()
    path.write_bytes(struct.pack("<Q", len(header)) + header)
    os.truncate(path, 8 + len(header) + size)
    return path


GOOD = '{"kind": "judge", "version": "1", "card": {}}'


def test_the_file_by_hand_is_right_but_for_what_tests_do_to_it(tmp_path):
    path = write_by_hand(tmp_path / "by_hand.safetensors", GOOD)
    assert load_checkpoint(path, "judge", {"a": (1,)}).tensors["a"].tolist() == [0.0]


@pytest.mark.parametrize(
    ("metadata", "layout", "told"),
    [
        ("[" * 100_000, {}, "cannot be read as JSON"),
        (
            '{"kind": "judge", "version": ' + "9" * 6000 + ', "card": {}}',
            {},
            "cannot be read as JSON|version",
        ),
        (GOOD.replace('"judge"', '"' + "x" * 10_000 + '"'), {}, "kind is 'xxx.{,40}; it should be 'judge'"),
        (GOOD.replace('"1"', '"2"'), {}, "version is '2'; it should be '1'"),
        (GOOD, {"dtype": "F8_E4M3", "item": 1}, r"'a' is F8_E4M3 \[1\]; it should be F32 \[1\]"),
        (GOOD, {"dtype": "BF16", "item": 2}, r"'a' is BF16 \[1\]"),
        (GOOD, {"shape": []}, r"'a' is F32 \[\]; it should be F32 \[1\]"),
    ],
    ids=["deep", "long number", "long kind", "other version", "eight bits", "sixteen bits", "scalar"],
)
def test_a_hostile_header_is_refused(tmp_path, metadata, layout, told):
    path = write_by_hand(tmp_path / "hostile.safetensors", metadata, **layout)
    with pytest.raises(CheckpointError, match=told) as caught:
        load_checkpoint(path, "judge", {"a": (1,)})
    assert str(caught.value).startswith(str(path))


@pytest.mark.parametrize("length", [2**28, 2**34], ids=["1 GiB", "64 GiB"])
def test_a_huge_file_is_refused_unread(tmp_path, length):
    path = write_by_hand(tmp_path / "huge.safetensors", GOOD.replace("judge", "other"), length=length)
    with pytest.raises(CheckpointError, match=f"bytes; a checkpoint .* at most {CARD_BYTES + 4}, ") as caught:
        load_checkpoint(path, "judge", {"a": (1,)})
    assert f"{path}: {path.stat().st_size} bytes" in str(caught.value)


def test_no_tensor_is_loaded_before_the_kind_is_known(tmp_path):
    length = 2**20
    path = write_by_hand(tmp_path / "other.safetensors", GOOD.replace("judge", "other"), length=length)
    tracemalloc.start()
    try:
        with pytest.raises(CheckpointError, match="kind is 'other'"):
            load_checkpoint(path, "judge", {"a": (length,)})
        assert tracemalloc.get_traced_memory()[1] < length
    finally:
        tracemalloc.stop()


def test_a_card_that_could_not_be_read_again_is_not_written(path):
    before = path.read_bytes()
    with pytest.raises(CheckpointError, match="for the card"):
        save_checkpoint(path, "judge", tensors(), {"losses": "0" * CARD_BYTES})
    assert path.read_bytes() == before


def test_a_pipe_is_refused_instead_of_waited_for(tmp_path):
    path = tmp_path / "pipe.safetensors"
    os.mkfifo(path)
    writer = os.open(path, os.O_RDWR)  # without one, opening the pipe by mistake would block for good
    try:
        with pytest.raises(CheckpointError, match="no regular file"):
            load_checkpoint(path, "judge", SHAPES)
        with pytest.raises(CheckpointError, match="no regular file"):
            digest_of(tmp_path)
    finally:
        os.close(writer)


@pytest.mark.parametrize(
    "load", [lambda path: load_checkpoint(path, "judge", SHAPES), lambda path: digest_of(path.parent)]
)
def test_a_folder_named_like_a_checkpoint_is_none(tmp_path, load):
    path = tmp_path / "folder.safetensors"
    path.mkdir()
    with pytest.raises(CheckpointError, match=r"folder\.safetensors: cannot be read: it is no regular file"):
        load(path)


def test_a_write_that_is_cut_short_leaves_the_old_file(path, monkeypatch):
    def fail(*_):
        raise OSError("no space left")

    before = path.read_bytes()
    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="no space left"):
        save_checkpoint(path, "judge", tensors(), {"another": "card"})
    assert path.read_bytes() == before


def test_the_digest_is_of_names_and_contents_and_takes_little_memory(path):
    first = digest_of(path.parent)
    other = path.rename(path.with_name("other.safetensors"))
    second = digest_of(path.parent)
    os.truncate(other, 2**24)
    tracemalloc.start()
    try:
        third = digest_of(path.parent)
        assert tracemalloc.get_traced_memory()[1] < 2**23
    finally:
        tracemalloc.stop()
    assert len({first, second, third}) == 3


@given(data=st.data())
def test_a_damaged_file_is_refused_or_read_whole(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("damaged") / "some.safetensors"
    save_checkpoint(path, "judge", tensors(), CARD)
    content = bytearray(path.read_bytes())
    if data.draw(st.booleans()):
        content = content[: data.draw(st.integers(0, len(content) - 1))]
    else:
        content[data.draw(st.integers(0, len(content) - 1))] ^= data.draw(st.integers(1, 255))
    path.write_bytes(bytes(content))
    try:
        loaded = load_checkpoint(path, "judge", SHAPES)
    except CheckpointError:
        return
    assert {name: value.shape for name, value in loaded.tensors.items()} == SHAPES
