"""What a configuration takes from outside the library: files and folders that it names, and foreign code."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from adhoc.core.errors import RecordError
from adhoc.experiments.provenance.private import at_home, publishable_text

PATH_NAMES = ("path", "folder", "file", "checkpoints", "team_checkpoints", "script", "prompts")
"""Keys whose values are paths also where they have no separator in them."""
NOT_READ = ("out", "ledger", "hydra")
"""Groups whose paths are where things go, or come along with the run folder."""
TARGET = "_target_"
_CHUNK = 2**20
_LIBRARY = "adhoc"
_MOST_FILES = 10_000


def outside_files(config: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The files and folders that exist and that `config` names, by their keys in it, as `benchmark.path`: for
    each the path as it was given, SHA-256 and size in bytes. Raises RecordError for one that is there and
    cannot be read."""
    found = {}
    for key, value in _texts(config):
        if key.split(".")[0] in NOT_READ or not _may_be_path(key, value):
            continue
        path = Path(at_home(value))
        if _exists(path):
            digest, size = file_hash(path)
            found[key] = {"path": publishable_text(value), "sha256": digest, "bytes": size}
    return dict(sorted(found.items()))


def outside_code(config: Mapping[str, Any]) -> dict[str, str | None]:
    """The SHA-256 of the modules outside the library that `config` takes components from; None for one that
    is no file."""
    names = {value.rpartition(".")[0] for key, value in _texts(config) if key.rpartition(".")[2] == TARGET}
    modules = sorted(name for name in names if name and name.partition(".")[0] != _LIBRARY)
    return {name: _module_hash(name) for name in modules}


def file_hash(path: Path) -> tuple[str, int]:
    """SHA-256 and size of a file, or of all files of a folder with their names. Raises RecordError if one
    cannot be read."""
    try:
        if path.is_file():
            return _hash(path)
        digest, size = hashlib.sha256(), 0
        for file in sorted(_files_of(path)):
            inner, bytes_ = _hash(file)
            digest.update(f"{file.relative_to(path).as_posix()}\0{inner}\0".encode())
            size += bytes_
        return digest.hexdigest(), size
    except OSError as error:
        raise RecordError(f"{error.filename or path}: cannot be read: {error.strerror or error}") from error


def _files_of(folder: Path) -> Iterator[Path]:
    files = (path for path in folder.rglob("*") if path.is_file())
    for number, path in enumerate(files):
        if number == _MOST_FILES:
            raise RecordError(
                f"{folder}: has more than {_MOST_FILES} files; name the folder of the data alone"
            )
        yield path


def _hash(path: Path) -> tuple[str, int]:
    facts = path.stat()
    return _hash_once(str(path.resolve()), facts.st_size, facts.st_mtime_ns)


@lru_cache(maxsize=1024)
def _hash_once(path: str, size: int, modified: int) -> tuple[str, int]:
    """A large file that several configurations name is read once, unless it has changed."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
        return digest.hexdigest(), file.tell()


def _module_hash(name: str) -> str | None:
    try:
        spec = find_spec(name)
    except (ImportError, ValueError, AttributeError):
        return None
    if spec is None or spec.origin is None or not Path(spec.origin).is_file():
        return None
    return file_hash(Path(spec.origin))[0]


def _may_be_path(key: str, value: str) -> bool:
    return key.rpartition(".")[2] in PATH_NAMES or os.sep in value


def _exists(path: Path) -> bool:
    """Files and folders; pipes and devices are not read, and what the system takes for no path is none."""
    try:
        return path.is_file() or path.is_dir()
    except (OSError, ValueError):
        return False


def _texts(value: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """All texts of a configuration with their keys."""
    if isinstance(value, str):
        yield key, value
    elif isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _texts(inner, f"{key}.{name}" if key else str(name))
    elif isinstance(value, (list, tuple)):
        for number, inner in enumerate(value):
            yield from _texts(inner, f"{key}.{number}")
