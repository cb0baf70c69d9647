"""`adhoc dataset check`: whether a dataset, or a file of houses, keeps its promises."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from adhoc.cli.dataset import whole_number
from adhoc.cli.house_progress import HouseProgress
from adhoc.dataset.checking import check_split
from adhoc.dataset.checks.gravity import check_gravity
from adhoc.dataset.checks.house_checks import CHECKS, Violation, check_house
from adhoc.dataset.files.dataset_folder import SPLITS, found_folder, splits_of
from adhoc.houses.procthor import read_houses

FOUND = 1
"""The exit code where something is wrong."""
MOST_LISTED = 50

EPILOG = """\
Checked are the files and their hashes, each house (format, placement, support, penetration, rooms that can be
reached, sight, gravity), and each task by setting it up in the world. The exit code is 1 if anything is
wrong.

  adhoc dataset check
  adhoc dataset check mine --split test --houses 9 --tasks 1
  adhoc dataset check --house procthor-10k-test.jsonl.gz
"""


def main(arguments: Sequence[str]) -> int:
    """Check, list what is wrong, and sum up. Raises DatasetError or HouseError for unreadable files."""
    parser = argparse.ArgumentParser(
        prog="adhoc dataset check",
        description="Check a dataset, or the houses of any ProcTHOR file.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "dataset", nargs="?", default="paper", help="a folder, or the name of a shipped dataset (paper)"
    )
    parser.add_argument("--split", action="append", choices=SPLITS, help="only this split; may be repeated")
    parser.add_argument(
        "--houses", type=whole_number, metavar="N", help="only N houses of each split, spread over it"
    )
    parser.add_argument(
        "--tasks", type=whole_number, metavar="N", help="only the first N tasks of each house"
    )
    parser.add_argument("--workers", type=whole_number, default=2, metavar="N", help="processes (2)")
    parser.add_argument("--house", type=Path, metavar="FILE", help="check the houses of this file instead")
    options = parser.parse_args(list(arguments))
    console = Console()
    if options.house is not None:
        return _check_file(options.house, console)
    folder = found_folder(options.dataset)
    splits = options.split or splits_of(folder)
    violations: list[Violation] = []
    for split in splits:
        with HouseProgress(f"checking {split}", console) as progress:
            report = check_split(folder, split, options.houses, options.tasks, options.workers, progress)
        violations += report.violations
        if report.making:
            console.print(_drawn_table(split, report.making))
        console.print(
            f"{split}: {report.houses} houses and {report.tasks} tasks checked, "
            f"{len(report.violations)} violations",
            highlight=False,
        )
    return _conclude(violations, console)


def _check_file(path: Path, console: Console) -> int:
    violations = []
    for house in read_houses(path):
        found = [*check_house(house), *check_gravity(house)]
        violations += [Violation(it.check, f"{house.id} {it.subject}", it.detail) for it in found]
        console.print(
            f"{house.id}: {len(house.rooms)} rooms, {len(found)} violations", markup=False, highlight=False
        )
    return _conclude(violations, console)


def _conclude(violations: Sequence[Violation], console: Console) -> int:
    for violation in violations[:MOST_LISTED]:
        console.print(str(violation), style="yellow", markup=False, highlight=False, soft_wrap=True)
    if len(violations) > MOST_LISTED:
        console.print(f"... and {len(violations) - MOST_LISTED} more", style="yellow")
    counts = Counter(violation.check for violation in violations)
    table = Table("check", "violations")
    for name in dict.fromkeys((*CHECKS, "gravity", "hashes", "task file", "set-up", "misplaced", *counts)):
        table.add_row(name, str(counts[name]), style="yellow" if counts[name] else None)
    console.print(table)
    return FOUND if violations else 0


def _drawn_table(split: str, making: Mapping[str, Any]) -> Table:
    """How many houses had to be drawn for those that are there."""
    table = Table("rooms", "houses", "drawn", "rejected", "why", title=f"{split}: how houses were drawn")
    for rooms, counts in making.items():
        houses, drawn = counts["houses"], counts["drawn"]
        why = ", ".join(f"{reason} {count}" for reason, count in counts["rejected"].items())
        table.add_row(rooms, str(houses), str(drawn), f"{1 - houses / drawn:.0%}", why)
    return table
