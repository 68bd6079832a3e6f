"""Tables of a comparison: every model against the reference in every case of a grid, and as text for 80 columns."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from rich.console import RenderableType

from comparisons.judging.summary import coverage_text
from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.numerics.number_text import exact, value_text
from comparisons.output.table import (
    CASE_NAMES,
    Cell,
    Column,
    chosen,
    percents,
    short_percent,
    table_of,
    texts_of,
    words,
)
from comparisons.output.terminal import rich_table
from comparisons.problem import PARAMETERS
from comparisons.runs.case_columns import keys_in, with_problem, without_empty_problem
from comparisons.runs.cases import Grid
from comparisons.runs.rows import CASE
from comparisons.runs.tasks import Task, problem_for

__all__ = [
    "COLUMNS",
    "SUMMARY",
    "WIDTH",
    "by_case",
    "case_columns",
    "comparison_table",
    "error_cell",
    "terminal_tables",
]

#: Columns of `comparison_table`.
COLUMNS = (
    *("quantity", *CASE, "model", "status", "value", "u_num"),
    *("reference", "reference_value", "u_reference", "kappa", "u_kappa", "reason"),
)

#: Columns of the tables where no terminal states its own.
WIDTH = 80

#: Cases that a terminal shows: the file has the others.
_ROWS = 40

#: The reference is shown to this digit, or to the digit that its uncertainty leaves it.
_LEAST_REFERENCE = 5e-7

#: Spaces between columns.
_GAP = 2

_WORDS = {"not-applicable": "n/a", "failed": "failed"}


def comparison_table(results: pd.DataFrame, grids: Iterable[Grid], models: Sequence[str] | None) -> pd.DataFrame:
    """Return one row for each quantity, case and model, beside the reference of the grid.

    Parameters
    ----------
    results : DataFrame
        Stored results (`comparisons.runs.frames.COLUMNS`).
    grids : iterable of Grid
    models : sequence of str or None
        Models in place of those each grid names.

    Returns
    -------
    DataFrame
        `COLUMNS`.  `value` is NaN unless `status` is "ok"; `kappa` is NaN too where the reference has no value, and
        `reason` states why.
    """
    columns = results[["status", "value", "u_num", "reason"]].itertuples(index=False, name=None)
    stored = dict(zip(keys_in(results), columns, strict=True))

    def found(model: str, quantity: str, case: Any) -> tuple[str, float, float, str]:
        return stored[Task(model, quantity, problem_for(model, case)).key]

    rows: dict[tuple[Any, ...], list[Any]] = {}
    for grid in grids:
        for quantity in grid.quantities:
            for case in grid.cases:
                status, reference, u_reference, why = found(grid.reference, quantity, case)
                parameters = [np.nan if entry is None else entry for entry in case.key]
                for model in models or grid.models:
                    if model == grid.reference:
                        continue
                    own, value, u_num, reason = found(model, quantity, case)
                    if own == "ok" and status != "ok":
                        reason = f"the reference {grid.reference}: {status}: {why}"
                    key = quantity, case, model, grid.reference
                    rows[key] = [quantity, *parameters, model, own, value, u_num]
                    rows[key] += [grid.reference, reference, u_reference, reason]
    names = [name for name in COLUMNS if not name.endswith("kappa")]
    table = pd.DataFrame(rows.values(), columns=names)
    table = table.astype(dict.fromkeys((*PARAMETERS, "value", "u_num", "reference_value", "u_reference"), float))
    with np.errstate(divide="ignore", invalid="ignore"):
        table["kappa"] = relative_difference(table["value"], table["reference_value"])
        table["u_kappa"] = relative_uncertainty(
            table["value"], table["u_num"], table["reference_value"], table["u_reference"]
        )
    return without_empty_problem(table[list(COLUMNS)])


def error_cell(row: Mapping[str, Any]) -> Cell:
    """Return kappa of a row in percent, or the reason why there is none in a word or two.

    Examples
    --------
    >>> error_cell({"status": "ok", "kappa": -0.0494, "u_kappa": 1e-9})
    Cell(text='-4.940(5)', value=-0.0494, marks=(), more='')
    >>> error_cell({"status": "not-applicable", "kappa": np.nan, "u_kappa": np.nan}).text
    'n/a'
    """
    if row["status"] != "ok":
        return Cell(_WORDS.get(row["status"], str(row["status"])))
    kappa = row["kappa"]
    return Cell("no reference") if np.isnan(kappa) else Cell(short_percent(kappa, row["u_kappa"]), kappa)


def _reference_cell(row: Mapping[str, Any]) -> Cell:
    """The value of a reference to seven decimals, or digits, at most."""
    value, u = row["reference_value"], row["u_reference"]
    text = value_text(value, max(u, _LEAST_REFERENCE * min(abs(value), 1.0)))
    return Cell(text, value) if text else Cell("none")


def _place(row: Mapping[str, Any]) -> Cell:
    named = [f"{name}={exact(row[name])}" for name in PARAMETERS if not np.isnan(row[name])]
    return Cell(row.get("problem") or " ".join(named))


#: Columns of the summary of a quantity; errors are in percent.
SUMMARY = (
    *chosen("model"),
    Column("a value in", cell=lambda row: Cell(coverage_text(row))),
    percents("largest", "largest", "u_largest"),
    Column("at", cell=_place),
    percents("rms", "rms", "u"),
)


def case_columns(reference: str, models: Sequence[str]) -> list[Column]:
    """Return the columns of a table with a row a case: its parameters, the reference, and kappa of each model.

    Parameters
    ----------
    reference : str
    models : sequence of str
    """
    return [
        *CASE_NAMES,
        Column(reference, "number", _reference_cell),
        *(Column(name, "number", partial(_error_of, name)) for name in models),
    ]


def _error_of(model: str, row: Mapping[str, Any]) -> Cell:
    return row["errors"].get(model, Cell(""))


def by_case(table: pd.DataFrame) -> Iterator[tuple[str, str, list[str], pd.DataFrame]]:
    """Yield the quantity, the reference, the models and a row a case for each, as `case_columns` shows it.

    The column `errors` holds a cell of each model, and `lines` the places of its rows in the table.

    Parameters
    ----------
    table : DataFrame
        As of `comparison_table`.
    """
    numbered = with_problem(table).assign(line=range(len(table)))
    for (quantity, reference), group in numbered.groupby(["quantity", "reference"], sort=False):
        rows = []
        for _, of_case in group.groupby([*CASE], sort=False, dropna=False):
            records = of_case.to_dict("records")
            errors = {row["model"]: error_cell(row) for row in records}
            rows.append(records[0] | {"errors": errors, "lines": tuple(of_case["line"])})
        yield quantity, reference, list(dict.fromkeys(group["model"])), pd.DataFrame(rows)


def terminal_tables(
    table: pd.DataFrame, summary: pd.DataFrame, every: bool = False, width: int = WIDTH
) -> Iterator[RenderableType]:
    """Yield the tables of a comparison for a terminal: errors with as many models as fit, and the summary.

    Parameters
    ----------
    table, summary : DataFrame
        As of `comparison_table` and `comparisons.output.error_summary.error_summary`.
    every : bool
        Whether all cases are shown; else the first `_ROWS`.
    width : int
        Columns of the terminal.
    """
    for quantity, reference, models, rows in by_case(table):
        made = table_of("cases", "", case_columns(reference, models), rows if every else rows.head(_ROWS))
        texts = made.on_paper()
        title = f"{quantity}: kappa in percent (uncertainty) against {reference}"
        more = "" if len(texts) == len(rows) else f", first {len(texts)} of {len(rows)} cases"
        fixed = [name for name in texts if name not in models]
        for block in _blocks(texts, fixed, width):
            yield rich_table(texts[[*fixed, *block]], title + more)
            title = f"{quantity}: other models"
    for quantity, group in summary.groupby("quantity", sort=False):
        columns = [
            SUMMARY[0],
            *([words("reference", "reference")] if group["reference"].nunique() > 1 else ()),
            *SUMMARY[1:],
        ]
        yield rich_table(
            texts_of(columns, group), f"{quantity}: coverage, largest and root mean square kappa in percent"
        )


def _blocks(texts: pd.DataFrame, fixed: Sequence[str], width: int) -> list[list[str]]:
    """Return the models in groups for which a line has room beside the case and the reference."""
    widths = {name: _GAP + max(map(len, [name, *texts[name]])) for name in texts}
    blocks: list[list[str]] = [[]]
    for name in texts.columns.drop(list(fixed)):
        if blocks[-1] and sum(widths[one] for one in (*fixed, *blocks[-1], name)) > width + _GAP:
            blocks.append([])
        blocks[-1].append(name)
    return blocks
