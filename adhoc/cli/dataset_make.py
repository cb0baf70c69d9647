"""`adhoc dataset make`: the houses and tasks of a dataset from a seed."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from adhoc.cli.dataset import whole_number
from adhoc.cli.house_progress import HouseProgress
from adhoc.core.errors import ConfigurationError
from adhoc.dataset.files.dataset_folder import SPLITS, SplitFiles
from adhoc.dataset.generator import ROOM_COUNTS
from adhoc.dataset.making.split_making import make_split

EPILOG = """\
The same arguments give the same bytes, on every machine and with any number of workers; without any, the
bytes of the dataset `paper` that comes with the library.

  adhoc dataset make --out paper
  adhoc dataset make --split test --houses-per-count 2 --rooms 1,10 --seed 7 --name mine --out mine
"""


def main(arguments: Sequence[str]) -> int:
    """Make the splits that were asked for. Raises ConfigurationError for impossible arguments."""
    parser = argparse.ArgumentParser(
        prog="adhoc dataset make",
        description="Make houses and tasks: in each house one to five misplaced objects, with three, four "
        "and five teammates each: 1350 tasks a split.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--name", default="paper", help="the name that the files carry (paper)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="the folder to write to (that name)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="another seed, another dataset (0)")
    parser.add_argument("--split", action="append", choices=SPLITS, help="only this split; may be repeated")
    parser.add_argument(
        "--houses-per-count", type=whole_number, default=10, metavar="N", help="of each number of rooms (10)"
    )
    parser.add_argument("--rooms", metavar="N,N", help="the numbers of rooms (1,2,3,4,5,6,7,8,10)")
    parser.add_argument("--workers", type=whole_number, default=2, metavar="N", help="processes (2)")
    options = parser.parse_args(list(arguments))
    counts = ROOM_COUNTS if options.rooms is None else _counts(options.rooms)
    if Path(options.name).name != options.name or not options.name.strip():
        raise ConfigurationError(f"--name {options.name!r}: must be a name, without slashes")
    folder: Path = options.out or Path(options.name)
    console = Console()
    for split in options.split or SPLITS:
        with HouseProgress(f"making {split}", console) as progress:
            make_split(
                split,
                folder,
                options.seed,
                options.houses_per_count,
                counts,
                options.workers,
                progress,
                options.name,
            )
        tasks = SplitFiles(folder, split).tasks
        houses = options.houses_per_count * len(set(counts))
        console.print(f"{tasks}: {houses} houses, {15 * houses} tasks", soft_wrap=True, highlight=False)
    return 0


def _counts(text: str) -> tuple[int, ...]:
    try:
        return tuple(int(part) for part in text.split(","))
    except ValueError:
        raise ConfigurationError(
            f"--rooms {text}: must be numbers of rooms with commas, e.g. 1,2,10"
        ) from None
