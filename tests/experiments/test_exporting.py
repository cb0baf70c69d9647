from __future__ import annotations

import csv
import json
import math
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.cli.main import main
from adhoc.core.errors import MissingDependency, RecordError
from adhoc.evaluation.records import RecordFile
from adhoc.experiments.exporting.columns import Kind, columns_of
from adhoc.experiments.exporting.files import write_csv, write_parquet

BASE = {
    "episode_id": "e",
    "task_id": "t",
    "house_id": "h",
    "rooms": 2,
    "difficulty": "Easy",
    "teammates": 2,
    "misplaced": 2,
    "team": "heuristic",
    "policy": "none",
    "join_step": None,
    "seed": 7852962292909911766,
    "model": None,
    "success": True,
    "replaced": 2,
    "partial_success": 1,
    "temporal_steps": 120,
    "action_steps": 240,
    "reference_temporal_steps": None,
    "efficiency": None,
    "llm": {"calls": 0, "cost_usd": 0.0, "stages": {}},
    "wall_s": 0.125,
    "library_version": "0",
    "config_hash": "abc",
    "joined_at": None,
    "team_label": 'Heuristic, "based"\nteam',
}
JOINED = {
    **BASE,
    "episode_id": "e2",
    "join_step": 5,
    "model": "gpt",
    "success": False,
    "partial_success": 1 / 3,
    "efficiency": 0.1 + 0.2,
    "llm": {"calls": 3, "cost_usd": 1e-7, "stages": {"plan": {"calls": 3}}},
    "joined_at": [1.5, -2.25],
}
READERS = {
    Kind.BOOLEAN: {"true": True, "false": False}.__getitem__,
    Kind.INTEGER: int,
    Kind.NUMBER: float,
    Kind.TEXT: str,
}


def table(*records):
    return columns_of(("runs/a", record) for record in records)


def by_name(columns):
    return {column.name: column for column in columns}


def read_csv(path, columns):
    """What the documentation says of reading it back."""
    with open(path, encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    kinds = {column.name: column.kind for column in columns}
    return {
        name: [None if row[place] == "" else READERS[kinds[name]](row[place]) for row in rows]
        for place, name in enumerate(names)
    }


def test_columns_have_names_with_dots_in_a_stable_order():
    names = [column.name for column in table(BASE, JOINED)]
    assert names[:3] == ["folder", "episode_id", "task_id"]
    assert names[names.index("efficiency") + 1 :] == [
        "llm.calls",
        "llm.cost_usd",
        "llm.stages.plan.calls",
        "wall_s",
        "library_version",
        "config_hash",
        "joined_at.0",
        "joined_at.1",
        "team_label",
    ]
    assert names == [column.name for column in table(JOINED, BASE)]


def test_every_column_has_one_type_also_where_nothing_is_in_it():
    kinds = {name: column.kind for name, column in by_name(table(BASE)).items()}
    assert kinds["success"] is Kind.BOOLEAN
    assert kinds["seed"] is kinds["rooms"] is kinds["join_step"] is Kind.INTEGER
    assert kinds["partial_success"] is kinds["efficiency"] is kinds["llm.cost_usd"] is Kind.NUMBER
    assert kinds["model"] is kinds["joined_at"] is kinds["folder"] is Kind.TEXT
    joined = {name: column.kind for name, column in by_name(table(JOINED)).items()}
    assert {name: joined[name] for name in kinds.keys() & joined.keys()} == {
        name: kind for name, kind in kinds.items() if name in joined
    }


def test_cells_are_those_of_the_records_and_missing_ones_are_empty():
    columns = by_name(table(BASE, JOINED))
    assert columns["llm.stages.plan.calls"].cells == [None, 3]
    assert columns["joined_at.1"].cells == [None, -2.25]
    assert columns["partial_success"].cells == [1.0, 1 / 3]
    assert columns["folder"].cells == ["runs/a", "runs/a"]


def test_several_types_in_a_column_and_numbers_too_large_are_texts():
    odd = by_name(table({**BASE, "x": True}, {**BASE, "x": "a"}, {**BASE, "x": 2}))["x"]
    assert (odd.kind, list(odd.cells)) == (Kind.TEXT, ["true", "a", "2"])
    large = by_name(table({**BASE, "x": 2**63}))["x"]
    assert (large.kind, list(large.cells)) == (Kind.TEXT, [str(2**63)])


def test_csv_comes_back_as_it_was(tmp_path):
    columns = table(BASE, JOINED)
    write_csv(tmp_path / "x.csv", columns)
    back = read_csv(tmp_path / "x.csv", columns)
    assert back == {column.name: list(column.cells) for column in columns}
    assert list(back) == [column.name for column in columns]
    assert [path.name for path in tmp_path.iterdir()] == ["x.csv"]


NAMES = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), min_size=1)
values = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**70), 2**70),
    st.floats(allow_nan=False, allow_infinity=False),
    NAMES,
)


