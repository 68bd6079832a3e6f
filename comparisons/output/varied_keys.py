"""Texts of the varied keys and of the values of problem files, in SI with a prefix."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import pandas as pd

from comparisons.output.table import Column, Record
from comparisons.problem.units import si_text
from comparisons.runs.case_columns import unit_in

__all__ = ["key_columns", "key_text", "physical_text"]


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


def key_columns(names: Iterable[str]) -> list[Column]:
    """Return the columns of varied keys, by the names of their stored columns."""
    return [Column(key, partial(_key_text, name, unit), name) for name in names for key, unit in (unit_in(name),)]


def _key_text(name: str, unit: str, row: Record) -> str:
    return key_text(row[name], unit)


def physical_text(row: Record) -> str:
    """Return the value of a stored row with its unit, or its status where there is none."""
    if row["status"] != "ok":
        return str(row["status"])
    return si_text(float(row["value"]), float(row["u_num"]), str(row["unit"]))
