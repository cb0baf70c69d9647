"""A dataset on the disk: one folder, and for each split its houses, its tasks and what is known of them."""

from __future__ import annotations

import hashlib
import os
from collections import OrderedDict
from dataclasses import dataclass
from pathlib import Path

from adhoc.core.errors import DatasetError
from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.files.checked_lines import read_compressed
from adhoc.dataset.files.task_checks import check_task
from adhoc.dataset.files.task_file import HASH_DIGITS, StoredTask, TaskFile, TaskFileHeader
from adhoc.dataset.files.task_scenario import scenario_of
from adhoc.evaluation.scenario import Scenario
from adhoc.houses.house import House, Room
from adhoc.houses.house_files import Document, decode
from adhoc.houses.procthor import parse_house

SHIPPED = Path(__file__).parents[1] / "data"
"""Where the datasets are that come with the library, one folder each."""
SPLITS = ("train", "val", "test")
_KEPT_HOUSES = 4


@dataclass(frozen=True)
class SplitFiles:
    """The names of the files of one split."""

    folder: Path
    split: str

    @property
    def houses(self) -> Path:
        """One ProcTHOR house document a line."""
        return self.folder / f"houses-{self.split}.jsonl.gz"

    @property
    def house_hashes(self) -> Path:
        """The SHA-256 of each line of `houses`, and the house's id."""
        return self.folder / f"houses-{self.split}.sha256"

    @property
    def tasks(self) -> Path:
        """A header, and one task a line."""
        return self.folder / f"tasks-{self.split}.jsonl.gz"

    @property
    def ceilings(self) -> Path:
        """What an oracle can do in each task."""
        return self.folder / f"ceilings-{self.split}.jsonl.gz"

    @property
    def making(self) -> Path:
        """How often something was drawn again while the split was made."""
        return self.folder / f"making-{self.split}.json"


def dataset_folder(dataset: str, folder: str | Path | None = None) -> Path:
    """The folder of a dataset: `folder` if given, else the shipped one of that name.

    Raises DatasetError if there is none.
    """
    if folder is not None:
        path = Path(folder).expanduser()
        if not path.is_dir():
            raise DatasetError(f"{path}: there is no such folder; it should be one of `adhoc dataset make`")
        return path
    path = SHIPPED / dataset
    if not path.is_dir() or Path(dataset).name != dataset:
        known = sorted(it.name for it in SHIPPED.iterdir() if it.is_dir()) if SHIPPED.is_dir() else []
        raise DatasetError(f"no dataset {dataset!r} is shipped; there are: {', '.join(known) or 'none'}")
    return path


def found_folder(dataset: str) -> Path:
    """The folder that a user names: a path, or the name of a shipped dataset.

    Raises DatasetError if there is none.
    """
    path = Path(dataset)
    return path if path.is_dir() else dataset_folder(dataset)


