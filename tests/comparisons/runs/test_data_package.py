"""Data package of a folder: type, unit and meaning of every column of its tables."""

import csv
import json
from hashlib import sha256
from pathlib import Path

import pytest

import comparisons
from comparisons.data.columns import title
from comparisons.data.file_names import DATA_PACKAGE
from comparisons.quantities import ALL_QUANTITIES, QUANTITIES
from comparisons.runs.data_package import write_data_package
from comparisons.runs.record import read_record

#: Type of a column -> what reads its cells.
READERS = {"number": float, "integer": int, "boolean": {"True": True, "False": False}.__getitem__, "string": str}


def package(folder):
    return json.loads((folder / DATA_PACKAGE).read_text(encoding="utf-8"))


@pytest.mark.parametrize("compute", ["run", "compare"])
def test_every_table_is_in_the_package_and_every_cell_of_its_type(small_grid, tmp_path, monkeypatch, compute):
    if compute == "run":
        comparisons.run("quick", folder=tmp_path)
    else:
        monkeypatch.setattr("comparisons.pipeline.compare.save", lambda figure, path: path.touch())
        comparisons.compare(["jkr", "bradley"], n=[2], k=[0, 0.4], mu=[1], reference="atlas", folder=tmp_path)
    assert DATA_PACKAGE in read_record(tmp_path / "run.json")["files"]
    resources = {resource["path"]: resource for resource in package(tmp_path)["resources"]}
    assert set(resources) == {path.name for path in tmp_path.glob("*.csv")} >= {"results.csv", "kappa.csv"}
    for name, resource in resources.items():
        content = (tmp_path / name).read_bytes()
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
    stated = package(tmp_path)["quantities"]
    assert list(stated) == list(ALL_QUANTITIES)
    assert all(stated[name]["unit"] == quantity.unit for name, quantity in QUANTITIES.items())


def test_a_table_of_a_user_has_the_types_of_its_cells(tmp_path):
    assert not write_data_package(tmp_path, ["run.json"])
    (tmp_path / "own.csv").write_text("mu,mine,stated,empty\n0.1,a,True,\n,3,False,\n", encoding="utf-8")
    assert write_data_package(tmp_path, ["own.csv", "lost.csv", "own.png"])
    (resource,) = package(tmp_path)["resources"]
    types = {field["name"]: field["type"] for field in resource["schema"]["fields"]}
    assert types == {"mu": "number", "mine": "string", "stated": "boolean", "empty": "string"}
    assert "title" not in resource
    assert "description" not in resource["schema"]["fields"][1]
