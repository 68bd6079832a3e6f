"""Data package of a folder, and the units in the metadata of its Parquet files."""

import csv
import json
from dataclasses import fields
from hashlib import sha256
from pathlib import Path

import pandas as pd
import pyarrow.parquet as pq
import pytest

from comparisons.data.columns import column, title
from comparisons.data.file_names import DATA_PACKAGE, TABLES
from comparisons.judging.judge import Judged
from comparisons.judging.summary import COVERAGE
from comparisons.output.errors import COMPARED, agreement, relative_error
from comparisons.output.verdicts import GATE_COLUMNS
from comparisons.pipeline.run import run
from comparisons.quantities import ALL_QUANTITIES, QUANTITIES
from comparisons.runs.data_package import quantities, write_data_package
from comparisons.runs.frames import COLUMNS, CURVE_COLUMNS
from comparisons.runs.record import read_record

GRID = """
[[grid]]
id = "two"
title = "Two cases"
reference = "atlas"
models = ["atlas", "jkr", "bradley"]
quantities = ["pull_off_force", "jump_in_gap"]
n = [2]
k = [0, 0.4]
mu = [1]
"""

#: Type of a column -> what reads its cells.
READERS = {"number": float, "integer": int, "boolean": {"True": True, "False": False}.__getitem__, "string": str}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return run(GRID, folder=tmp_path_factory.mktemp("run") / "out").folder


def package(folder):
    return json.loads((folder / DATA_PACKAGE).read_text(encoding="utf-8"))


def test_every_table_of_a_run_is_in_its_package(folder):
    resources = {one["path"]: one for one in package(folder)["resources"]}
    assert set(resources) == {path.name for path in folder.glob("*.csv")} >= {"results.csv", "kappa.csv"}
    for name, resource in resources.items():
        content = (folder / name).read_bytes()
        assert (resource["bytes"], resource["hash"]) == (len(content), f"sha256:{sha256(content).hexdigest()}")
        assert resource["title"] == title(Path(name).stem)


def test_every_cell_is_of_its_type_and_every_column_is_described(folder):
    for resource in package(folder)["resources"]:
        with (folder / resource["path"]).open(newline="", encoding="utf-8") as file:
            names, *rows = csv.reader(file)
        declared = resource["schema"]["fields"]
        assert [one["name"] for one in declared] == names
        assert all(one["description"] and isinstance(one["unit"], str) for one in declared)
        # The percentages of the paper are texts, which keep its digits.
        texts = [one for one in declared if one["type"] in ("string", "boolean") and one["name"] != "paper_percent"]
        assert [one["name"] for one in texts if one["unit"]] == []
        for row in rows:
            for one, cell in zip(declared, row, strict=True):
                assert cell == "" or READERS[one["type"]](cell) is not None
    types = {one["name"]: one["type"] for one in package(folder)["resources"][0]["schema"]["fields"]}
    assert (types["value"], types["size"], types["reason"]) == ("number", "number", "string")


def test_the_record_has_the_checksum_of_the_package(folder):
    assert DATA_PACKAGE in read_record(folder / "run.json")["files"]


def test_the_units_of_the_quantities_are_those_of_the_registry(folder):
    stated = package(folder)["quantities"]
    assert list(stated) == list(ALL_QUANTITIES)
    assert all(stated[name]["unit"] == quantity.unit for name, quantity in QUANTITIES.items())


@pytest.mark.parametrize("name", ["results", "curves", "kappa", "largest_kappa"])
def test_parquet_has_unit_and_meaning_of_each_column(folder, name):
    schema = pq.read_schema(folder / f"{name}.parquet")
    for field in schema:
        known = column(name, field.name)
        stated = {key.decode(): text.decode() for key, text in field.metadata.items()}
        assert stated["unit"] == known.unit
        assert stated["description"] == known.description
    assert json.loads(schema.metadata[b"quantities"]) == quantities()


def empty(columns):
    return pd.DataFrame({name: [] for name in columns})


def test_every_column_of_every_table_is_described():
    rows = empty(COLUMNS.names).astype({"model": str, "quantity": str, "status": str})
    kappa = relative_error(rows, "fscm")
    verdicts = [field.name for field in fields(Judged)]
    tables = {
        "results": COLUMNS.names,
        "curves": CURVE_COLUMNS.names,
        "kappa": list(kappa),
        "largest_kappa": [*kappa, "cases", "at_end", "paper_percent", "verdict"],
        "agreement": list(agreement(rows, "fem", "fscm")),
        "comparison": list(COMPARED),
        "verdicts": verdicts,
        "summary": [*verdicts, "cases", "skipped", *COVERAGE],
        "gates": list(GATE_COLUMNS),
    }
    assert {*TABLES, "comparison"} == set(tables)
    assert [table for table in tables if title(table) is None] == []
    assert [(table, name) for table, names in tables.items() for name in names if column(table, name) is None] == []


def test_a_table_without_parquet_has_the_types_of_its_cells(tmp_path):
    (tmp_path / "own.csv").write_text("mu,mine,stated,empty\n0.1,a,True,\n,3,False,\n", encoding="utf-8")
    assert write_data_package(tmp_path, ["own.csv", "lost.csv", "own.png"])
    (resource,) = package(tmp_path)["resources"]
    assert {one["name"]: one["type"] for one in resource["schema"]["fields"]} == {
        "mu": "number",
        "mine": "string",
        "stated": "boolean",
        "empty": "string",
    }
    assert "title" not in resource
    assert "description" not in resource["schema"]["fields"][1]


def test_a_folder_without_tables_has_no_package(tmp_path):
    assert not write_data_package(tmp_path, ["run.json"])
    assert list(tmp_path.iterdir()) == []
