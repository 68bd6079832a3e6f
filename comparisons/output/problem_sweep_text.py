"""Summary of a sweep over a problem file for the terminal: values in SI, and the largest errors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pandas as pd

from comparisons.numerics.number_text import percent_text
from comparisons.output.fitted_table import FittedTable
from comparisons.output.problem_tables import varied_of
from comparisons.problem_file.units import si_text
from comparisons.runs.problem_tasks import ProblemRow

__all__ = ["key_text", "problem_failure_lines", "problem_summary", "unit_in"]

#: Rows of a quantity, and of the errors; the tables in the folder have all.
_MOST = 24

#: Failures that are written one by one.
_FAILURES = 3


def problem_summary(table: pd.DataFrame, errors: pd.DataFrame) -> list[FittedTable]:
    r"""Return a table for each quantity, and one of the largest error of each model.

    Parameters
    ----------
    table, errors : DataFrame
        As of `comparisons.output.problem_tables`.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "punch.R [m]": 1e-7, "value": 2e-8, "u_num": 1.54e-15}
    >>> (shown,) = problem_summary(pd.DataFrame([row | {"unit": "N", "status": "ok"}]), pd.DataFrame())
    >>> print("\n".join(shown.lines(80)))
    punch.R  model  pull_off_force
    ─────────────────────────────────
    100 nm   fscm   20.0000000(16) nN
    """
    tables = []
    for quantity, rows in table.groupby("quantity", sort=False):
        cells = [
            {**_keys(row, varied_of(table)), "model": row["model"], str(quantity): _value(row)}
            for row in rows.head(_MOST).to_dict("records")
        ]
        tables.append(FittedTable(pd.DataFrame(cells, dtype=object), _title("", len(rows)), group="model"))
    if len(errors):
        worst = errors.loc[errors["kappa"].abs().groupby([errors["quantity"], errors["model"]]).idxmax()]
        cells = [
            {
                "quantity": row["quantity"],
                "model": row["model"],
                **_keys(row, varied_of(errors)),
                "largest": percent_text(row["kappa"], row["u_kappa"]),
            }
            for row in worst.head(_MOST).to_dict("records")
        ]
        title = _title(f"largest error against {errors['reference'].iloc[0]} in percent", len(worst))
        tables.append(FittedTable(pd.DataFrame(cells, dtype=object), title, group="quantity"))
    return tables


def problem_failure_lines(failures: Sequence[ProblemRow]) -> Iterator[str]:
    """Yield a sentence for each of the first failures, and one for the others.

    Examples
    --------
    >>> keys = {"punch.R [m]": 1e-7}
    >>> row = ProblemRow("fem", "1", "pull_off_force", keys, "ab", None, None, "N", "failed", "lost", 1.0)
    >>> list(problem_failure_lines([row]))
    ['fem: pull_off_force at punch.R = 100 nm failed: lost']
    """
    for row in failures[:_FAILURES]:
        where = ", ".join(f"{key} = {text}" for key, text in _keys(row.parameters, list(row.parameters)).items())
        yield f"{row.model}: {row.quantity} at {where} failed: {row.reason}"
    if len(failures) > _FAILURES:
        yield f"{len(failures) - _FAILURES} more computations failed; results.csv has their reasons"


def unit_in(column: str) -> tuple[str, str]:
    """Return the key and the unit in SI of the column of a varied key.

    Examples
    --------
    >>> unit_in("punch.R [m]"), unit_in("solid.nu")
    (('punch.R', 'm'), ('solid.nu', '1'))
    """
    key, _, unit = column.removesuffix("]").partition(" [")
    return key, unit or "1"


def key_text(value: float | str, unit: str) -> str:
    """Return the value of a varied key; a power of a unit has no prefix.

    Examples
    --------
    >>> key_text(0.05, "J/m^2"), key_text(1e-12, "m^2"), key_text("tip.csv", "1")
    ('50 mJ/m^2', '1e-12 m^2', 'tip.csv')
    """
    if isinstance(value, str):
        return value
    rounded = float(f"{value:.6g}")
    return f"{rounded:g} {unit}" if "^" in unit.partition("/")[0] else si_text(rounded, 0.0, unit)


def _keys(row: dict[str, float | str], varied: Sequence[str]) -> dict[str, str]:
    return {key: key_text(row[name], unit) for name in varied for key, unit in (unit_in(name),)}


def _value(row: dict[str, float | str]) -> str:
    if row["status"] != "ok":
        return str(row["status"])
    return si_text(float(row["value"]), float(row["u_num"]), str(row["unit"]))


def _title(text: str, rows: int) -> str:
    shown = f"the first {_MOST} of {rows} rows; the CSV file has all" if rows > _MOST else ""
    return f"{text} ({shown})" if text and shown else text or shown
