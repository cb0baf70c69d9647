"""A headless Chromium, for tests that look at pages as a person would."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

PATIENCE_S = 120
NAMES = ("chromium", "chromium-browser", "google-chrome")


def find_browser() -> str:
    """Skips the test where there is none."""
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip("no Chromium on this machine (Debian: apt-get install chromium)")
    return found


def self_test(page: Path, profile: Path) -> dict[str, Any]:
    """What the page found when it played itself."""
    shown = dom_of(page, profile)
    found = re.search(r'data-selftest="([^"]*)"', shown)
    assert found, f"the page did not finish: {shown[:400]}"
    told: dict[str, Any] = json.loads(html.unescape(found[1]))
    told["title"] = html.unescape(re.findall("<title>(.*?)</title>", shown, re.DOTALL)[0])
    return told


def dom_of(page: Path, profile: Path) -> str:
    """The document of a page in its self-test, when it has come to rest."""
    done = subprocess.run(
        [
            find_browser(),
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-background-networking",
            "--no-first-run",
            f"--user-data-dir={profile}",
            "--window-size=1280,800",
            "--virtual-time-budget=60000",
            "--dump-dom",
            f"{page.resolve().as_uri()}#selftest",
        ],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert done.stdout, f"Chromium died: {done.stderr[-600:]}"
    return done.stdout
