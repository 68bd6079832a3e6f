"""The content of the folder of a sweep over a problem file, read back and checked once."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import KAPPA, RESULTS
from comparisons.data.input_files import read_text
from comparisons.output.problem_tables import ERROR_COLUMNS, VALUE_COLUMNS, varied_of
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import check_files, read_record, warn_of_other_code
from comparisons.runs.tables import read_table

__all__ = ["StoredProblemSweep", "read_problem_sweep"]


@dataclass(frozen=True, slots=True)
class StoredProblemSweep:
    """The record and the tables of a sweep over a problem file.

    Attributes
    ----------
    record : dict
    results, errors : DataFrame
        As of `comparisons.output.problem_tables`.
    text : str
        Of the problem file.
    """

    record: dict[str, Any]
    results: pd.DataFrame
    errors: pd.DataFrame
    text: str

    @property
    def varied(self) -> list[str]:
        """The columns of the varied keys."""
        return varied_of(self.results)


def read_problem_sweep(folder: Path) -> StoredProblemSweep:
    """Read the folder of a finished sweep over a problem file.

    Raises
    ------
    ValueError
        If a file of it is missing, broken or was changed; one sentence says which and how.
    """
    record = read_record(RunFolder(folder).record)
    check_files(record, folder)
    warn_of_other_code(record, folder)
    results = _table(folder / f"{RESULTS}.parquet", VALUE_COLUMNS)
    errors = _table(folder / f"{KAPPA}.parquet", ERROR_COLUMNS)
    text = read_text(path_inside(folder, record["inputs"]["problem"]), "the copy of the problem file")
    return StoredProblemSweep(record, results, errors, text)


def _table(path: Path, columns: tuple[str, ...]) -> pd.DataFrame:
    table = read_table(path)
    lost = [name for name in columns if name not in table]
    if lost:
        raise ValueError(f"{path} has no column {', '.join(lost)}: it is not what this version of fscm-bench writes")
    return table
