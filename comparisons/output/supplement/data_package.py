"""The description of the tables of a run as a data package (Frictionless Data, data package and table schema, v1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.data.columns import column
from comparisons.runs.csv_format import read_table
from comparisons.runs.environment import version_of


def data_package(record: Mapping[str, Any], tables: Sequence[Path], folder: str) -> dict[str, Any]:
    """Return the content of ``datapackage.json``.

    Parameters
    ----------
    record : mapping
        Of the run, as `comparisons.runs.record.read_record` returns it.
    tables : sequence of Path
        The CSV files.
    folder : str
        Where the package has them.
    """
    package = record["package"]
    return {
        "profile": "tabular-data-package",
        "name": "fscm-bench-run",
        "title": "Results of fscm-bench: values, errors against a reference and their bounds",
        "created": record["finished"],
        "version": package["version"],
        "sources": [{"title": f"fscm-bench {version_of(package)}, SHA-256 of its code {package['code_sha256']}"}],
        "command": record["command"],
        "resources": [_resource(path, f"{folder}/{path.name}") for path in tables],
    }


def _resource(path: Path, where: str) -> dict[str, Any]:
    content, table = path.read_bytes(), read_table(path)
    return {
        "profile": "tabular-data-resource",
        "name": path.stem.replace("_", "-"),
        "path": where,
        "format": "csv",
        "mediatype": "text/csv",
        "encoding": "utf-8",
        "bytes": len(content),
        "hash": f"sha256:{sha256(content).hexdigest()}",
        "schema": {"fields": [_field(path.stem, str(name), table[name]) for name in table], "missingValues": [""]},
    }


def _field(table: str, name: str, stored: pd.Series) -> dict[str, str]:
    """Return what a column holds; the name of a varied key has its unit in brackets."""
    kind = "boolean" if stored.dtype == bool else "number" if pd.api.types.is_numeric_dtype(stored) else "string"
    described = column(table, name)
    facts = {"description": described.description, "unit": described.unit} if described else {}
    return {"name": name, "type": kind} | {fact: text for fact, text in facts.items() if text}
