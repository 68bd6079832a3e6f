"""The content of a run folder, read back and checked once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.data import file_names
from comparisons.data.columns import column
from comparisons.data.contained_paths import path_inside
from comparisons.data.input_files import read_text
from comparisons.judging.decision import Verdict
from comparisons.judging.judge import Judged
from comparisons.judging.summary import COVERAGE
from comparisons.output import errors
from comparisons.output.verdicts import GATE_COLUMNS
from comparisons.runs.csv_format import read_table
from comparisons.runs.frames import COLUMNS, CURVE_COLUMNS, keys_in, with_problem
from comparisons.runs.record import check_files, read_record, warn_of_other_code
from comparisons.runs.rows import CASE, DIMENSIONLESS, Key

#: Table -> its columns; seconds are in no file.  A folder of a sweep has no verdicts, and only that of a comparison has
#: a comparison.
_TABLES: dict[str, Sequence[str]] = {
    file_names.RESULTS: COLUMNS[:-1],
    file_names.CURVES: CURVE_COLUMNS[:-1],
    **errors.COLUMNS,
    file_names.VERDICTS: Judged.__slots__,
    file_names.SUMMARY: (*Judged.__slots__, "cases", "skipped", *COVERAGE),
    file_names.GATES: GATE_COLUMNS,
}

#: Columns that identify an evaluation.
_KEY = ["model", "quantity", *CASE]


@dataclass(frozen=True, slots=True)
class Stored:
    """The record and the tables of a run, of a sweep or of a comparison.

    A table that the folder does not have has no rows.  `texts` are the copies of the file of cases and of the problem
    files, by their names.
    """

    record: dict[str, Any]
    results: pd.DataFrame
    curves: pd.DataFrame
    kappa: pd.DataFrame
    largest_kappa: pd.DataFrame
    verdicts: pd.DataFrame
    summary: pd.DataFrame
    gates: pd.DataFrame
    comparison: pd.DataFrame
    texts: dict[str, str] = field(default_factory=dict)

    @property
    def judged(self) -> bool:
        """Whether the folder is that of a run."""
        return f"{file_names.VERDICTS}.csv" in self.record["files"]

    @property
    def specs(self) -> dict[str, str]:
        """The SPEC that finds each external model."""
        return dict(self.record["arguments"]["external"])

    def error_summary(self, planned: Mapping[Key, str] | None = None) -> pd.DataFrame:
        """Return the summary of errors (`comparisons.output.errors`) over the results that have a reference.

        Parameters
        ----------
        planned : mapping of Key to str, optional
            The keys of the results that count, and the reference of each; by default every result of a quantity in
            which a model has an error.
        """
        kappa = with_problem(self.kappa)[[*_KEY, "reference", "kappa", "u_kappa"]]
        of_quantity = dict(kappa.groupby("quantity")["reference"].agg("first"))
        keys = keys_in(self.results)
        stated = [of_quantity.get(key[1]) if planned is None else planned.get(key) for key in keys]
        results = with_problem(self.results).assign(stated=stated).dropna(subset="stated")
        joined = results.merge(kappa, on=_KEY, how="left")
        # A model without any value has no relative error, which would name the reference.
        joined["reference"] = joined["reference"].fillna(joined["stated"])
        summary = errors.error_summary(joined[joined["model"] != joined["reference"]])
        if planned is not None:
            return summary
        # A model with values and no error is compared with no reference: it verifies one.
        return summary[(summary["cases"] > 0) | (summary["answered"] == 0)].reset_index(drop=True)


def read_folder(folder: Path) -> Stored:
    """Read the folder of a finished run, sweep or comparison.

    Raises
    ------
    ValueError
        If there is none, or a file of it is broken or was changed; one sentence says which and how.
    """
    record = read_record(folder / file_names.RECORD)
    check_files(record, folder)
    warn_of_other_code(record, folder)
    optional = (
        _TABLES.keys()
        - {file_names.RESULTS, file_names.CURVES, file_names.KAPPA}
        - {path.removesuffix(".csv") for path in record["files"]}
    )
    tables = {
        name: pd.DataFrame(columns=list(columns)) if name in optional else _table(folder / f"{name}.csv", columns)
        for name, columns in _TABLES.items()
    }
    texts = {
        name: read_text(path_inside(folder, name), f"the copy {name}")
        for name in record["files"]
        if name == file_names.GRID_TEXT or (name.startswith(f"{file_names.INPUTS}/") and name.endswith(".toml"))
    }
    return Stored(record, **tables, texts=texts)


def _table(path: Path, columns: Sequence[str]) -> pd.DataFrame:
    table = read_table(path)
    if lost := [name for name in columns if name not in table and name not in ("problem", *DIMENSIONLESS)]:
        raise ValueError(f"{path} has no column {', '.join(lost)}: it is not what this version of fscm-bench writes")
    for name in table.columns.intersection(list(columns)):
        described = column(path.stem, name)
        if described and described.unit and table[name].dtype != float:
            raise ValueError(f"{path}: its column {name} is not numeric")
    if path.stem in (file_names.VERDICTS, file_names.SUMMARY) and (odd := set(table["verdict"]) - set(Verdict)):
        raise ValueError(f"{path} has the unknown verdict {min(odd)!r}")
    return table
