"""Values of the two references in the standing cases, shipped with the package.

Each tier has a table of results, a table of curves, and an origin: where they were computed, and the digest of the
solvers that computed them.  They are used as long as the solvers that run have the same digest.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.quantities import CURVES
from comparisons.runs.atomic_files import atomic, write_json
from comparisons.runs.cases import TIERS
from comparisons.runs.code_files import solver_digest
from comparisons.runs.csv_format import csv_text, read_csv
from comparisons.runs.frames import curve_frame, frame, rows_of
from comparisons.runs.rows import Key, Row

__all__ = ["FOLDER", "SHIPPED_MODELS", "ShippedValues", "load_shipped", "write_shipped"]

#: The models whose values are shipped: those that other models are compared with, and that take nearly all the time.
SHIPPED_MODELS = ("fscm", "fem")

#: The folder of the files in the package.
FOLDER = Path(__file__).resolve().parents[1] / "data" / "shipped"

_TEXTS = ("model", "model_version", "quantity", "unit", "status", "reason")

#: Digits of the stored times, which no result depends on.
_DIGITS = 3


@dataclass(frozen=True, slots=True)
class ShippedValues:
    """Rows that need no computation.

    Attributes
    ----------
    rows : mapping of key to Row
    origins : tuple of dict
        Where those of each tier were computed, as the record of a run holds it.
    obstacle : str
        Why values that are there cannot be used; empty if they can, or if there are none.
    """

    rows: Mapping[Key, Row]
    origins: tuple[dict[str, Any], ...]
    obstacle: str = ""


def load_shipped(tier: str, folder: Path = FOLDER) -> ShippedValues:
    """Return the shipped values of a tier and of the tiers before it that fit the solvers that run.

    Raises
    ------
    ValueError
        If a file is not the one that was written.

    Examples
    --------
    >>> load_shipped("quick", Path("nowhere"))
    ShippedValues(rows={}, origins=(), obstacle='')
    """
    rows: dict[Key, Row] = {}
    origins: list[dict[str, Any]] = []
    obstacle, now = "", solver_digest()
    for one in TIERS[: TIERS.index(tier) + 1]:
        if not _origin(folder, one).is_file():
            continue
        origin = json.loads(_origin(folder, one).read_text(encoding="utf-8"))
        if origin["solvers_sha256"] != now:
            obstacle = f"solvers {origin['solvers_sha256'][:12]}, now {now[:12]}"
            continue
        tables = [_checked(path, origin["files"]) for path in _tables(folder, one)]
        rows |= {row.key: row for row in rows_of(*tables)}
        origins.append(origin)
    return ShippedValues(rows, tuple(origins), obstacle)


def write_shipped(record: Mapping[str, Any], rows: list[Row], tier: str, folder: Path = FOLDER) -> list[Path]:
    """Write the values of the references among the rows of a run; return the paths of the files.

    Parameters
    ----------
    record : mapping
        Of the run that computed them.
    rows : list of Row
    tier : str
    folder : Path
    """
    chosen = [row for row in rows if row.model in SHIPPED_MODELS]
    curves = curve_frame(row for row in chosen if row.quantity in CURVES)
    results = frame(row for row in chosen if row.quantity not in CURVES)
    folder.mkdir(parents=True, exist_ok=True)
    sums = {}
    for path, table in zip(_tables(folder, tier), (results, curves), strict=True):
        rounded = table.assign(seconds=[float(f"{seconds:.{_DIGITS}g}") for seconds in table["seconds"]])
        content = csv_text(rounded).encode()
        sums[path.name] = sha256(content).hexdigest()
        with atomic(path) as file:
            file.write(content)
    origin = {
        "tier": tier,
        "solvers_sha256": record["package"]["solvers_sha256"],
        "package": {name: record["package"][name] for name in ("version", "commit", "dirty")},
        "parts": record["parts"],
        "dependencies": record["dependencies"],
        "files": sums,
    }
    write_json(origin, _origin(folder, tier))
    return [*_tables(folder, tier), _origin(folder, tier)]


def _origin(folder: Path, tier: str) -> Path:
    return folder / f"{tier}.json"


def _tables(folder: Path, tier: str) -> tuple[Path, Path]:
    return folder / f"{tier}_results.csv", folder / f"{tier}_curves.csv"


def _checked(path: Path, sums: Mapping[str, str]) -> pd.DataFrame:
    """Read a table that is as it was written."""
    if not path.is_file() or sha256(path.read_bytes()).hexdigest() != sums[path.name]:
        raise ValueError(
            f"the shipped values in {path} are not those that were written (their SHA-256 is another): install "
            "fscm-bench again, or compute them with --recompute"
        )
    return read_csv(path, _TEXTS)
