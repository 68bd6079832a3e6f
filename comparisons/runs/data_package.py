"""Data package of a folder (``datapackage.json``): its tables, with type, unit and meaning of every column.

The format is Frictionless Data Package (https://datapackage.org), which programs of other projects read and check.
"""

from __future__ import annotations

from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path
from typing import Any

import pandas as pd
from pandas.io.json import build_table_schema

from comparisons.data.columns import column, title
from comparisons.data.file_names import DATA_PACKAGE
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.runs.atomic_files import write_json

__all__ = ["quantities", "write_data_package"]

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
    content = path.read_bytes()
    meaning = title(path.stem)
    return {
        "name": path.stem.lower(),
        **({"title": meaning} if meaning else {}),
        "path": path.name,
        "type": "table",
        "format": "csv",
        "mediatype": "text/csv",
        "encoding": "utf-8",
        "bytes": len(content),
        "hash": f"sha256:{sha256(content).hexdigest()}",
        "schema": {"fields": _fields(path), "missingValues": [""]},
    }


def _fields(path: Path) -> list[dict[str, str]]:
    """Return name, type, unit and meaning of each column; one without a cell has the type that its unit suggests."""
    table = pd.read_csv(path)
    fields = []
    for field in build_table_schema(table, index=False)["fields"]:
        name, kind = field["name"], field["type"]
        described = column(path.stem, name)
        if table[name].isna().all():
            kind = "number" if described and described.unit else "string"
        fields.append({"name": name, "type": kind} | (described._asdict() if described else {}))
    return fields
