"""What a run folder holds, read back and checked once; everything after this may rely on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.judging.judge import Judged
from comparisons.output.verdicts import GATE_COLUMNS
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import check_files, read_record, warn_of_other_code
from comparisons.runs.rows import COLUMNS, CURVE_COLUMNS
from comparisons.runs.tables import read_table

__all__ = ["Stored", "read_folder"]

_KAPPA = (
    *("quantity", "model", "n", "k", "mu", "nu", "value", "u_num"),
    *("reference", "reference_value", "u_reference", "kappa", "u_kappa"),
)
_LARGEST = ("quantity", "model", "n", "k", "cases", "mu", "at_end", "kappa", "u_kappa", "paper_percent", "verdict")

#: Table -> its columns.
_TABLES: dict[str, Sequence[str]] = {
    "results": COLUMNS.names,
    "curves": CURVE_COLUMNS.names,
    "verdicts": Judged.__slots__,
    "kappa": _KAPPA,
    "largest_kappa": _LARGEST,
}

#: Columns of text, or of truth; every other one holds numbers.
_WORDS = {
    "model",
    "model_version",
    "quantity",
    "unit",
    "status",
    "reason",
    "gate",
    "candidate",
    "reference",
    "verdict",
    "paper_percent",
    "at_end",
}


@dataclass(frozen=True, slots=True)
class Stored:
    """The record and the tables of a run, as `comparisons.pipeline.run` wrote them.

    `gates` is None in a folder that was judged before gates were stored beside the verdicts.
    """

    record: dict[str, Any]
    results: pd.DataFrame
    curves: pd.DataFrame
    verdicts: pd.DataFrame
    kappa: pd.DataFrame
    largest: pd.DataFrame
    gates: pd.DataFrame | None


def read_folder(folder: Path) -> Stored:
    """Read the folder of a finished run.

    Raises
    ------
    ValueError
        If there is no finished run, or a file of it is broken or was changed; one sentence says which and how.
    """
    files = RunFolder(folder)
    record = read_record(files.record)
    check_files(record, folder)
    warn_of_other_code(record, folder)
    tables = {name: _table(folder / f"{name}.parquet", columns) for name, columns in _TABLES.items()}
    gates = files.parquet(files.gates)
    unknown = sorted(set(tables["verdicts"]["verdict"]) - {str(verdict) for verdict in Verdict})
    if unknown:
        raise ValueError(f"{files.parquet(files.verdicts)} has the unknown verdict {unknown[0]!r}")
    return Stored(
        record,
        tables["results"],
        tables["curves"],
        tables["verdicts"],
        tables["kappa"],
        tables["largest_kappa"],
        _table(gates, GATE_COLUMNS, words=set(GATE_COLUMNS)) if gates.exists() else None,
    )


def _table(path: Path, columns: Sequence[str], words: set[str] = _WORDS) -> pd.DataFrame:
    table = read_table(path)
    lost = [name for name in columns if name not in table]
    if lost:
        raise ValueError(f"{path} has no column {', '.join(lost)}: it is not what this version of fscm-bench writes")
    for name in columns:
        if name in words:
            continue
        try:
            # A column without a single number comes back without the type of one.
            table[name] = pd.to_numeric(table[name]).astype(float)
        except (TypeError, ValueError):
            raise ValueError(f"{path} has something in its column {name} that is no number") from None
    return table[list(columns)]
