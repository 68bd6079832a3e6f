"""Stored results of a run, by model, quantity and case."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Collection
from typing import Any

import numpy as np
import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.runs.case_columns import keys_in, with_problem
from comparisons.runs.rows import CASE, Key

__all__ = ["StoredResults", "UnusableResult", "stored_curves", "stored_numbers"]

_KEY = {"model", "quantity", *CASE}


class UnusableResult(Exception):
    """A result that cannot be judged; holds the verdict it leads to and why."""

    def __init__(self, verdict: Verdict, reason: str) -> None:
        super().__init__(reason)
        self.verdict, self.reason = verdict, reason


class StoredResults:
    """The rows of a table of results, by their keys.

    Parameters
    ----------
    table : DataFrame or None
        None is a table without rows.
    needed : set of str
        Columns without which nothing can be judged.
    names : set of (str, str)
        Model and quantity of the rows that are needed; the others are left out.

    Attributes
    ----------
    missing_columns : list of str
    rows : dict
        Key -> rows, more than one only for the points of a curve.
    """

    def __init__(self, table: pd.DataFrame | None, needed: set[str], names: Collection[tuple[str, str]]) -> None:
        table = with_problem(pd.DataFrame(columns=sorted(needed)) if table is None else table)
        self.missing_columns = sorted(needed - set(table.columns))
        self.rows: dict[Key, list[dict[str, Any]]] = defaultdict(list)
        if self.missing_columns or not names:
            return
        needed_rows = table[pd.MultiIndex.from_frame(table[["model", "quantity"]]).isin(list(names))]
        records = needed_rows[sorted(needed)].to_dict("records")
        for key, record in zip(keys_in(needed_rows), records, strict=True):
            self.rows[key].append(record)

    def status(self, key: Key) -> str:
        """Return the status of a result, "missing" without a row."""
        rows = self.rows.get(key, [])
        return str(rows[0]["status"]) if rows else "missing"

    def number(self, key: Key) -> tuple[float, float]:
        """Return a value and its u_num.

        Raises
        ------
        UnusableResult
            If there is no such row or more than one, or the two are not finite numbers.
        """
        rows = self._usable(key)
        if len(rows) > 1:
            raise UnusableResult(Verdict.ERROR, f"{key[0]} has {len(rows)} rows")
        value, u_num = (_real(rows[0][name]) for name in ("value", "u_num"))
        if not (math.isfinite(value) and math.isfinite(u_num) and u_num >= 0.0):
            raise UnusableResult(Verdict.ERROR, f"{key[0]} has the value {value:g} +- {u_num:g}")
        return value, u_num

    def points(self, key: Key) -> tuple[np.ndarray, np.ndarray, float]:
        """Return the points of a curve and the bound on their distance from it.

        Raises
        ------
        UnusableResult
            If there is no such curve, or it has no finite bound.
        """
        table = pd.DataFrame(self._usable(key))
        u = float(table["u_distance"].max(skipna=False))
        if not (math.isfinite(u) and u >= 0.0):
            raise UnusableResult(Verdict.ERROR, f"{key[0]} states the uncertainty {u:g} of its curve")
        return table["x"].to_numpy(float), table["y"].to_numpy(float), u

    def _usable(self, key: Key) -> list[dict[str, Any]]:
        rows = self.rows.get(key, [])
        if not rows:
            raise UnusableResult(Verdict.ERROR, f"{key[0]} has no row")
        row = rows[0]
        if row["status"] == "not-applicable":
            raise UnusableResult(Verdict.NOT_APPLICABLE, f"{key[0]}: {row['reason']}")
        if row["status"] != "ok":
            raise UnusableResult(Verdict.ERROR, f"{key[0]}: {row['status']}: {row['reason']}")
        return rows


def stored_numbers(table: pd.DataFrame, names: Collection[tuple[str, str]]) -> StoredResults:
    """Return the rows of a table of scalars that are of some models and quantities."""
    return StoredResults(table, _KEY | {"value", "u_num", "status", "reason"}, names)


def stored_curves(table: pd.DataFrame | None, names: Collection[tuple[str, str]]) -> StoredResults:
    """Return the points of a table of curves that are of some models and quantities."""
    return StoredResults(table, _KEY | {"x", "y", "u_distance", "status", "reason"}, names)


def _real(value: float | None) -> float:
    return math.nan if value is None else float(value)
