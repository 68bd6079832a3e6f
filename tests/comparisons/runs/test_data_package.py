"""Data package of a folder: type, unit and meaning of every column of its tables."""

import csv
import json
from dataclasses import fields
from hashlib import sha256
from pathlib import Path

import pandas as pd

from comparisons.data.columns import column, title
from comparisons.data.file_names import DATA_PACKAGE, TABLES
from comparisons.judging.judge import Judged
from comparisons.judging.summary import COVERAGE
from comparisons.output.errors import COMPARED, agreement, relative_error
from comparisons.output.verdicts import GATE_COLUMNS
from comparisons.pipeline.run import run
from comparisons.quantities import ALL_QUANTITIES, QUANTITIES
from comparisons.runs.data_package import write_data_package
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


def package(folder):
    return json.loads((folder / DATA_PACKAGE).read_text(encoding="utf-8"))


def test_every_table_of_a_run_is_in_its_package_and_every_cell_of_its_type(tmp_path):
    folder = run(GRID, folder=tmp_path).folder
    assert DATA_PACKAGE in read_record(folder / "run.json")["files"]
    resources = {resource["path"]: resource for resource in package(folder)["resources"]}
    assert set(resources) == {path.name for path in folder.glob("*.csv")} >= {"results.csv", "kappa.csv"}
    for name, resource in resources.items():
        content = (folder / name).read_bytes()
        assert (resource["bytes"], resource["hash"]) == (len(content), f"sha256:{sha256(content).hexdigest()}")
        assert resource["title"] == title(Path(name).stem)
        names, *rows = csv.reader(content.decode().splitlines())
        declared = resource["schema"]["fields"]
        assert [field["name"] for field in declared] == names
        assert all(field["description"] for field in declared)
        # A column with a unit is one of numbers; the percentages of the paper are texts, which keep its digits.
        texts = [field for field in declared if field["type"] in ("string", "boolean")]
        assert {field["name"] for field in texts if field["unit"]} <= {"paper_percent"}
        for row in rows:
            for field, cell in zip(declared, row, strict=True):
                assert cell == "" or READERS[field["type"]](cell) is not None
    stated = package(folder)["quantities"]
    assert list(stated) == list(ALL_QUANTITIES)
    assert all(stated[name]["unit"] == quantity.unit for name, quantity in QUANTITIES.items())


def test_every_column_of_every_table_is_described():
    rows = pd.DataFrame(columns=COLUMNS.names).astype({"model": str, "quantity": str, "status": str})
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


def test_a_table_of_a_user_has_the_types_of_its_cells(tmp_path):
    assert not write_data_package(tmp_path, ["run.json"])
    (tmp_path / "own.csv").write_text("mu,mine,stated,empty\n0.1,a,True,\n,3,False,\n", encoding="utf-8")
    assert write_data_package(tmp_path, ["own.csv", "lost.csv", "own.png"])
    (resource,) = package(tmp_path)["resources"]
    types = {field["name"]: field["type"] for field in resource["schema"]["fields"]}
    assert types == {"mu": "number", "mine": "string", "stated": "boolean", "empty": "string"}
    assert "title" not in resource
    assert "description" not in resource["schema"]["fields"][1]
