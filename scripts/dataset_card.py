"""Print the tables of docs/dataset.md from the files of a dataset, and draw its floor plans.

    python scripts/dataset_card.py [paper] [--picture docs/images/dataset-houses.png] [--index 3]

The picture shows the test house of that index of each number of rooms. Likeness and ceilings have commands of
their own
(`scripts/likeness.py`, `adhoc dataset ceilings`).
"""

from __future__ import annotations

import argparse
import json
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import mean

from adhoc.dataset.drawing.gallery import draw_gallery
from adhoc.dataset.files.dataset_folder import DatasetSplit, SplitFiles, found_folder, splits_of
from adhoc.dataset.files.task_file import StoredTask
from adhoc.dataset.likeness.likeness_statistics import is_furniture, is_item
from adhoc.houses.floor_plan import area
from adhoc.houses.house import FLOOR, House


def main() -> None:
    """Print and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dataset", nargs="?", default="paper", help="a folder, or a shipped dataset (paper)")
    parser.add_argument("--picture", type=Path, metavar="PNG")
    parser.add_argument("--index", type=int, default=3)
    options = parser.parse_args()
    folder = found_folder(options.dataset)
    data = DatasetSplit(folder, "test")
    by_rooms: dict[int, list[House]] = defaultdict(list)
    for house_id in data.header.houses:
        house = data.house_file.house(house_id)
        by_rooms[len(house.rooms)].append(house)
    print(making_table(folder))
    print(content_table(by_rooms))
    print(task_sentence([data.task(task_id) for task_id in data.ids]))
    if options.picture is not None:
        draw_gallery([houses[options.index] for houses in by_rooms.values()], options.picture)


def making_table(folder: Path) -> str:
    """How many houses were drawn for those of all splits, and why some were rejected."""
    houses: Counter[int] = Counter()
    drawn: Counter[int] = Counter()
    why: dict[int, Counter[str]] = defaultdict(Counter)
    for split in splits_of(folder):
        rooms = json.loads(SplitFiles(folder, split).making.read_bytes())["rooms"]
        for name, counts in rooms.items():
            houses[int(name)] += counts["houses"]
            drawn[int(name)] += counts["drawn"]
            why[int(name)].update(counts["rejected"])
    rows = [
        (count, houses[count], drawn[count], f"{1 - houses[count] / drawn[count]:.0%}", reasons(why[count]))
        for count in sorted(houses)
    ]
    return markdown(("rooms", "houses", "drawn", "rejected", "why"), rows)


def reasons(counts: Counter[str]) -> str:
    """E.g. `sight 3, rooms 1`."""
    return ", ".join(f"{reason} {count}" for reason, count in sorted(counts.items()))


def content_table(by_rooms: dict[int, list[House]]) -> str:
    """Floor area with its range, furniture and items of the houses of each number of rooms."""
    rows = []
    for rooms, houses in sorted(by_rooms.items()):
        areas = [sum(area(room.polygon) for room in house.rooms) for house in houses]
        furniture = mean(sum(map(is_furniture, house.objects)) for house in houses)
        items = mean(sum(map(is_item, house.objects)) for house in houses)
        size = f"{mean(areas):.0f} ({min(areas):.0f}-{max(areas):.0f})"
        rows.append((rooms, size, f"{furniture:.0f}", f"{items:.0f}"))
    return markdown(("rooms", "floor area (m²)", "furniture", "items"), rows)


def task_sentence(tasks: Sequence[StoredTask]) -> str:
    """What is misplaced, and who manipulates."""
    misplaced = [it for task in tasks for it in task.misplaced]
    types = {it.object_id.split("|")[0] for it in misplaced}
    floor = mean(it.receptacle_id == FLOOR for it in misplaced)
    teammates = mean(member.capability.can_manipulate for task in tasks for member in task.team)
    newcomers = mean(task.newcomer.capability.can_manipulate for task in tasks)
    return (
        f"Of the {len(misplaced)} misplaced objects, of {len(types)} types, {floor:.0%} lie on the floor; "
        f"{teammates:.0%} of the teammates and {newcomers:.0%} of the newcomers manipulate."
    )


def markdown(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A Markdown table."""
    lines = [head, ["---:" for _ in head], *rows]
    return "".join("| " + " | ".join(map(str, line)) + " |\n" for line in lines)


if __name__ == "__main__":
    main()
