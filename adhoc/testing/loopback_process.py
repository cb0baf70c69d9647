"""The command line of the loopback provider, so that it can outlive the processes that ask it."""

from __future__ import annotations

import argparse
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from adhoc.testing.loopback_provider import LoopbackProvider


def main(argv: Sequence[str] | None = None) -> None:
    """Serve until interrupted or killed; the first line of output is the URL."""
    parser = argparse.ArgumentParser(prog="python -m adhoc.testing.loopback_provider", description=__doc__)
    parser.add_argument("--port", type=int, default=0, help="0 takes a free one")
    parser.add_argument("--count-file", type=Path, help="gets a line of JSON for every request")
    parser.add_argument("--text", help="answer with this text instead of the offline reasoner's")
    parser.add_argument("--faults", default="", help="how to fail, call by call: 429:2,ok,500*3,silence:30")
    parser.add_argument("--delay", type=float, default=0.0, help="seconds before every reply")
    parser.add_argument("--capacity", type=int, help="more calls at once are refused with 429")
    given = parser.parse_args(argv)
    provider = LoopbackProvider(
        given.text, given.faults, given.delay, given.count_file, given.port, capacity=given.capacity
    )
    with provider:
        sys.stdout.write(provider.url + "\n")
        sys.stdout.flush()
        threading.Event().wait()
