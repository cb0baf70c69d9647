"""What `import adhoc` offers, and what it does not drag in."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import adhoc

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("name", adhoc.__all__)
def test_every_exported_name_exists(name):
    assert getattr(adhoc, name) is not None


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no_such_thing"):
        adhoc.no_such_thing  # noqa: B018


@pytest.mark.parametrize(
    "statement", ["import adhoc", "from adhoc.cli.main import main; main(['--version'])"]
)
def test_heavy_libraries_are_loaded_only_when_used(statement):
    heavy = ("litellm", "torch", "pybullet", "numba", "hydra", "matplotlib", "networkx")
    code = (
        "import sys\n"
        f"try:\n    {statement}\nexcept SystemExit:\n    pass\n"
        f"sys.exit(', '.join(name for name in {heavy!r} if name in sys.modules) or None)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"loaded at once: {done.stderr}"


def test_only_the_task_names_its_sub_tasks():
    """Planners, agents and prompts learn sub-tasks from the task's declaration."""
    own = ROOT / "adhoc" / "tasks"
    files = [path for folder in ("adhoc", "prompts", "configs") for path in (ROOT / folder).rglob("*")]
    texts = [path for path in files if path.suffix in {".py", ".jinja", ".yaml"} and own not in path.parents]
    assert len(texts) > 100
    assert [path for path in texts if re.search(r"\bRe-place\b", path.read_text(encoding="utf-8"))] == []
