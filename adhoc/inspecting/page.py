"""One HTML file that shows episodes: no server, no network, nothing beside it."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
import zlib
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

from adhoc import __version__
from adhoc.core.errors import ConfigurationError
from adhoc.core.whole_file import write_whole
from adhoc.evaluation import palette
from adhoc.evaluation.records import writing
from adhoc.inspecting.episode_data import episode_data
from adhoc.inspecting.house_data import house_data, target_data
from adhoc.inspecting.texts import TextStore
from adhoc.inspecting.titles import titles
from adhoc.inspecting.watching import Watched

FORMAT = 1
SCRIPTS = (
    "errors",
    "elements",
    "model",
    "ground",
    "marks",
    "map",
    "timeline",
    "messages",
    "decision",
    "robots",
    "frame",
    "main",
    "selftest",
)
"""The page's scripts, in order, in the folder `page` beside this file."""
LEVEL = 6
"""Of compression: the next ones take twice the time for two hundredths of the size."""


def write_page(episodes: Sequence[Watched], path: Path) -> int:
    """Write episodes of one task into one HTML file; returns its size in bytes.

    The page shows two of them side by side, at first the first and the last. All that robots and models
    said is compressed and in base64, so that no text of theirs is ever a part of the file's markup; the page
    shows it as text nodes only, and its content security policy lets it run no script but its own and load
    nothing.

    Creates the folder and overwrites the file. Raises ConfigurationError if there are no episodes or they are
    not of one task, RecordError if the file cannot be written.
    """
    text = page_text(page_data(episodes), str(episodes[0].record["episode_id"]))
    content = text.encode()
    with writing(path):
        write_whole(path, content)
    return len(content)


def page_data(episodes: Sequence[Watched]) -> dict[str, Any]:
    """What a page shows, as JSON values."""
    if not episodes:
        raise ConfigurationError("a page needs an episode")
    scenario, texts = episodes[0].result.scenario, TextStore()
    for other in episodes[1:]:
        if other.result.scenario.content_hash() != scenario.content_hash():
            raise ConfigurationError(
                f"{other.record['episode_id']}: is of task {other.record['task_id']}, and "
                f"{episodes[0].record['episode_id']} of {episodes[0].record['task_id']}: only episodes of "
                "one task can be shown side by side"
            )
    shown = [episode_data(watched, texts) for watched in episodes]
    return {
        "format": FORMAT,
        "colours": {
            "robots": palette.ROBOTS,
            "newcomer": palette.NEWCOMER,
            "ink": palette.OUTLINE,
            "misplaced": palette.MISPLACED,
            "placed": palette.REPLACED,
        },
        "version": __version__,
        "house": house_data(scenario.house),
        "targets": target_data(scenario),
        "episodes": shown,
        "titles": [it[:1].upper() + it[1:] for it in titles([it.record for it in episodes])],
        "commonPast": [[_common_past(one, other) for other in episodes] for one in episodes],
        "lines": texts.lines,
        "blocks": texts.blocks,
    }


def page_text(data: dict[str, Any], title: str) -> str:
    """The HTML file around the data of a page."""
    script, style = "\n".join(_asset(f"{name}.js") for name in SCRIPTS), _asset("style.css")
    script = f'"use strict";\n(() => {{\n{script}\n}})();\n'
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    parts = {
        "TITLE": html.escape(title),
        "POLICY": "default-src 'none'; img-src data:; style-src 'unsafe-inline'; "
        f"script-src 'sha256-{digest}'",
        "STYLE": style,
        "SCRIPT": script,
        "DATA": packed(data),
    }
    return re.sub("@([A-Z]+)@", lambda mark: parts[mark[1]], _asset("page.html"))


def packed(data: dict[str, Any]) -> str:
    """JSON values as base64 of compressed JSON, which holds no character that means anything in HTML."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return base64.b64encode(zlib.compress(text.encode(), LEVEL)).decode()


def _common_past(one: Watched, other: Watched) -> int:
    """Steps that two episodes share, by the hashes of their histories."""
    pairs = zip(one.result.history, other.result.history)
    shared = next((step for step, (a, b) in enumerate(pairs) if a != b), None)
    return min(one.result.steps, other.result.steps) if shared is None else max(0, shared - 1)


def _asset(name: str) -> str:
    return (files("adhoc.inspecting") / "page" / name).read_text(encoding="utf-8")
