"""The content of a run folder, read back and checked once."""

from __future__ import annotations

import tomllib
from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

import pandas as pd

from comparisons.data import file_names
from comparisons.data.columns import column
from comparisons.data.contained_paths import path_inside
from comparisons.data.input_files import read_text
from comparisons.judging.decision import Verdict
from comparisons.judging.judge import Judged
from comparisons.judging.report_card import ModelCheck, check_models
from comparisons.judging.standing import inside
from comparisons.judging.summary import COVERAGE
from comparisons.output import errors
from comparisons.output.verdicts import GATE_COLUMNS
from comparisons.runs.csv_format import SECONDS, read_table
from comparisons.runs.frames import COLUMNS, CURVE_COLUMNS, keys_in, with_problem
from comparisons.runs.record import check_files, read_record, warn_of_other_code
from comparisons.runs.rows import CASE, DIMENSIONLESS, Key

#: Table -> its columns; seconds are in no file.  A folder of a sweep has no verdicts, and only that of a comparison has
#: a comparison.
_TABLES: dict[str, Sequence[str]] = {
    file_names.RESULTS: [name for name in COLUMNS if name != SECONDS],
    file_names.CURVES: [name for name in CURVE_COLUMNS if name != SECONDS],
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
    def checks(self) -> list[ModelCheck]:
        """The verdicts of the report cards."""
        return check_models(self.verdicts, self.record.get("cards", {}))

    @property
    def specs(self) -> dict[str, str]:
        """The SPEC that finds each external model."""
        return dict(self.record["arguments"]["external"])

    @property
    def domains(self) -> dict[str, Any]:
        """The domain that each external model declares."""
        return dict(self.record.get("domains", {}))

    @property
    def kappa_inside(self) -> pd.DataFrame:
        """The relative errors within the ranges that the models declare."""
        return self.kappa[inside(self.kappa, self.kappa["model"], self.domains)]

    @property
    def problem_kinds(self) -> dict[str, tuple[str, str]]:
        """The kind of solid and of punch of each problem file."""
        kinds = {}
        for name, text in self.texts.items():
            if name != file_names.GRID_TEXT:
                sections = tomllib.loads(text)
                solid, punch = (sections.get(section, {}).get("kind", section) for section in ("solid", "punch"))
                kinds[PurePosixPath(name).name] = (str(solid), str(punch))
        return kinds

    def evaluations(self, planned: Collection[tuple[Key, str]] | None = None) -> pd.DataFrame:
        """Return the results that have a reference, each with its error, and whether its model declares its case.

        Parameters
        ----------
        planned : set of (Key, str), optional
            The keys of the results that count, with a reference of each; by default every result in a case in which
            the reference has a result, if a model has an error in this quantity against it.

        Returns
        -------
        DataFrame
            Columns of the results, reference, kappa and u_kappa, and inside
            (`comparisons.judging.standing.inside`).
        """
        kappa = with_problem(self.kappa)[[*_KEY, "reference", "kappa", "u_kappa"]]
        counted = self._compared() if planned is None else planned
        references = sorted({reference for _, reference in counted})
        keys = keys_in(self.results)
        pairs = [(row, name) for name in references for row, key in enumerate(keys) if (key, name) in counted]
        # A model without any value has no relative error, which would name the reference.
        results = with_problem(self.results).iloc[[row for row, _ in pairs]]
        results = results.assign(reference=pd.Series([name for _, name in pairs], results.index, dtype=str))
        joined = results.merge(kappa, on=[*_KEY, "reference"], how="left")
        joined = joined[joined["model"] != joined["reference"]]
        if planned is None:
            # A model with values and no error is compared with no reference: it verifies one.
            series = [joined[name] for name in ("model", "quantity", "reference")]
            compared = joined["kappa"].notna().groupby(series).transform("any")
            answered = (joined["status"] == "ok").groupby(series).transform("any")
            joined = joined[compared | ~answered]
        return joined.assign(inside=inside(joined, joined["model"], self.domains)).reset_index(drop=True)

    def _compared(self) -> set[tuple[Key, str]]:
        """Return the keys of the results that may have an error, with each reference of a result in their case."""
        keys = keys_in(self.results)
        with_errors = set(self.kappa[["reference", "quantity"]].itertuples(index=False, name=None))
        references = defaultdict(list)
        for model, quantity, *case in keys:
            if (model, quantity) in with_errors:
                references[quantity, *case].append(model)
        return {(key, reference) for key in keys for reference in references.get(key[1:], ())}


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
