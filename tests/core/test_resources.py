"""Where configs and prompts are looked for."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import adhoc.core.resources as resources
from adhoc.core.errors import ConfigurationError, PromptError
from adhoc.core.resources import data_dir

ROOT = Path(__file__).parents[2]


@pytest.fixture(autouse=True)
def _no_overrides(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ADHOC_CONFIGS", raising=False)
    monkeypatch.delenv("ADHOC_PROMPTS", raising=False)


def test_in_a_checkout_it_is_the_folder_beside_the_package() -> None:
    assert data_dir("prompts") == ROOT / "prompts"


def test_the_environment_goes_first(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ADHOC_PROMPTS", str(tmp_path))
    monkeypatch.setenv("ADHOC_CONFIGS", str(tmp_path))
    assert data_dir("prompts") == data_dir("configs") == tmp_path


@pytest.mark.parametrize(("name", "error"), [("prompts", PromptError), ("configs", ConfigurationError)])
def test_a_missing_folder_is_named(
    name: str, error: type[Exception], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(f"ADHOC_{name.upper()}", str(tmp_path / "nowhere"))
    with pytest.raises(error, match=f"nowhere.*ADHOC_{name.upper()}"):
        data_dir(name)


def test_a_stale_packaged_copy_loses_against_the_checkout(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    package = tmp_path / "adhoc"
    (package / "prompts").mkdir(parents=True)
    monkeypatch.setattr(resources, "_PACKAGE", package)
    assert data_dir("prompts") == package / "prompts", "as installed from a wheel"
    (tmp_path / "pyproject.toml").touch()
    (tmp_path / "prompts").mkdir()
    assert data_dir("prompts") == tmp_path / "prompts", "as in a checkout"


def test_other_names_are_refused() -> None:
    with pytest.raises(ConfigurationError, match="secrets"):
        data_dir("secrets")


def test_a_package_without_a_checkout_finds_its_own_copy(tmp_path: Path) -> None:
    """Laid out as a wheel lays it out: the folders inside the package."""
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "adhoc" / "core", tmp_path / "adhoc" / "core", ignore=ignore)
    (tmp_path / "adhoc" / "__init__.py").touch()
    shutil.copytree(ROOT / "prompts", tmp_path / "adhoc" / "prompts")
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r})\n"
        "from adhoc.core.resources import data_dir; print(data_dir('prompts'))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, cwd=tmp_path
    )
    assert done.stdout.strip() == str(tmp_path / "adhoc" / "prompts")
