"""Data package of a folder (``datapackage.json``): its tables, with type, unit and meaning of every column.

The format is Frictionless Data Package (https://datapackage.org), which programs of other projects read and check.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from comparisons.data.columns import column, title
from comparisons.data.file_names import DATA_PACKAGE
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.runs.atomic_files import write_json

__all__ = ["described", "quantities", "write_data_package"]

_DESCRIPTION = (
    "Tables of fscm-bench. Numbers have 17 significant digits, which give every double back; an empty cell is a number "
    "that there is not. A text that a spreadsheet would evaluate as a formula has an apostrophe before it. The origin "
    "of the numbers is in run.json."
)


def quantities() -> dict[str, dict[str, str]]:
    """Return symbol, meaning and unit of every quantity, ready for JSON.

    Examples
    --------
    >>> quantities()["pull_off_force"]["unit"], quantities()["force_curve"]["unit_x"]
    ('pi Q^(2/n) dgamma z0^(2/n-1)', 'z0')
    """
    numbers = {
        name: {"symbol": row.symbol, "meaning": row.meaning, "unit": row.unit} for name, row in QUANTITIES.items()
    }
    curves = {
        name: {"symbol": row.symbol, "meaning": row.meaning, "unit_x": row.x.unit, "unit_y": row.y.unit}
        for name, row in CURVES.items()
    }
    return numbers | curves


def described(table: str, schema: pa.Schema) -> pa.Schema:
    """Return a schema with unit and meaning of each column in the metadata of its field.

    Examples
    --------
    >>> described("kappa", pa.schema([("kappa", pa.float64())])).field("kappa").metadata[b"unit"]
    b'1'
    """
    fields = []
    for field in schema:
        known = column(table, field.name)
        fields.append(field.with_metadata(known._asdict()) if known else field)
    return pa.schema(fields, metadata=schema.metadata)


def write_data_package(folder: Path, names: Iterable[str]) -> bool:
    """Write the data package of the CSV tables of a folder, atomically; return whether there is any.

    Parameters
    ----------
    folder : Path
    names : iterable of str
        Names of its files; those that are no CSV table, or not there, or in a folder of copies, are passed over.
    """
    tables = [
        folder / name for name in names if name.endswith(".csv") and "/" not in name and (folder / name).is_file()
    ]
    if not tables:
        return False
    content = {
        "$schema": "https://datapackage.org/profiles/2.0/datapackage.json",
        "name": "fscm-bench-results",
        "title": "Results of fscm-bench",
        "description": _DESCRIPTION,
        "resources": [_resource(path) for path in tables],
        "quantities": quantities(),
    }
    write_json(content, folder / DATA_PACKAGE)
    return True


def _resource(path: Path) -> dict[str, Any]:
    text = path.read_bytes()
    known = title(path.stem)
    return {
        "name": path.stem.lower(),
        **({"title": known} if known else {}),
        "path": path.name,
        "type": "table",
        "format": "csv",
        "mediatype": "text/csv",
        "encoding": "utf-8",
        "bytes": len(text),
        "hash": f"sha256:{sha256(text).hexdigest()}",
        "schema": {"fields": _fields(path), "missingValues": [""]},
    }


def _fields(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        names = next(csv.reader(file), [])
    types = _types(path, names)
    fields = []
    for name in names:
        known = column(path.stem, name)
        # Cells that are all empty have no type of their own.
        kind = types[name] or ("number" if known and known.unit else "string")
        fields.append({"name": name, "type": kind, **(known._asdict() if known else {})})
    return fields


def _types(path: Path, names: Sequence[str]) -> dict[str, str | None]:
    """Return the type of each column, None if all cells are empty: that of the Parquet file, or else of the cells."""
    stored = path.with_suffix(".parquet")
    with suppress(OSError, pa.ArrowException):
        schema = pq.read_schema(stored)
        return {name: _type(schema.field(name).type) if name in schema.names else "string" for name in names}
    cells = pd.read_csv(path, dtype=str, keep_default_na=False)
    return {name: _type_of_cells(cells[name]) for name in names}


def _type(stored: pa.DataType) -> str | None:
    if pa.types.is_null(stored):
        return None
    if pa.types.is_boolean(stored):
        return "boolean"
    if pa.types.is_integer(stored):
        return "integer"
    return "number" if pa.types.is_floating(stored) else "string"


def _type_of_cells(cells: pd.Series) -> str | None:
    filled = cells[cells != ""]
    if filled.empty:
        return None
    if filled.isin(["True", "False"]).all():
        return "boolean"
    return "number" if pd.to_numeric(filled, errors="coerce").notna().all() else "string"
