"""`adhoc dataset ceilings`: what an oracle that knows everything can do in the tasks of a dataset."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from adhoc.cli.dataset import PLAIN_WIDTH, whole_number
from adhoc.cli.house_progress import HouseProgress
from adhoc.core.errors import ConfigurationError
from adhoc.dataset.files.ceiling_file import read_ceilings
from adhoc.dataset.files.dataset_folder import DatasetSplit, found_folder, splits_of
from adhoc.dataset.floors import floors, floors_markdown
from adhoc.dataset.making.ceiling_making import make_ceilings
from adhoc.dataset.oracle.summary import summarise, to_markdown, to_table
from adhoc.reporting.folders import read_folders

EPILOG = """\
With --make the oracle tries every task, in the simulated world, first with the team alone and then with the
newcomer, and its verdicts are written beside the tasks; without, the verdicts that are there are summed up.

  adhoc dataset ceilings
  adhoc dataset ceilings mine --make --workers 4
  adhoc run -m policy=none,random benchmark=paper out=floor; adhoc dataset ceilings --split test --floor floor
"""


def main(arguments: Sequence[str]) -> int:
    """Make the verdicts if asked, and sum them up. Raises DatasetError for unreadable files."""
    parser = argparse.ArgumentParser(
        prog="adhoc dataset ceilings",
        description="Which tasks can be done: by the team alone, only with the newcomer, or not at all.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "dataset", nargs="?", default="paper", help="a folder, or the name of a shipped dataset (paper)"
    )
    parser.add_argument("--split", action="append", help="only this split; may be repeated")
    parser.add_argument("--make", action="store_true", help="let the oracle try every task (minutes)")
    parser.add_argument("--workers", type=whole_number, default=2, metavar="N", help="processes (2)")
    parser.add_argument(
        "--floor",
        action="append",
        type=Path,
        metavar="DIR",
        help="a run folder to set beside; may be repeated",
    )
    parser.add_argument("--markdown", metavar="FILE", type=Path, help="write the tables as Markdown, too")
    options = parser.parse_args(list(arguments))
    folder = found_folder(options.dataset)
    runs = read_folders(options.floor) if options.floor else []
    if options.markdown is not None and not options.markdown.parent.is_dir():
        raise ConfigurationError(f"--markdown {options.markdown}: there is no such folder")
    console = Console()
    if not console.is_terminal:
        console.width = PLAIN_WIDTH
    pages = []
    for split in options.split or splits_of(folder):
        data = DatasetSplit(folder, split)
        if options.make:
            with HouseProgress(f"oracle, {split}", console) as progress:
                make_ceilings(folder, split, options.workers, progress)
        rows = summarise(read_ceilings(data.files).values(), map(data.task, data.ids))
        console.print(to_table(rows))
        pages.append(f"{folder.name}, {split}:\n\n{to_markdown(rows)}")
    if runs:
        page = floors_markdown(floors(runs))
        console.print(page, markup=False, highlight=False, soft_wrap=True)
        pages.append(page)
    if options.markdown is not None:
        options.markdown.write_text("\n".join(pages), encoding="utf-8")
    return 0
