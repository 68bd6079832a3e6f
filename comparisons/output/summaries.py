"""Tables of errors for terminal, notebook and page: those of a comparison, and what a run and a sweep print."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

import pandas as pd
from rich.console import RenderableType

from comparisons.numerics.number_text import SHORT_PERCENT, percent_text, short
from comparisons.output.errors import worst_rows
from comparisons.output.table import (
    CASE,
    Column,
    Record,
    Table,
    columns,
    key_columns,
    laid_out,
    physical_text,
)
from comparisons.output.terminal import rich_table
from comparisons.problem.units import si_text
from comparisons.quantities import QUANTITIES, title_of
from comparisons.runs import rows as stored_rows
from comparisons.runs.frames import varied_keys, varied_of, with_problem

#: Columns of the tables where no terminal states its own; rows that a terminal shows; spaces between columns.
WIDTH, _ROWS, _GAP = 80, 40, 2

#: The last digit of the reference, relative to it if it is below 1, where its uncertainty does not reach that far.
_LAST_REFERENCE = 1e-7

#: Statuses in words, and the counts that are of no status.
_ENDS = {"ok": "with a value", "not-applicable": "not-applicable (a case or a quantity that the model does not have)"}
_NO_ENDS = ("all", "resumed")

#: Failures that are written one by one.
_FAILURES = 3


def _error_text(model: str, row: Record) -> str:
    """Return kappa in percent, or the reason why there is none in a word or two; nothing without an evaluation."""
    status, kappa = row[f"status {model}"], row[f"kappa {model}"]
    if status != "ok":
        return "n/a" if status == "not-applicable" else "" if pd.isna(status) else str(status)
    return "no reference" if pd.isna(kappa) else percent_text(kappa, row[f"u_kappa {model}"], SHORT_PERCENT)


def _reference_text(row: Record) -> str:
    """Return the value of the reference to seven decimals, or digits, at most."""
    value, u = row["reference_value"], row["u_reference"]
    if pd.isna(value):
        return "none"
    last = _LAST_REFERENCE * min(abs(value), 1.0)
    return si_text(value, u, QUANTITIES[row["quantity"]].si_unit, last) if row["problem"] else short(value, u, last)


def case_tables(table: pd.DataFrame) -> Iterator[Table]:
    """Yield a table for each quantity and reference: one row for each case, with kappa of each model in percent.

    Parameters
    ----------
    table : DataFrame
        As of `comparisons.output.errors.comparison_table`.
    """
    for (quantity, reference), group in with_problem(table).groupby(["quantity", "reference"], sort=False):
        group = group.assign(case=group.groupby([*stored_rows.CASE], sort=False, dropna=False).ngroup())
        of_models = group.pivot(index="case", columns="model", values=["status", "kappa", "u_kappa"]).infer_objects()
        of_models.columns = pd.Index([" ".join(names) for names in of_models.columns])
        cases = group.drop_duplicates("case").set_index("case")
        keys = varied_keys(cases)
        cases = cases[["quantity", *stored_rows.CASE, *keys, "reference", "reference_value", "u_reference"]]
        of_case = [*columns(*(name for name in CASE if not keys or name != "problem")), *key_columns(keys)]
        models = [
            Column(model, partial(_error_text, model), f"kappa {model}") for model in dict.fromkeys(group["model"])
        ]
        # The numbers of a problem file have their units beside them.
        unit = "1" if (cases["problem"] != "").any() else QUANTITIES[quantity].unit
        in_unit = "" if unit == "1" else f",\n{reference} in {unit}"
        yield Table(
            f"cases-{quantity}-{reference}",
            f"{title_of(quantity)}: kappa in percent (bound) against {reference}{in_unit}",
            [*of_case, Column(str(reference), _reference_text, "reference_value"), *models],
            cases.join(of_models),
        )


def refusal_lines(table: pd.DataFrame) -> Iterator[str]:
    """Yield for each model without a value in some cases their number and the first reason.

    Parameters
    ----------
    table : DataFrame
        As of `comparisons.output.errors.comparison_table`.

    Examples
    --------
    >>> row = {"model": "jkr", "quantity": "pull_off_force", "status": "not-applicable", "reason": "no power law"}
    >>> [*refusal_lines(pd.DataFrame([row, row | {"status": "ok"}]))]
    ['jkr, pull-off force: n/a in 1 of 2 cases: no power law']
    """
    for (model, quantity), rows in table.groupby(["model", "quantity"], sort=False):
        refused = rows[rows["status"] == "not-applicable"]
        if len(refused):
            where = f"n/a in {len(refused)} of {len(rows)} cases"
            yield f"{model}, {title_of(quantity)}: {where}: {refused['reason'].iloc[0]}"


def summary_tables(summary: pd.DataFrame) -> Iterator[Table]:
    """Yield a table for each quantity and reference: in how many cases a model has a value, and its errors in percent.

    Parameters
    ----------
    summary : DataFrame
        As of `comparisons.output.errors.error_summary`.
    """
    layout = columns("model", "coverage", "worst κ (%)", *CASE, "rms κ (%)")
    for (quantity, reference), group in summary.groupby(["quantity", "reference"], sort=False):
        caption = f"{title_of(quantity)}: coverage, worst and root mean square kappa, against {reference}"
        yield Table(f"summary-{quantity}-{reference}", caption, layout, group)


def terminal_tables(
    table: pd.DataFrame, summary: pd.DataFrame, every: bool = False, width: int = WIDTH
) -> Iterator[RenderableType]:
    """Yield the tables of a comparison for a terminal: errors with as many models as fit, and the summary.

    Parameters
    ----------
    table, summary : DataFrame
        As of `comparisons.output.errors`: `comparison_table` and `error_summary`.
    every : bool
        Whether all cases are shown; else the first `_ROWS`.
    width : int
        Columns of the terminal.
    """
    for cases in case_tables(table):
        beginning = cases if every else replace(cases, stored=cases.stored.head(_ROWS))
        count = len(cases.stored)
        limit = "" if len(beginning.stored) == count else f", first {_ROWS} of {count} cases"
        for texts in side_by_side(beginning, width):
            yield rich_table(texts, cases.caption + limit)
    for of_quantity in summary_tables(summary):
        yield rich_table(of_quantity.texts, of_quantity.caption)


def side_by_side(cases: Table, width: int) -> Iterator[pd.DataFrame]:
    """Yield the texts of a table of `case_tables` for as many models each time as fit a line of so many characters."""
    models = [column.heading for column in cases.columns if column.number.startswith("kappa ")]
    fixed = [name for name in cases.texts if name not in models]
    widths = {name: _GAP + max(map(len, [name, *cases.texts[name]])) for name in cases.texts}
    free = width + _GAP - sum(widths[name] for name in fixed)
    beside = [models[0]]
    for model in models[1:]:
        if sum(widths[name] for name in [*beside, model]) > free:
            yield cases.texts[[*fixed, *beside]]
            beside = []
        beside.append(model)
    yield cases.texts[[*fixed, *beside]]


def _printed(table: Table) -> RenderableType:
    """Return the first rows of a table; the title tells how many there are."""
    count = len(table.stored)
    more = f" (the first {_ROWS} of {count} rows)" if count > _ROWS else ""
    return rich_table(replace(table, stored=table.stored.head(_ROWS)).texts, table.caption + more)


def largest_errors(kappa: pd.DataFrame) -> Iterator[RenderableType]:
    """Yield a table for each reference: the largest relative error of each model and quantity, and its case."""
    for reference, rows in kappa.groupby("reference", sort=False) if len(kappa) else ():
        table = laid_out("largest_on_screen", worst_rows(rows, ["quantity", "model"]))
        yield _printed(replace(table, caption=f"{table.caption} against {reference}"))


def sweep_tables(results: pd.DataFrame, kappa: pd.DataFrame) -> Iterator[RenderableType]:
    r"""Yield the tables of a sweep: values of problem files, and the largest errors.

    Parameters
    ----------
    results, kappa : DataFrame
        As `comparisons.pipeline.tables.RunTables` has them.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "problem": "pad.toml; punch.R=100 nm"}
    >>> value = {"punch.R [m]": 1e-7, "value": 2e-8, "u_num": 1.54e-15, "unit": "N", "status": "ok"}
    >>> (values,) = sweep_tables(pd.DataFrame([row | value]), pd.DataFrame())
    >>> from rich import print
    >>> print(values)  # doctest: +NORMALIZE_WHITESPACE
    values
    punch.R  model  pull_off_force
    ─────────────────────────────────
    100 nm   fscm   20.0000000(16) nN
    """
    of_files = results[with_problem(results)["problem"] != ""]
    keys = [name for name in varied_of(of_files) if of_files[name].notna().any()]
    for quantity, rows in of_files.groupby("quantity", sort=False):
        layout = [*(key_columns(keys) or columns("problem")), *columns("model"), Column(str(quantity), physical_text)]
        yield _printed(Table("", "values", layout, rows))
    yield from largest_errors(kappa)


def failure_lines(failures: Sequence[stored_rows.Row]) -> Iterator[str]:
    """Yield a sentence for each of the first failures, and one for the others."""
    for row in failures[:_FAILURES]:
        yield f"{row.model}: {row.quantity} at {row.label}: {row.reason}"
    if len(failures) > _FAILURES:
        yield f"{len(failures) - _FAILURES} more computations failed; the tables have their reasons"


def computations_sentence(counts: Mapping[str, int]) -> str:
    """Return how many computations ended with which status.

    Examples
    --------
    >>> computations_sentence({"all": 12, "resumed": 0, "ok": 7, "failed": 1, "not-applicable": 4})
    '12 results: 7 with a value, 1 failed, 4 not-applicable (a case or a quantity that the model does not have)'
    """
    ended = ", ".join(f"{count} {_ENDS.get(name, name)}" for name, count in counts.items() if name not in _NO_ENDS)
    return f"{counts['all']} results: {ended}" if ended else "no results"
