"""What the commands that train have in common: where to, from which seed, on how many processes."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

from rich.console import Console

from adhoc.cli.dataset import whole_number
from adhoc.cli.stages import Stages
from adhoc.training.judges_training import Begin
from adhoc.training.model_card import CARD_FILE


def training_parser(name: str, description: str, out: str, seed: int, epilog: str) -> argparse.ArgumentParser:
    """The arguments of `adhoc train NAME`: --out, --seed and --workers. Ask for the rest."""
    parser = argparse.ArgumentParser(
        prog=f"adhoc train {name}",
        description=description,
        epilog=epilog,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--out", type=Path, default=Path(out), metavar="DIR", help=f"({out})")
    parser.add_argument("--seed", type=int, default=seed, metavar="N", help="(%(default)s)")
    parser.add_argument("--workers", type=whole_number, default=2, metavar="N", help="processes (2)")
    return parser


def add_count(parser: argparse.ArgumentParser, option: str, default: int, meaning: str) -> None:
    """Ask for a number of things, at least 1."""
    parser.add_argument(
        option, type=whole_number, default=default, metavar="N", help=f"{meaning} (%(default)s)"
    )


def train_and_tell(train: Callable[[Begin], str], out: Path) -> None:
    """Train with the stages shown; then tell what `train` returns, where the model card is, and the time."""
    console = Console()
    started = time.monotonic()
    with Stages(console) as stages:
        found = train(stages.begin)
    minutes = (time.monotonic() - started) / 60
    console.print(
        f"{found}\n{out / CARD_FILE}: the model card; {minutes:.1f} minutes", soft_wrap=True, highlight=False
    )
