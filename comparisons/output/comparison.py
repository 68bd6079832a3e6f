"""Tables of a comparison: every model against the reference in every case of a grid, and as text for 80 columns."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd

from comparisons.judging.summary import coverage_text
from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.numerics.number_text import exact, value_text
from comparisons.output.fitted_table import FittedTable
from comparisons.runs.case_columns import keys_in, with_problem, without_empty_problem
from comparisons.runs.cases import Grid
from comparisons.runs.rows import CASE, PARAMETERS
from comparisons.runs.tasks import Task, case_for

__all__ = [
    "COLUMNS",
    "WIDTH",
    "comparison_table",
    "error_cell",
    "place_text",
    "reference_cell",
    "terminal_tables",
    "wide",
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

#: The reference is shown to this digit, and an error in percent to that one, or to the digit that its uncertainty
#: leaves it: four models then fit beside the case.
_LEAST_REFERENCE, _LEAST_PERCENT = 5e-7, 5e-3

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
        return stored[Task(model, quantity, case_for(model, case)).key]

    rows: dict[tuple[Any, ...], list[Any]] = {}
    for grid in grids:
        for quantity in grid.quantities:
            for case in grid.cases:
                status, reference, u_reference, why = found(grid.reference, quantity, case)
                parameters = [case.n, case.k, case.mu, np.nan if case.nu is None else case.nu, case.label_of_file]
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


def error_cell(row: pd.Series) -> str:
    """Return kappa of a row in percent, or the reason why there is none in a word or two.

    Examples
    --------
    >>> error_cell(pd.Series({"status": "ok", "kappa": -0.0494, "u_kappa": 1e-9}))
    '-4.940(5)'
    >>> error_cell(pd.Series({"status": "not-applicable", "kappa": np.nan, "u_kappa": np.nan}))
    'n/a'
    """
    if row["status"] != "ok":
        return _WORDS.get(row["status"], str(row["status"]))
    return percent(row["kappa"], row["u_kappa"]) or "no reference"


def percent(kappa: float, u_kappa: float) -> str:
    """Return a relative error in percent, to the digit that fits a table."""
    return value_text(100 * kappa, max(100 * u_kappa, _LEAST_PERCENT))


def reference_cell(value: float, u: float) -> str:
    """Return the value of a reference to seven decimals, or digits, at most; nothing where it has none."""
    return value_text(value, max(u, _LEAST_REFERENCE * min(abs(value), 1.0)))


def place_text(row: pd.Series) -> str:
    """Return the case of a row in short.

    Examples
    --------
    >>> place_text(pd.Series({"n": 2.0, "k": 0.4, "mu": 1.0, "nu": np.nan}))
    'n=2 k=0.4 mu=1'
    """
    return row.get("problem") or " ".join(f"{name}={exact(row[name])}" for name in PARAMETERS if pd.notna(row[name]))


def wide(table: pd.DataFrame) -> Iterator[tuple[str, str, pd.DataFrame]]:
    """Yield the quantity, the reference and a table of texts for each: one row a case, one column a model.

    Parameters
    ----------
    table : DataFrame
        As of `comparison_table`.
    """
    for (quantity, reference), group in with_problem(table).groupby(["quantity", "reference"], sort=False):
        models = list(dict.fromkeys(group["model"]))
        cases = [name for name in CASE if (group[name].notna() & (group[name] != "")).any()]
        rows = []
        for case, of_case in group.groupby([*CASE], sort=False, dropna=False):
            first = of_case.iloc[0]
            texts_of_case = {name: "" if pd.isna(x) else exact(x) for name, x in zip(PARAMETERS, case, strict=False)}
            texts = {name: text for name, text in (texts_of_case | {"problem": case[-1]}).items() if name in cases}
            cells = {row["model"]: error_cell(row) for _, row in of_case.iterrows()}
            shown = reference_cell(first["reference_value"], first["u_reference"]) or "none"
            rows.append([*texts.values(), shown, *(cells.get(model, "") for model in models)])
        yield quantity, reference, pd.DataFrame(rows, columns=[*cases, reference, *models], dtype=object)


def terminal_tables(
    table: pd.DataFrame, summary: pd.DataFrame, every: bool = False, width: int = WIDTH
) -> list[FittedTable]:
    """Return the tables of a comparison for a terminal: errors in blocks of as many models as fit, and the summary.

    Parameters
    ----------
    table, summary : DataFrame
        As of `comparison_table` and `comparisons.output.error_summary.error_summary`.
    every : bool
        Whether all cases are shown; else the first `_ROWS`.
    width : int
        Columns of the terminal.
    """
    shown = [
        block
        for quantity, reference, texts in wide(table)
        for block in _blocks(quantity, reference, texts, every, width)
    ]
    return [*shown, *(_summary(str(quantity), group) for quantity, group in summary.groupby("quantity", sort=False))]


def _blocks(quantity: str, reference: str, texts: pd.DataFrame, every: bool, width: int) -> Iterator[FittedTable]:
    """Yield tables of at most so many columns; each has the case and the reference."""
    fixed = list(texts.columns[: list(texts.columns).index(reference) + 1])
    widths = {
        column: max([len(column), *map(len, texts.iloc[:, place])]) + _GAP for place, column in enumerate(texts.columns)
    }
    room = width + _GAP - sum(widths[column] for column in fixed)
    block: list[str] = []
    title = f"{quantity}: kappa in percent (uncertainty) against {reference}"
    for model in texts.columns[len(fixed) :]:
        if block and sum(widths[column] for column in (*block, model)) > room:
            yield _shown(title, texts[[*fixed, *block]], every)
            block, title = [], f"{quantity}: other models"
        block.append(model)
    yield _shown(title, texts[[*fixed, *block]], every)


def _shown(title: str, texts: pd.DataFrame, every: bool) -> FittedTable:
    rows = texts if every else texts.head(_ROWS)
    if len(rows) < len(texts):
        title += f", first {len(rows)} of {len(texts)} cases"
    return FittedTable(rows, title, frozenset(rows))


def _summary(quantity: str, group: pd.DataFrame) -> FittedTable:
    texts = pd.DataFrame(
        {
            "model": group["model"],
            **({"reference": group["reference"]} if group["reference"].nunique() > 1 else {}),
            "a value in": [coverage_text(row) for _, row in group.iterrows()],
            "largest": [percent(*pair) for pair in zip(group["largest"], group["u_largest"], strict=True)],
            "at": [place_text(row) for _, row in group.iterrows()],
            "rms": [percent(*pair) for pair in zip(group["rms"], group["u"], strict=True)],
        },
        dtype=object,
    )
    title = f"{quantity}: coverage, largest and root mean square kappa in percent"
    return FittedTable(texts, title, frozenset(("a value in", "largest", "rms")))
