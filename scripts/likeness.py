"""Compare generated with real houses, room type by room type.

    python scripts/likeness.py REAL_FILE... [--per-type 170] [--houses 40] [--rooms 1 10] [--seed 0]
        [--unchecked | --generated FILE...] [--out FOLDER]

Single rooms are generated until there are `--per-type` of every type that the real ones have; for every
larger number of rooms among the real houses, `--houses` houses are generated. Prints a table for each number
of rooms; with `--out`, writes `rooms-NN.md` and `rooms-NN.png` too. In red: distances above the noise floor.
"""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from rich.console import Console

from adhoc.core.streams import derive_seed, stream
from adhoc.dataset.generator import generate_house
from adhoc.dataset.likeness.comparison import compare
from adhoc.dataset.likeness.likeness_figure import draw_likeness
from adhoc.dataset.likeness.likeness_table import likeness_markdown, likeness_table
from adhoc.houses.generation.furnishing import furnish
from adhoc.houses.generation.shell import draw_shell
from adhoc.houses.house import House
from adhoc.houses.procthor import read_houses

MOST_DRAWS = 40
"""Single rooms drawn at most for each that is wanted."""


def main() -> None:
    """Read, generate, compare, print and write."""
    arguments = _arguments()
    console = Console(width=None if Console().is_terminal else 170)
    real = _by_rooms(arguments.real)
    made = _by_rooms(arguments.generated)
    for rooms in arguments.rooms or sorted(real):
        generated = made[rooms] if arguments.generated else _generate(rooms, real[rooms], arguments)
        likeness = compare(real[rooms], generated)
        title = f"Rooms: {rooms}. {len(generated)} generated against {len(real[rooms])} real houses"
        console.print(likeness_table(likeness, title))
        if arguments.out is not None:
            arguments.out.mkdir(parents=True, exist_ok=True)
            stem = arguments.out / f"rooms-{rooms:02}"
            stem.with_suffix(".md").write_text(likeness_markdown(likeness), encoding="utf-8")
            draw_likeness(likeness, stem.with_suffix(".png"))


def _by_rooms(files: Iterable[Path]) -> defaultdict[int, list[House]]:
    found: defaultdict[int, list[House]] = defaultdict(list)
    for file in files:
        for house in read_houses(file):
            found[len(house.rooms)].append(house)
    return found


def _generate(rooms: int, real: Sequence[House], arguments: argparse.Namespace) -> list[House]:
    """Houses of that many rooms; of one room, equally many of every type of the real ones."""
    if rooms > 1:
        return list(_draw(rooms, arguments.houses, arguments.seed, arguments.unchecked))
    wanted = Counter({house.rooms[0].room_type: arguments.per_type for house in real})
    kept = []
    for house in _draw(1, MOST_DRAWS * wanted.total(), arguments.seed, arguments.unchecked):
        room_type = house.rooms[0].room_type
        if wanted[room_type] > 0:
            wanted[room_type] -= 1
            kept.append(house)
        if not wanted.total():
            return kept
    missing = ", ".join(f"{count} {name}" for name, count in wanted.items() if count)
    raise SystemExit(f"too few single rooms of some types were generated; still missing: {missing}")


def _draw(rooms: int, count: int, seed: int, unchecked: bool) -> Iterator[House]:
    for index in range(count):
        house_seed = derive_seed(seed, "likeness", rooms, index)
        yield _unchecked(rooms, house_seed) if unchecked else generate_house(rooms, house_seed).house


def _unchecked(rooms: int, seed: int) -> House:
    """A house as first drawn, sound or not."""
    generator = stream(seed, "unchecked")
    shell = draw_shell(rooms, generator)
    things = furnish(shell, generator)
    return House(f"unchecked-{seed}", shell.rooms, shell.walls, shell.openings, things)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("real", nargs="+", type=Path, help="files of real houses (.json, .jsonl, also .gz)")
    parser.add_argument("--per-type", type=int, default=170, help="single rooms of every room type")
    parser.add_argument("--houses", type=int, default=40, help="houses of every larger number of rooms")
    parser.add_argument("--rooms", type=int, nargs="+", help="only these numbers of rooms")
    parser.add_argument("--seed", type=int, default=0)
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--unchecked", action="store_true", help="keep houses that the checks would reject")
    source.add_argument(
        "--generated", nargs="+", type=Path, default=[], help="house files instead of drawing"
    )
    parser.add_argument("--out", type=Path, help="a folder for tables and figures")
    return parser.parse_args()


if __name__ == "__main__":
    main()
