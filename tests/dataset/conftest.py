"""A tiny dataset, made once, and copies of it that tests may spoil."""

from __future__ import annotations

import shutil

import pytest
from tiny_dataset import make_tiny


@pytest.fixture(scope="session")
def tiny(tmp_path_factory):
    return make_tiny(tmp_path_factory.mktemp("tiny"))


@pytest.fixture
def copied(tiny, tmp_path):
    return shutil.copytree(tiny, tmp_path / "tiny")
