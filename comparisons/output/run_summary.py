"""Summary of a run and of a sweep for the terminal: how the computations ended, values and the largest errors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import pandas as pd
from rich.console import RenderableType

from comparisons.numerics.number_text import exact
from comparisons.output.errors import worst_rows
from comparisons.output.gate_sentence import counted
from comparisons.output.table import Column, Table, numbers, percents, short_percent, values, words
from comparisons.output.terminal import rich_table
from comparisons.output.varied_keys import key_columns, physical_text
from comparisons.runs.case_columns import varied_of
from comparisons.runs.rows import Row

__all__ = [
    "computations_sentence",
    "every_error",
    "failure_lines",
    "largest_errors",
    "largest_table",
    "paper_sentence",
    "statuses",
    "summary_tables",
    "values_of_problems",
]

_MODEL, _QUANTITY, _PROBLEM, _REASON = (words(name, name) for name in ("model", "quantity", "problem", "reason"))
_CASE = (*(numbers(name, name, ".4g") for name in ("n", "k", "mu")), _PROBLEM)
_SHORT = Column("largest", lambda row: short_percent(row["kappa"], row["u_kappa"]))

#: Values of n for which a line has room beside the models; rows of a table that summarises.
_SHAPES, _MOST = 4, 24

#: Failures that are written one by one.
_FAILURES = 3

#: Verdict on a number of the paper -> its verb where it is said of several.
_SEVERAL = {"agrees": "agree", "differs": "differ"}


def _shown(columns: Sequence[Column], rows: pd.DataFrame, title: str, most: int | None = _MOST) -> RenderableType:
    """Return a table of the first rows; the title tells how many there are."""
    more = f" (the first {most} of {len(rows)} rows)" if most and len(rows) > most else ""
    return rich_table(Table("", title, columns, rows.head(most or len(rows))).texts, title + more)


def largest_table(maxima: pd.DataFrame) -> RenderableType | None:
    """Return the largest abs(kappa) of each model, for each n if these are few; None if there is no kappa.

    Parameters
    ----------
    maxima : DataFrame
        As of `comparisons.output.errors.largest`.
    """
    if maxima.empty:
        return None
    if maxima["quantity"].nunique() > 1 or maxima["n"].nunique() > _SHAPES:
        columns = (_QUANTITY, _MODEL, _SHORT, *_CASE)
        title = "largest abs(kappa) in percent over all n (--verbose prints every n)"
        return _shown(columns, worst_rows(maxima, ["quantity", "model"]), title)
    worst = worst_rows(maxima, ["model", "n"])
    cells = [f"{_SHORT.text(row)}\n{exact(row['k'])}, {row['mu']:.4g}" for row in worst.to_dict("records")]
    wide = worst.assign(cell=cells).pivot(index="model", columns="n", values="cell").fillna("")
    wide.columns = pd.Index([f"n = {exact(n)}" for n in wide.columns])
    title = f"{maxima['quantity'].iloc[0]}: largest abs(kappa) in percent for each n; below it k and mu"
    return rich_table(wide.reset_index(), title)


def summary_tables(results: pd.DataFrame, curves: pd.DataFrame, kappa: pd.DataFrame) -> list[RenderableType]:
    """Return the tables of a sweep: how the computations ended, and the largest error of each quantity and model.

    Parameters
    ----------
    results, curves, kappa : DataFrame
        As `comparisons.pipeline.tables.RunTables` has them.
    """
    # A curve has a row for each point.
    whole = curves[curves["point"] == 0] if "point" in curves else curves
    tables = [table[["model", "status", "seconds"]] for table in (results, whole)]
    # Not one without rows: older versions of pandas warn that its types will count.
    rows = pd.concat([table for table in tables if len(table)] or tables)
    counts = statuses(rows).assign(seconds=rows.groupby("model")["seconds"].sum().round(1))
    return [rich_table(counts.reset_index(), "computations"), *([largest_errors(kappa)] if len(kappa) else [])]


def statuses(rows: pd.DataFrame) -> pd.DataFrame:
    """Return how many rows of each model ended with each status.

    Examples
    --------
    >>> statuses(pd.DataFrame({"model": ["jkr", "jkr"], "status": ["ok", "failed"]})).values.tolist()
    [[1, 0, 1]]
    """
    counts = rows.groupby(["model", "status"]).size().unstack(fill_value=0)
    return counts.reindex(columns=["ok", "not-applicable", "failed"], fill_value=0).rename_axis(columns=None)


def largest_errors(kappa: pd.DataFrame) -> RenderableType:
    """Return the largest relative error of each model and quantity, in percent, and its case."""
    columns = [_QUANTITY, _MODEL, *_CASE[:-1], percents("largest", "kappa", "u_kappa"), _PROBLEM]
    return _shown(columns, worst_rows(kappa, ["quantity", "model"]), "largest abs(kappa) in percent")


def values_of_problems(results: pd.DataFrame) -> Iterator[RenderableType]:
    r"""Yield a table of values in SI for each quantity; none where no case is of a problem file.

    Parameters
    ----------
    results : DataFrame
        As of `comparisons.runs.frames.frame`.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "problem": "pad.toml; punch.R=100 nm"}
    >>> value = {"punch.R [m]": 1e-7, "value": 2e-8, "u_num": 1.54e-15, "unit": "N", "status": "ok"}
    >>> (table,) = values_of_problems(pd.DataFrame([row | value]))
    >>> from rich import print
    >>> print(table)  # doctest: +NORMALIZE_WHITESPACE
    values
    punch.R  model  pull_off_force
    ─────────────────────────────────
    100 nm   fscm   20.0000000(16) nN
    """
    of_files = results[results["problem"] != ""] if "problem" in results else results.head(0)
    keys = [name for name in varied_of(of_files) if of_files[name].notna().any()]
    for quantity, rows in of_files.groupby("quantity", sort=False):
        columns = [*(key_columns(keys) or [_PROBLEM]), _MODEL, Column(str(quantity), physical_text)]
        yield _shown(columns, rows, "values")


def every_error(results: pd.DataFrame, kappa: pd.DataFrame, maxima: pd.DataFrame) -> Iterator[RenderableType]:
    """Yield the errors in every case, the failed computations, and the largest errors beside those of the paper.

    Parameters
    ----------
    results, kappa, maxima : DataFrame
        As `comparisons.pipeline.tables.RunTables` has them.
    """
    error = Column("kappa", lambda row: f"{100 * row['kappa']:+.3f}")
    for (quantity, reference), rows in kappa.groupby(["quantity", "reference"]):
        title = f"{quantity} of {reference} with its u_num, and kappa of each model in percent"
        yield _shown([_MODEL, *_CASE, values("reference", "reference_value", "u_reference"), error], rows, title, None)
    failed = results[results["status"] == "failed"]
    if len(failed):
        yield _shown([_MODEL, _QUANTITY, *_CASE, _REASON], failed, "failed computations", None)
    yield rich_table(statuses(results).reset_index(), "computations")
    paper = words("paper_percent", "paper_percent"), words("verdict", "verdict")
    end = Column("at_end", lambda row: "yes" if row["at_end"] else "")
    for quantity, rows in maxima.groupby("quantity"):
        title = f"{quantity}: largest abs(kappa) in percent, and that of the paper (at_end: of the range of mu)"
        yield _shown([_MODEL, *_CASE, end, percents("kappa", "kappa", "u_kappa"), *paper], rows, title, None)


def failure_lines(failures: Sequence[Row]) -> Iterator[str]:
    """Yield a sentence for each of the first failures, and one for the others.

    Examples
    --------
    >>> list(failure_lines([]))
    []
    """
    for row in failures[:_FAILURES]:
        yield f"{row.model}: {row.quantity} at {row.label}: {row.reason}"
    if len(failures) > _FAILURES:
        yield f"{len(failures) - _FAILURES} more computations failed; the tables have their reasons"


def computations_sentence(counts: Mapping[str, int]) -> str:
    """Return how many computations ended with which status.

    Examples
    --------
    >>> computations_sentence({"all": 12, "resumed": 0, "ok": 8, "not-applicable": 4})
    '12 results: 8 ok, 4 not-applicable'
    """
    ended = ", ".join(f"{count} {name}" for name, count in counts.items() if name not in ("all", "resumed"))
    return f"{counts['all']} results: {ended}" if ended else "no results"


def paper_sentence(maxima: pd.DataFrame) -> str:
    """Return how many of the maxima that the paper prints agree; empty if there are none.

    Examples
    --------
    >>> rows = {"k": [0.4] * 3, "paper_percent": ["0.73", "3.5", "5"], "verdict": ["differs", "agrees", "differs"]}
    >>> paper_sentence(pd.DataFrame(rows))
    'the paper prints 3 maxima, for k = 0.4: 1 agrees, 2 differ'
    """
    printed = maxima[maxima["paper_percent"] != ""]
    if printed.empty:
        return ""
    gradients = ", ".join(exact(k) for k in sorted(set(printed["k"])))
    verdicts = []
    for verdict, count in sorted(printed["verdict"].value_counts().items()):
        verb, *rest = verdict.split(" ", 1)
        verdicts.append(counted(count, " ".join([_SEVERAL.get(verb, verb), *rest]), verdict))
    return f"the paper prints {counted(len(printed), 'maxima', 'maximum')}, for k = {gradients}: {', '.join(verdicts)}"
