"""Summary of a run and of a sweep for the terminal: how the computations ended, and the largest errors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import pandas as pd
from rich.console import RenderableType

from comparisons.numerics.number_text import exact
from comparisons.output.gate_sentence import counted
from comparisons.output.table import Cell, Column, numbers, percents, short_percent, texts_of, values, words
from comparisons.output.tables import worst_rows
from comparisons.output.terminal import rich_table
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
]

_MODEL, _QUANTITY, _PROBLEM = (words(name, name) for name in ("model", "quantity", "problem"))
_CASE = tuple(numbers(name, name, ".4g") for name in ("n", "k", "mu"))
_LARGEST = percents("largest", "kappa", "u_kappa")
_SHORT = Column("largest", cell=lambda row: Cell(short_percent(row["kappa"], row["u_kappa"])))

#: Values of n for which a line has room beside the models, and its columns.
_SHAPES, _WIDTH = 4, 80

#: Lines of a table that are no rows: title, columns and rule.
_FRAME = 3

#: Rows of the tables of a sweep, which have 30 lines at most.
_MODELS, _ERRORS = 7, 10

#: Failures that are written one by one.
_FAILURES = 3

#: Verdict on a number of the paper -> its verb where it is said of several.
_SEVERAL = {"agrees": "agree", "differs": "differ"}


def largest_table(maxima: pd.DataFrame, width: int, lines: int) -> RenderableType | None:
    """Return the largest abs(kappa) of each model, for each n if these are few and there are lines for them.

    Parameters
    ----------
    maxima : DataFrame
        As of `comparisons.output.tables.largest`.
    width, lines : int
        Columns of the terminal, and how many lines there are for the table.

    Returns
    -------
    RenderableType or None
        One column for each n, with k and mu below each error; or one row for each model with the largest over all n,
        the first ones and their number if the lines are too few.  None if there is no kappa.
    """
    if maxima.empty:
        return None
    several = maxima["quantity"].nunique() > 1
    series = ["quantity", "model"] if several else ["model"]
    lead = "" if several else f"{maxima['quantity'].iloc[0]}: "
    worst = worst_rows(maxima, series)
    by_shape = width >= _WIDTH and not several and maxima["n"].nunique() <= _SHAPES
    if by_shape and _FRAME + 2 * len(worst) <= lines:
        return rich_table(_by_shape(maxima), f"{lead}largest abs(kappa) in percent for each n; below it k and mu")
    most = max(lines - _FRAME, 1)
    first = "" if len(worst) <= most else f"the first {most} of {len(worst)} rows; "
    title = f"{lead}largest abs(kappa) in percent over all n ({first}--verbose prints every n)"
    columns = (*([_QUANTITY] if several else []), _MODEL, _SHORT, *_CASE)
    return rich_table(texts_of(columns, worst.head(most)), title)


def _by_shape(maxima: pd.DataFrame) -> pd.DataFrame:
    worst = worst_rows(maxima, ["model", "n"])
    places = [
        f"{short_percent(row['kappa'], row['u_kappa'])}\n{exact(row['k'])}, {row['mu']:.4g}"
        for row in worst.to_dict("records")
    ]
    wide = worst.assign(shown=places).pivot(index="model", columns="n", values="shown").fillna("")
    wide.columns = pd.Index([f"n = {exact(n)}" for n in wide.columns])
    return wide.reset_index()


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
    return [_first(counts.reset_index(), _MODELS, "computations"), *([largest_errors(kappa)] if len(kappa) else [])]


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
    worst = worst_rows(kappa, ["quantity", "model"])
    columns = [_QUANTITY, _MODEL, *(one for one in _CASE if worst[one.label].notna().any()), _LARGEST]
    texts = texts_of([*columns, *([_PROBLEM] if "problem" in worst else [])], worst)
    return _first(texts, _ERRORS, "largest abs(kappa) in percent")


def _first(table: pd.DataFrame, rows: int, title: str) -> RenderableType:
    """Return the first rows of a table; the title tells how many there are."""
    if len(table) > rows:
        title += f" (the first {rows} of {len(table)} rows)"
    return rich_table(table.head(rows), title)


def every_error(results: pd.DataFrame, kappa: pd.DataFrame, maxima: pd.DataFrame) -> Iterator[RenderableType]:
    """Yield the errors in every case, the failed computations, and the largest errors beside those of the paper.

    Parameters
    ----------
    results, kappa, maxima : DataFrame
        As `comparisons.pipeline.tables.RunTables` has them.
    """
    case = [*_CASE, *([_PROBLEM] if "problem" in kappa else [])]
    reference, error = values("reference", "reference_value", "u_reference"), _signed("kappa", 3)
    for names, rows in kappa.groupby(["quantity", "reference"]):
        title = f"{names[0]} of {names[1]} with its u_num, and kappa of each model in percent"
        yield rich_table(texts_of([_MODEL, *case, reference, error], rows), title)
    failed = results[results["status"] == "failed"]
    if len(failed):
        yield rich_table(texts_of([_MODEL, _QUANTITY, *case, words("reason", "reason")], failed), "failed computations")
    yield rich_table(statuses(results).reset_index(), "computations")
    if len(maxima):
        columns = [_QUANTITY, _MODEL, *_CASE, _signed("kappa", 2)]
        yield rich_table(texts_of(columns, maxima), "largest abs(kappa) in percent")
    stated = maxima[maxima["paper_percent"] != ""]
    if len(stated):
        end = Column("at_end", cell=lambda row: Cell("yes" if row["at_end"] else ""))
        columns = [_MODEL, *_CASE, end, percents("kappa", "kappa", "u_kappa")]
        columns += [words("paper_percent", "paper_percent"), words("verdict", "verdict")]
        title = "largest abs(kappa) in percent beside that of the paper (at_end: at an end of the range of mu)"
        yield rich_table(texts_of(columns, stated), title)


def _signed(name: str, decimals: int) -> Column:
    return Column(name, cell=lambda row: Cell(f"{100 * row[name]:+.{decimals}f}"))


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
    others = ("all", "resumed")
    statuses = ", ".join(f"{count} {name}" for name, count in counts.items() if name not in others)
    return f"{counts['all']} results: {statuses}" if statuses else "no results"


def paper_sentence(maxima: pd.DataFrame) -> str:
    """Return how many of the maxima that the paper prints agree; empty if there are none.

    Examples
    --------
    >>> rows = {"k": [0.4] * 3, "paper_percent": ["0.73", "3.5", "5"], "verdict": ["differs", "agrees", "differs"]}
    >>> paper_sentence(pd.DataFrame(rows))
    'the paper prints 3 maxima, for k = 0.4: 1 agrees, 2 differ'
    """
    stated = maxima[maxima["paper_percent"] != ""]
    if stated.empty:
        return ""
    gradients = ", ".join(exact(k) for k in sorted(set(stated["k"])))
    verdicts = sorted(stated["verdict"].value_counts().items())
    listed = ", ".join(counted(count, _said_of_several(verdict), verdict) for verdict, count in verdicts)
    return f"the paper prints {counted(len(stated), 'maxima', 'maximum')}, for k = {gradients}: {listed}"


def _said_of_several(verdict: str) -> str:
    verb, _, rest = verdict.partition(" ")
    return " ".join([_SEVERAL.get(verb, verb), rest]).rstrip()
