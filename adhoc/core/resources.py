"""Where the folders of data that people edit are: `configs` and `prompts`."""

from __future__ import annotations

import os
from pathlib import Path

from adhoc.core.errors import ConfigurationError, PromptError

_PACKAGE = Path(__file__).resolve().parents[1]
_ERRORS = {"configs": ConfigurationError, "prompts": PromptError}


def data_dir(name: str) -> Path:
    """The folder `configs` or `prompts` that is in force.

    It is the folder that the environment variable `ADHOC_CONFIGS` or `ADHOC_PROMPTS` names; else, in a
    checkout or an editable install, the folder beside the package; else the copy inside the wheel.

    Raises:
        ConfigurationError: no such folder for `configs`, or `name` is neither of the two.
        PromptError: no such folder for `prompts`.
    """
    if name not in _ERRORS:
        raise ConfigurationError(f"data_dir: {name!r} is not one of {sorted(_ERRORS)}")
    variable = f"ADHOC_{name.upper()}"
    override = os.environ.get(variable)
    if override:
        return _existing(Path(override).expanduser(), name, f"environment variable {variable}={override}")
    if (_PACKAGE.parent / "pyproject.toml").is_file():
        return _existing(_PACKAGE.parent / name, name, "the checkout")
    return _existing(_PACKAGE / name, name, "the installed package")


def _existing(folder: Path, name: str, source: str) -> Path:
    if not folder.is_dir():
        raise _ERRORS[name](
            f"{folder}: no folder of {name} there (looked because of {source}); "
            f"install the package again, or set ADHOC_{name.upper()} to a folder of {name}"
        )
    return folder
