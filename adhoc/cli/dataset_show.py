"""`adhoc dataset show ID`: one task in words and as a picture."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from adhoc.cli.dataset import PLAIN_WIDTH
from adhoc.core.errors import ConfigurationError, DatasetError
from adhoc.dataset.drawing.task_drawing import draw_task
from adhoc.dataset.files.ceiling_file import read_ceilings
from adhoc.dataset.files.dataset_folder import SPLITS, DatasetSplit, SplitFiles, found_folder
from adhoc.evaluation.scenario import Member, Scenario
from adhoc.houses.house import FLOOR, House


def main(arguments: Sequence[str]) -> int:
    """Describe and draw one task. Raises DatasetError for an unknown task."""
    parser = argparse.ArgumentParser(
        prog="adhoc dataset show", description="Describe one task of a dataset, and draw it from above."
    )
    parser.add_argument("id", help="the task, e.g. test-04-07-k3-t5: four rooms, house 7, k=3, 5 teammates")
    parser.add_argument("--dataset", default="paper", help="a folder, or the name of a shipped one (paper)")
    parser.add_argument("--picture", type=Path, metavar="FILE", help="the PNG file to draw (ID.png)")
    options = parser.parse_args(list(arguments))
    picture: Path = options.picture or Path(f"{options.id}.png")
    if picture.suffix.lower() != ".png" or picture.is_dir():
        raise ConfigurationError(f"--picture {picture}: must be a file that ends with .png")
    folder = found_folder(options.dataset)
    data = _split_of(options.id, folder)
    scenario, verdict = data.scenario(options.id), _verdict(data, options.id)
    console = Console()
    if not console.is_terminal:
        console.width = PLAIN_WIDTH
    _describe(scenario, console)
    console.print(verdict, markup=False, highlight=False, soft_wrap=True)
    draw_task(scenario, picture, [verdict])
    console.print(f"drawn: {picture}", markup=False, highlight=False, soft_wrap=True)
    return 0


def _split_of(task_id: str, folder: Path) -> DatasetSplit:
    split = next((name for name in SPLITS if task_id.startswith(f"{name}-")), None)
    if split is None:
        raise DatasetError(f"no task {task_id!r}: ids begin with {', '.join(SPLITS)}, e.g. test-04-07-k3-t5")
    if not SplitFiles(folder, split).tasks.is_file():
        raise DatasetError(f"{folder}: there is no split {split!r} in this dataset")
    return DatasetSplit(folder, split)


def _verdict(data: DatasetSplit, task_id: str) -> str:
    """What the oracle made of the task."""
    if not data.files.ceilings.exists():
        return "oracle: not asked (adhoc dataset ceilings --make)"
    found = read_ceilings(data.files).get(task_id)
    if found is None:
        return "oracle: not asked for this task"
    together = f"{found.joint_steps} steps with the newcomer"
    if found.kind == "team":
        return f"oracle: the team alone takes {found.team_steps} steps, {together}"
    if found.kind == "newcomer":
        return f"oracle: only with the newcomer, {together}; the team alone: {found.team_reason}"
    return f"oracle: {found.reason}" + (" (proven)" if found.proven else " (not proven)")


def _describe(scenario: Scenario, console: Console) -> None:
    house = scenario.house
    rooms = ", ".join(f"{room.room_type} ({room.id})" for room in house.rooms)
    console.print(f"{scenario.id}: {scenario.difficulty.value}", style="bold", highlight=False)
    console.print(f"{len(house.rooms)} rooms: {rooms}", markup=False, highlight=False)
    moved = Table("misplaced", "belongs", "lies", "at", title="misplaced objects", title_justify="left")
    for displacement in scenario.misplaced:
        thing = house.object(displacement.object_id)
        at = (
            "" if displacement.position is None else "({:.2f}, {:.2f}, {:.2f})".format(*displacement.position)
        )
        moved.add_row(thing.id, _place(thing.parent, house), _place(displacement.receptacle_id, house), at)
    console.print(moved)
    robots = Table(
        "robot", "manipulates", "camera", "payload", "battery", "at", title="robots", title_justify="left"
    )
    for member in (*scenario.team, scenario.newcomer):
        robots.add_row(*_row(member))
    console.print(robots)


def _row(member: Member) -> tuple[str, ...]:
    capability, pose = member.capability, member.pose
    return (
        member.name,
        "yes" if capability.can_manipulate else "no",
        f"{capability.camera_height:g} m",
        f"{capability.payload:g} kg",
        f"{capability.max_steps} steps",
        f"({pose.x:g}, {pose.y:g})",
    )


def _place(receptacle: str | None, house: House) -> str:
    if receptacle is None or receptacle == FLOOR:
        return FLOOR
    thing = house.object(receptacle)
    return f"{thing.id} in the {house.room(thing.room).room_type}"
