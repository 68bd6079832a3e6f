"""Values of problem files as a table for the terminal: one row for each model, quantity and combination of values."""

from __future__ import annotations

from typing import Any

import pandas as pd
from rich.console import RenderableType

from comparisons.output.terminal import rich_table
from comparisons.problem.units import si_text
from comparisons.runs.case_columns import unit_in, varied_of

__all__ = ["key_text", "values_of_problems"]

#: Rows of a quantity; the tables in the folder have all.
_MOST = 24


def values_of_problems(results: pd.DataFrame) -> list[RenderableType]:
    r"""Return a table of values in SI for each quantity; none where no case is of a problem file.

    Parameters
    ----------
    results : DataFrame
        As of `comparisons.runs.frames.frame`.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "problem": "pad.toml; punch.R=100 nm"}
    >>> found = {"punch.R [m]": 1e-7, "value": 2e-8, "u_num": 1.54e-15, "unit": "N", "status": "ok"}
    >>> (shown,) = values_of_problems(pd.DataFrame([row | found]))
    >>> from rich import print
    >>> print(shown)
    values
    punch.R  model  pull_off_force
    ─────────────────────────────────
    100 nm   fscm   20.0000000(16) nN
    """
    if "problem" not in results:
        return []
    of_files = results[results["problem"] != ""]
    varied = [name for name in varied_of(of_files) if of_files[name].notna().any()] or ["problem"]
    tables: list[RenderableType] = []
    for quantity, rows in of_files.groupby("quantity", sort=False):
        cells = [
            {**_keys(row, varied), "model": row["model"], str(quantity): _value(row)}
            for row in rows.head(_MOST).to_dict("records")
        ]
        part = f" (the first {_MOST} of {len(rows)} rows; the CSV file has all)" if len(rows) > _MOST else ""
        tables.append(rich_table(pd.DataFrame(cells, dtype=object), f"values{part}"))
    return tables


def key_text(value: float | str, unit: str) -> str:
    """Return the value of a varied key; a power of a unit has no prefix, and nothing is shown where there is none.

    Examples
    --------
    >>> key_text(0.05, "J/m^2"), key_text(1e-12, "m^2"), key_text("tip.csv", "1")
    ('50 mJ/m^2', '1e-12 m^2', 'tip.csv')
    """
    if isinstance(value, str):
        return value
    if pd.isna(value):
        return ""
    rounded = float(f"{value:.6g}")
    return f"{rounded:g} {unit}" if "^" in unit.partition("/")[0] else si_text(rounded, 0.0, unit)


def _keys(row: dict[Any, Any], varied: list[str]) -> dict[str, str]:
    return {key: key_text(row[name], unit) for name in varied for key, unit in (unit_in(name),)}


def _value(row: dict[Any, Any]) -> str:
    if row["status"] != "ok":
        return str(row["status"])
    return si_text(float(row["value"]), float(row["u_num"]), str(row["unit"]))