@given(st.lists(st.dictionaries(NAMES, values, max_size=3), min_size=1, max_size=4))
def test_whatever_stands_in_records_comes_back(tmp_path_factory, extras):
    path = tmp_path_factory.getbasetemp() / "any.csv"
    columns = table(*({**BASE, "extra": extra} for extra in extras))
    write_csv(path, columns)
    back = read_csv(path, columns)
    for place, extra in enumerate(extras):
        for name, value in extra.items():
            cell = back[f"extra.{name}"][place]
            if isinstance(cell, str) and not isinstance(value, str):
                cell = json.loads(cell)
            assert cell == value or (isinstance(cell, float) and math.isclose(cell, value))


def test_parquet_without_pyarrow_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(MissingDependency, match=r'pip install "adhoc\[parquet\]"'):
        write_parquet(tmp_path / "x.parquet", table(BASE))
    assert list(tmp_path.iterdir()) == []


def test_parquet_comes_back_as_it_was_with_its_types(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed (adhoc[parquet])")
    columns = table(BASE, JOINED)
    write_parquet(tmp_path / "x.parquet", columns)
    back = parquet.read_table(tmp_path / "x.parquet")
    assert back.column_names == [column.name for column in columns]
    assert back.to_pydict() == {column.name: list(column.cells) for column in columns}
    types = {name: str(back.schema.field(name).type) for name in ("success", "seed", "efficiency", "model")}
    assert types == {"success": "bool", "seed": "int64", "efficiency": "double", "model": "string"}


def test_a_file_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordError, match=r"x\.csv: cannot be written"):
        write_csv(tmp_path / "file" / "x.csv", table(BASE))


class TestCommand:
    def test_folders_are_written_one_behind_the_other(self, tmp_path, monkeypatch, capsys):
        monkeypatch.chdir(tmp_path)
        for folder, record in (("a", BASE), ("b", JOINED)):
            RecordFile(folder).append(record)
        assert main(["export", "a", "b", "--csv", "x.csv"]) == 0
        assert capsys.readouterr().out == "x.csv: 2 rows of 29 columns\n"
        with open("x.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        assert [(row["folder"], row["episode_id"]) for row in rows] == [("a", "e"), ("b", "e2")]

    def test_what_is_missing_is_told(self, tmp_path, monkeypatch, capsys):
        monkeypatch.chdir(tmp_path)
        RecordFile("a").append(BASE)
        assert main(["export", "a"]) == 2
        assert "--csv FILE or --parquet FILE" in capsys.readouterr().err
        assert main(["export", "a", "none", "--csv", "x.csv"]) == 2
        assert "none/episodes.jsonl: no episode records" in capsys.readouterr().err
        assert main(["export", "a", "a", "--csv", "x.csv"]) == 2
        assert "a: episode 'e' is in another folder as well" in capsys.readouterr().err
        assert main(["export", "a", "--csv", "a/episodes.jsonl"]) == 2
        assert "--csv a/episodes.jsonl: a run keeps its .jsonl files" in capsys.readouterr().err
        assert not (tmp_path / "x.csv").exists()
