"""Making one house of a split with all its tasks, and counting what was drawn in vain."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from adhoc.core.errors import ConfigurationError, DatasetError, WorldError
from adhoc.core.line_checksum import canonical
from adhoc.core.streams import derive_seed
from adhoc.dataset.checks.gravity import check_gravity
from adhoc.dataset.checks.house_checks import Violation
from adhoc.dataset.files.dataset_folder import house_hash
from adhoc.dataset.files.task_file import StoredTask
from adhoc.dataset.files.task_scenario import task_of
from adhoc.dataset.generator import Generated, generate_house
from adhoc.dataset.making.house_tasks import PAPER_GRID, TaskGrid, draw_tasks
from adhoc.houses.house import House
from adhoc.houses.house_files import Document, decode
from adhoc.houses.procthor import parse_house
from adhoc.houses.procthor_writing import house_document
from adhoc.worlds.pybullet_world import PyBulletWorld

HOUSE_ATTEMPTS = 20
"""How many generated houses are tried for one place of a split."""

Generate = Callable[[int, int, str], Generated]
"""Makes a house of so many rooms from a seed, with an id."""
Fall = Callable[[House], Sequence[Violation]]
"""What moves in a house under gravity."""


@dataclass(frozen=True)
class HousePlan:
    """Which house is to be made. Everything is plain, so that it can be sent to another process."""

    split: str
    rooms: int
    index: int
    seed: int
    """The dataset seed."""
    grid: TaskGrid = PAPER_GRID
    generate: Generate = generate_house
    fall: Fall = check_gravity

    @property
    def house_id(self) -> str:
        """E.g. `test-04-07`."""
        return f"{self.split}-{self.rooms:02d}-{self.index:02d}"

    def house_seed(self, attempt: int) -> int:
        """The seed of the house; the attempts after the first have a seed of their own."""
        names = ("house", self.split, self.rooms, self.index)
        return derive_seed(self.seed, *names, *([attempt] if attempt else []))


@dataclass(frozen=True)
class MadeHouse:
    """A house's line, its tasks, and how often something was drawn in vain, by reason."""

    house_id: str
    line: bytes
    tasks: tuple[StoredTask, ...]
    rejected: Counter[str] = field(default_factory=Counter)

    @property
    def sha256(self) -> str:
        """Of the line, without the line's end."""
        return hashlib.sha256(self.line).hexdigest()


def make_house(plan: HousePlan) -> MadeHouse:
    """Make one house and its tasks; equal plans give equal results, in any process.

    A generated house in which something moves under gravity, or in which a task cannot be drawn, is
    replaced by that of the plan's next seed. Raises DatasetError if `HOUSE_ATTEMPTS` are in vain.
    """
    rejected: Counter[str] = Counter()
    for attempt in range(HOUSE_ATTEMPTS):
        generated = plan.generate(plan.rooms, plan.house_seed(attempt), plan.house_id)
        rejected.update(_kind(reason) for reason in generated.rejected)
        line = canonical(house_document(generated.house))
        house = read_line(line, plan.house_id)
        if plan.fall(house):
            rejected["gravity"] += 1
            continue
        try:
            tasks = _draw_tasks(plan, house, house_hash(line))
        except ConfigurationError:
            rejected["too few objects to misplace"] += 1
            continue
        except WorldError:
            rejected["no room for the robots"] += 1
            continue
        return MadeHouse(plan.house_id, line, tasks, rejected)
    raise DatasetError(
        f"house {plan.house_id!r}: none of {HOUSE_ATTEMPTS} generated houses can be used: "
        + ", ".join(f"{reason} {count}" for reason, count in sorted(rejected.items()))
    )


def read_line(line: bytes, house_id: str) -> House:
    """The house of a line, exactly as a reader of the file gets it."""
    return parse_house(decode(Document(house_id, house_id, line.decode())), house_id, house_id)


def _draw_tasks(plan: HousePlan, house: House, digits: str) -> tuple[StoredTask, ...]:
    world = PyBulletWorld(image_size=2)
    try:
        drawn = draw_tasks(world, house, plan.seed, plan.grid)
    finally:
        world.close()
    return tuple(task_of(scenario, house, digits) for scenario in drawn)


def _kind(reason: str) -> str:
    """A reason without its particulars."""
    return reason.partition(":")[0].strip()
