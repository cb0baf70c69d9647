"""The commands that pages tell people to type, one after the other, on a small scale."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from adhoc.cli.main import main

DOCS = Path(__file__).parents[1] / "docs"
PAGES = ("reproduce", "ablation", "cluster")
SMALL = ("benchmark=sample", "limit=2", "max_steps=60", "pictures=false", "transcript=false")
FEW_ROWS = ("team=heuristic", "policy=none,random,irot")
"""Of an experiment that has more."""
OWN = "experiment=candidates"
"""One that a page shows, and that has few."""
_FILE = re.compile(r"```yaml\n(?=(?:#.*\n)?# (\S+\.yaml)\n)(.*?)```", re.S)
_BLOCK = re.compile(r"```bash\n(.*?)```", re.S)


def commands(page: str) -> list[list[str]]:
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    lines = [
        line for block in _BLOCK.findall(text) for line in block.splitlines() if line.startswith("adhoc ")
    ]
    return [shlex.split(line, comments=True)[1:] for line in lines]


def write_files(page: str) -> None:
    """Those that the page shows with their paths at the top."""
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    for path, content in _FILE.findall(text):
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_text(content, encoding="utf-8")


def small(words: list[str]) -> list[str]:
    if words[0] != "run":
        return words
    kept = [word for word in words if not word.startswith("benchmark=")]
    return [
        *kept,
        *(FEW_ROWS if any(word.startswith("experiment=") and word != OWN for word in words) else ()),
        *SMALL,
    ]


@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_work(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_files(page)
    found = commands(page)
    assert found
    for words in found:
        assert main(small(words)) == 0, shlex.join(words)