def writable_folder(folder: Path) -> Path:
    """The folder, made if need be, before minutes of work go into what is to be written there.

    Raises DatasetError or OSError if it cannot be made or written to.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if not os.access(folder, os.W_OK | os.X_OK):
        raise DatasetError(f"{folder}: may not be written to; name another folder")
    return folder


def splits_of(folder: Path) -> list[str]:
    """The splits that a dataset has. Raises DatasetError if it has none."""
    there = [split for split in SPLITS if SplitFiles(folder, split).tasks.is_file()]
    if not there:
        raise DatasetError(f"{folder}: there are no task files in this folder")
    return there


class DatasetSplit:
    """One split of a dataset, for reading; tasks and houses are decoded and checked when asked for.

    Args:
        folder: The dataset.
        split: One of `SPLITS`.

    Raises:
        DatasetError: A file is missing, damaged, foreign or of another version.
    """

    def __init__(self, folder: Path, split: str) -> None:
        if split not in SPLITS:
            raise DatasetError(f"no split {split!r}; there are: {', '.join(SPLITS)}")
        self.files = SplitFiles(folder, split)
        self._tasks = TaskFile(self.files.tasks)
        if self.header.split != split:
            raise DatasetError(
                f"{self.files.tasks}, line 1: split is {self.header.split!r}; by the file's "
                f"name it is {split!r}"
            )
        self._houses: HouseFile | None = None

    @property
    def header(self) -> TaskFileHeader:
        """What all tasks have in common."""
        return self._tasks.header

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of all tasks, in order."""
        return self._tasks.ids

    def task(self, task_id: str) -> StoredTask:
        """One task as it is stored; it is checked only as far as that needs no house."""
        return self._tasks.task(task_id)

    def where(self, task_id: str) -> str:
        """File and line of a task."""
        return self._tasks.where(task_id)

    @property
    def house_file(self) -> HouseFile:
        """The houses of the tasks; read when it is first asked for."""
        if self._houses is None:
            header = self.header
            self._houses = HouseFile(
                self.files.folder / header.house_file, header.houses, header.house_sha256
            )
            _load_kernels()
        return self._houses

    def open_houses(self) -> None:
        """Read the file of the houses now, so that the first task takes no longer than the others, and a
        damaged file is told at once. Raises DatasetError as `HouseFile` does."""
        _ = self.house_file

    def scenario(self, task_id: str) -> Scenario:
        """One task, checked against its house, as a scenario.

        Raises DatasetError, naming file, line and field, if the task is impossible there, and HouseError
        if the house is.
        """
        task, where = self.task(task_id), self.where(task_id)
        found = self.house_file.hash(task.house_id)
        if task.house_hash != found:
            raise DatasetError(
                f"{where}: house_hash is {task.house_hash!r}; house {task.house_id!r} of "
                f"{self.house_file.path.name} has {found!r}: the task was made for another house"
            )
        house = self.house_file.house(task.house_id)
        check_task(task, house, self.header.ranges, where)
        return scenario_of(task, house, where)


class HouseFile:
    """Houses by their ids, parsed when asked for; a few are kept.

    Args:
        path: The file.
        ids: Of its lines, in order.
        sha256: Of its uncompressed content; not checked if None.

    Raises:
        DatasetError: The file is missing, damaged, or not the one that `ids` and `sha256` describe.
    """

    def __init__(self, path: Path, ids: tuple[str, ...], sha256: str | None = None) -> None:
        self.path = path
        data = read_compressed(path)
        found = hashlib.sha256(data).hexdigest()
        if sha256 is not None and found != sha256:
            raise DatasetError(
                f"{path}: the SHA-256 of its content is {found[:HASH_DIGITS]}..., the tasks were made for "
                f"{sha256[:HASH_DIGITS]}...: it is damaged or belongs to another dataset"
            )
        lines = data.splitlines()
        if len(lines) != len(ids):
            raise DatasetError(f"{path}: there are {len(lines)} houses; there should be {len(ids)}")
        self._lines = {house_id: (number, line) for number, (house_id, line) in enumerate(zip(ids, lines), 1)}
        self._kept: OrderedDict[str, House] = OrderedDict()

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of all houses, in order."""
        return tuple(self._lines)

    def hash(self, house_id: str) -> str:
        """The first digits of the SHA-256 of a house's line. Raises DatasetError for an unknown house."""
        return house_hash(self.line(house_id))

    def house(self, house_id: str) -> House:
        """One house. Raises HouseError or AssetError if its document is broken."""
        if house_id not in self._kept:
            number, line = self._numbered(house_id)
            source = f"{self.path} line {number}"
            document = Document(house_id, source, line.decode("utf-8", "replace"))
            self._kept[house_id] = parse_house(decode(document), source, house_id)
            while len(self._kept) > _KEPT_HOUSES:
                self._kept.popitem(last=False)
        self._kept.move_to_end(house_id)
        return self._kept[house_id]

    def line(self, house_id: str) -> bytes:
        """The line of a house, without its end. Raises DatasetError for an unknown house."""
        return self._numbered(house_id)[1]

    def _numbered(self, house_id: str) -> tuple[int, bytes]:
        if house_id not in self._lines:
            raise DatasetError(f"{self.path}: there is no house {house_id!r}")
        return self._lines[house_id]


def house_hash(line: bytes) -> str:
    """What task lines say of a house: the first digits of the SHA-256 of its line, without the line's end."""
    return hashlib.sha256(line).hexdigest()[:HASH_DIGITS]


def _load_kernels() -> None:
    """Load the compiled code of the checks, so that the first task takes no longer than the others."""
    square = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    FreeCells([Room("room", "Bedroom", square)], []).fits(0.5, 0.5)
