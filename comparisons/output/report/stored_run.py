"""The content of a run folder, read back and checked once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.data.columns import column
from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import (
    COMPARISON,
    CURVES,
    GRID_TEXT,
    INPUTS,
    KAPPA,
    LARGEST_KAPPA,
    RESULTS,
    SUMMARY,
    VERDICTS,
)
from comparisons.data.input_files import read_text
from comparisons.judging.decision import Verdict
from comparisons.judging.judge import Judged
from comparisons.judging.summary import COVERAGE
from comparisons.output.comparison import COLUMNS as COMPARED
from comparisons.output.verdicts import GATE_COLUMNS
from comparisons.runs.case_columns import DIMENSIONLESS, varied_of
from comparisons.runs.folder import RunFolder
from comparisons.runs.frames import COLUMNS, CURVE_COLUMNS
from comparisons.runs.record import check_files, read_record, warn_of_other_code
from comparisons.runs.rows import CASE
from comparisons.runs.tables import read_table

__all__ = ["Stored", "read_folder"]

#: Table of every folder -> its columns.
_TABLES: dict[str, Sequence[str]] = {
    RESULTS: COLUMNS.names,
    CURVES: CURVE_COLUMNS.names,
    KAPPA: (
        *("quantity", "model", *CASE, "value", "u_num"),
        *("reference", "reference_value", "u_reference", "kappa", "u_kappa"),
    ),
}

#: Table of what is judged, which a sweep does not have -> its columns.
_JUDGED: dict[str, Sequence[str]] = {
    VERDICTS: Judged.__slots__,
    # In the order of `comparisons.judging.summary.summarise`.
    SUMMARY: (
        "verdict",
        *(name for name in Judged.__slots__ if name not in ("verdict", "reason")),
        *("cases", "skipped", *COVERAGE, "reason"),
    ),
    LARGEST_KAPPA: (
        *("quantity", "model", "n", "k", "cases", "mu", "at_end"),
        *("kappa", "u_kappa", "paper_percent", "verdict"),
    ),
}

#: Numbers that are texts with the digits of the paper.
_TEXTS = ("paper_percent",)


@dataclass(frozen=True, slots=True)
class Stored:
    """The record and the tables of a run, of a sweep or of a comparison.

    Of a sweep and of a comparison nothing is judged: `judged` is false, and `verdicts` and `summary` have no rows.
    `gates` is None there, and in a folder that was judged before gates were stored beside the verdicts.  `compared` is
    the table of a comparison (`comparisons.output.comparison.comparison_table`), and None in another folder.  `texts`
    are the copies of the file of cases and of the problem files, by their names.
    """

    record: dict[str, Any]
    results: pd.DataFrame
    curves: pd.DataFrame
    kappa: pd.DataFrame
    verdicts: pd.DataFrame
    summary: pd.DataFrame
    largest: pd.DataFrame
    gates: pd.DataFrame | None
    judged: bool = True
    compared: pd.DataFrame | None = None
    texts: dict[str, str] = field(default_factory=dict)


def read_folder(folder: Path) -> Stored:
    """Read the folder of a finished run, sweep or comparison.

    Raises
    ------
    ValueError
        If there is none, or a file of it is broken or was changed; one sentence says which and how.
    """
    files = RunFolder(folder)
    record = read_record(files.record)
    check_files(record, folder)
    warn_of_other_code(record, folder)
    judged = _has(folder, record, VERDICTS) or _has(folder, record, SUMMARY)
    tables = {name: _table(folder / f"{name}.parquet", columns) for name, columns in _TABLES.items()}
    for name, columns in _JUDGED.items():
        there = judged or _has(folder, record, name)
        tables[name] = _table(folder / f"{name}.parquet", columns) if there else pd.DataFrame(columns=list(columns))
    for name in (VERDICTS, SUMMARY):
        unknown = sorted(set(tables[name]["verdict"]) - {str(verdict) for verdict in Verdict})
        if unknown:
            raise ValueError(f"{folder / f'{name}.parquet'} has the unknown verdict {unknown[0]!r}")
    gates, compared = files.parquet(files.gates), files.parquet(files.comparison)
    return Stored(
        record,
        tables[RESULTS],
        tables[CURVES],
        tables[KAPPA],
        tables[VERDICTS],
        tables[SUMMARY],
        tables[LARGEST_KAPPA],
        _table(gates, GATE_COLUMNS) if gates.exists() else None,
        judged,
        _table(compared, COMPARED) if _has(folder, record, COMPARISON) else None,
        {name: read_text(path_inside(folder, name), f"the copy {name}") for name in record["files"] if _is_case(name)},
    )


def _is_case(name: str) -> bool:
    """Whether a file of a folder states cases: the grids, or a problem file."""
    return name == GRID_TEXT or (name.startswith(f"{INPUTS}/") and name.endswith(".toml"))


def _has(folder: Path, record: dict[str, Any], name: str) -> bool:
    """Whether a folder has a table, or lost it: the record lists it, and its reader refuses the folder."""
    return (folder / f"{name}.parquet").exists() or f"{name}.parquet" in record["files"]


def _table(path: Path, columns: Sequence[str]) -> pd.DataFrame:
    table = read_table(path)
    columns = [name for name in columns if name not in ("problem", *DIMENSIONLESS) or name in table]
    lost = [name for name in columns if name not in table]
    if lost:
        raise ValueError(f"{path} has no column {', '.join(lost)}: it is not what this version of fscm-bench writes")
    for name in columns:
        described = column(path.stem, name)
        if described is None or not described.unit or name in _TEXTS:
            continue
        try:
            # A column without a single number comes back without the type of one.
            table[name] = pd.to_numeric(table[name]).astype(float)
        except (TypeError, ValueError):
            raise ValueError(f"{path} has something in its column {name} that is no number") from None
    return table[[*columns, *varied_of(table)]]
