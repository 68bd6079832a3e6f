"""Values of the two references in the standing cases of the quick tier, shipped with the package.

They are a table of results, a table of curves, and their origin: where they were computed, and the digest of the
solvers that computed them.  They are used as long as the solvers that run have the same digest.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.quantities import CURVES
from comparisons.runs.atomic_files import atomic, write_json
from comparisons.runs.code_files import solver_digest
from comparisons.runs.csv_format import csv_text, read_csv
from comparisons.runs.frames import curve_frame, frame, rows_of
from comparisons.runs.rows import Key, Row

__all__ = ["FOLDER", "SHIPPED_MODELS", "ShippedValues", "load_shipped", "write_shipped"]

#: The models whose values are shipped: those that other models are compared with, and that take nearly all the time.
SHIPPED_MODELS = ("fscm", "fem")

#: The folder of the files in the package.
FOLDER = Path(__file__).resolve().parents[1] / "data" / "shipped"

#: The tables of results and of curves, and their origin.
_TABLES, _ORIGIN = ("results.csv", "curves.csv"), "origin.json"

_TEXTS = ("model", "model_version", "quantity", "unit", "status", "reason")

#: Digits of the stored times, which no result depends on.
_DIGITS = 3


@dataclass(frozen=True, slots=True)
class ShippedValues:
    """Rows that need no computation.

    Attributes
    ----------
    rows : mapping of key to Row
    origin : dict
        Where they were computed, as the record of a run holds it; empty without rows.
    obstacle : str
        Why values that are there cannot be used; empty if they can, or if there are none.
    """

    rows: Mapping[Key, Row]
    origin: dict[str, Any]
    obstacle: str = ""


def load_shipped(folder: Path = FOLDER) -> ShippedValues:
    """Return the shipped values, if they fit the solvers that run.

    Raises
    ------
    ValueError
        If a file is not the one that was written.

    Examples
    --------
    >>> load_shipped(Path("nowhere"))
    ShippedValues(rows={}, origin={}, obstacle='')
    """
    if not (folder / _ORIGIN).is_file():
        return ShippedValues({}, {})
    origin = json.loads((folder / _ORIGIN).read_text(encoding="utf-8"))
    then, now = origin["solvers_sha256"], solver_digest()
    if then != now:
        return ShippedValues({}, {}, f"solvers {then[:12]}, now {now[:12]}")
    sums = origin.pop("files")
    results, curves = (_checked(folder / name, sums) for name in _TABLES)
    return ShippedValues({row.key: row for row in rows_of(results, curves)}, origin)


def write_shipped(record: Mapping[str, Any], rows: Iterable[Row], folder: Path = FOLDER) -> list[Path]:
    """Write the values of the references among the rows of a run; return the paths of the files.

    Parameters
    ----------
    record : mapping
        Of the run that computed them.
    rows : iterable of Row
        Failed ones are left out.
    folder : Path
    """
    chosen = [row for row in rows if row.model in SHIPPED_MODELS and row.status != "failed"]
    curves = curve_frame(row for row in chosen if row.quantity in CURVES)
    results = frame(row for row in chosen if row.quantity not in CURVES)
    folder.mkdir(parents=True, exist_ok=True)
    sums = {}
    for name, table in zip(_TABLES, (results, curves), strict=True):
        rounded = table.assign(seconds=[float(f"{seconds:.{_DIGITS}g}") for seconds in table["seconds"]])
        content = csv_text(rounded).encode()
        sums[name] = sha256(content).hexdigest()
        with atomic(folder / name) as file:
            file.write(content)
    origin = {
        "solvers_sha256": record["package"]["solvers_sha256"],
        "package": {name: record["package"][name] for name in ("version", "commit", "dirty")},
        "parts": record["parts"],
        "dependencies": record["dependencies"],
        "files": sums,
    }
    write_json(origin, folder / _ORIGIN)
    return [folder / name for name in (*_TABLES, _ORIGIN)]


def _checked(path: Path, sums: Mapping[str, str]) -> pd.DataFrame:
    """Read a table that is as it was written."""
    if not path.is_file() or sha256(path.read_bytes()).hexdigest() != sums[path.name]:
        raise ValueError(
            f"the shipped values in {path} are not those that were written (their SHA-256 is another): install "
            "fscm-bench again, or compute them with --recompute"
        )
    return read_csv(path, _TEXTS)
