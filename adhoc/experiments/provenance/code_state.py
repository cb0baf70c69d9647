"""The state of the code that runs: version, commit, uncommitted changes, and the packages it stands on."""

from __future__ import annotations

import hashlib
import platform
import subprocess
import sys
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from adhoc import __version__

PACKAGES = (
    "numpy",
    "numba",
    "networkx",
    "jinja2",
    "pybullet",
    "litellm",
    "hydra-core",
    "omegaconf",
    "safetensors",
)
"""Packages whose versions may decide what is recorded."""
DECIDING = ("adhoc", "configs", "prompts")
"""Folders of the checkout that decide what a run does. Results often lie in other folders of it, and are no
change of the code."""
PATIENCE_S = 30
_ROOT = Path(__file__).resolve().parents[3]


@cache
def code_state() -> dict[str, Any]:
    """Versions of library, Python and packages, and the checkout if there is one, as JSON values.

    `git` is None in an installed package, without git, and where the folder of the package is no checkout of
    its own. Looked up once in a process, as modules are.
    """
    return {
        "library_version": __version__,
        "python": platform.python_version(),
        "packages": {name: _version(name) for name in PACKAGES},
        "git": git_state(_ROOT),
    }


def git_state(root: Path) -> dict[str, Any] | None:
    """Commit, branch, and what differs from the commit in the folders `DECIDING`, untracked files included.

    `changes_sha256` is a hash of the names and contents of the files that differ, None if none does. (A hash
    of git's own diff would depend on everybody's git settings.) None if `root` is not the top of a checkout.
    """
    top = _git(root, "rev-parse", "--show-toplevel")
    if top is None or Path(top.strip()).resolve() != root.resolve():
        return None
    commit, branch = _git(root, "rev-parse", "HEAD"), _git(root, "symbolic-ref", "--short", "-q", "HEAD")
    if commit is None:
        return None
    changed = _names(_git(root, "diff", "--name-only", "--no-renames", "-z", "HEAD", "--", *DECIDING))
    fresh = _names(_git(root, "ls-files", "--others", "--exclude-standard", "-z", "--", *DECIDING))
    names = sorted({*changed, *fresh})
    return {
        "commit": commit.strip(),
        "branch": None if branch is None else branch.strip(),
        "dirty": bool(names),
        "changes_sha256": _hash_of(root, names) if names else None,
    }


def torch_version() -> str | None:
    """The version of torch, if this process uses it."""
    return _version("torch") if "torch" in sys.modules else None


def _hash_of(root: Path, names: list[str]) -> str:
    digest = hashlib.sha256()
    for name in names:
        path = root / name
        content = path.read_bytes() if path.is_file() else b""
        state = b"file" if path.is_file() else b"gone"
        digest.update(b"\0".join([name.encode(), state, hashlib.sha256(content).digest()]))
    return digest.hexdigest()


def _names(listed: str | None) -> list[str]:
    return [] if listed is None else [name for name in listed.split("\0") if name]


def _git(root: Path, *arguments: str) -> str | None:
    """What git says; None if there is no git, or it does not know."""
    command = ["git", "--no-optional-locks", "-C", str(root), *arguments]
    try:
        done = subprocess.run(command, capture_output=True, timeout=PATIENCE_S, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout.decode("utf-8", "replace") if done.returncode == 0 else None


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None
