import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
WHEEL = "ADHOC_PROCTHOR_WHEEL"


def load(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"script_{name}", ROOT / "scripts" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def test_the_facts_script_makes_the_committed_tables():
    source = os.environ.get(WHEEL)
    if not source:
        pytest.skip(f"{WHEEL} names no procthor wheel")
    made = load("make_facts").fact_files(Path(source))
    committed = ROOT / "adhoc/houses/facts_data"
    assert set(made) == {path.name for path in committed.glob("*.json")}
    for name, text in made.items():
        assert text.encode() == (committed / name).read_bytes(), name


def test_the_samples_script_makes_the_committed_houses():
    made = load("make_samples").sample_files()
    committed = ROOT / "adhoc/houses/samples"
    assert set(made) == {path.name for path in committed.glob("*.json")}
    for name, text in made.items():
        assert text.encode() == (committed / name).read_bytes(), name
