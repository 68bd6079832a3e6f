"""Stored results of a run that gates compare, by model, quantity and case."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.judging.gates import Gate
from comparisons.judging.selection import key_of
from comparisons.problem import Problem
from comparisons.runs.case_columns import keys_in
from comparisons.runs.rows import Key

#: Columns of a table of scalars that are judged.
NUMBER = ("status", "reason", "value", "u_num")
#: The same of a table of curves.
CURVE = ("status", "reason", "x", "y", "u_distance")


class UnusableResult(Exception):
    """A result that cannot be judged; holds the verdict it leads to and why."""

    def __init__(self, verdict: Verdict, reason: str) -> None:
        super().__init__(reason)
        self.verdict, self.reason = verdict, reason


def rows_by_key(
    table: pd.DataFrame | None, columns: Iterable[str], gates: Iterable[Gate]
) -> dict[Key, list[dict[str, Any]]]:
    """Return the rows of a table that some gates compare, by their keys: more than one only for the points of a curve.

    Parameters
    ----------
    table : DataFrame or None
        None is a table without rows.
    columns : iterable of str
        `NUMBER` or `CURVE`.
    gates : iterable of Gate
    """
    names = {(model, gate.quantity) for gate in gates for model in gate.models.values()}
    rows: dict[Key, list[dict[str, Any]]] = defaultdict(list)
    if table is None or not names:
        return rows
    needed = table[pd.MultiIndex.from_frame(table[["model", "quantity"]]).isin(list(names))]
    records = needed[list(columns)].to_dict("records")
    for key, record in zip(keys_in(needed), records, strict=True):
        rows[key].append(record)
    return rows


@dataclass(frozen=True, slots=True)
class GateResults:
    """The results of the models of a gate; a role is "candidate", "reference" or "rival"."""

    gate: Gate
    rows: Mapping[Key, list[dict[str, Any]]]

    def status(self, role: str, case: Problem) -> str:
        """Return the status of a result, "missing" without a row."""
        rows = self.rows.get(key_of(self.gate, role, case))
        return str(rows[0]["status"]) if rows else "missing"

    def number(self, role: str, case: Problem) -> tuple[float, float]:
        """Return a value and its u_num.

        Raises
        ------
        UnusableResult
            If there is no such row or more than one, or the two are not finite numbers.
        """
        model, rows = self._usable(role, case)
        if len(rows) > 1:
            raise UnusableResult(Verdict.ERROR, f"{model} has {len(rows)} rows")
        value, u_num = (math.nan if rows[0][name] is None else float(rows[0][name]) for name in ("value", "u_num"))
        if not (math.isfinite(value) and math.isfinite(u_num) and u_num >= 0.0):
            raise UnusableResult(Verdict.ERROR, f"{model} has the value {value:g} +- {u_num:g}")
        return value, u_num

    def points(self, role: str, case: Problem) -> tuple[np.ndarray, np.ndarray, float]:
        """Return the points of a curve and the bound on their distance from it.

        Raises
        ------
        UnusableResult
            If there is no such curve, or it has no finite bound.
        """
        model, rows = self._usable(role, case)
        table = pd.DataFrame(rows)
        u = float(table["u_distance"].max(skipna=False))
        if not (math.isfinite(u) and u >= 0.0):
            raise UnusableResult(Verdict.ERROR, f"{model} states the uncertainty {u:g} of its curve")
        return table["x"].to_numpy(float), table["y"].to_numpy(float), u

    def _usable(self, role: str, case: Problem) -> tuple[str, list[dict[str, Any]]]:
        model, rows = self.gate.models[role], self.rows.get(key_of(self.gate, role, case), [])
        status, reason = (rows[0]["status"], rows[0]["reason"]) if rows else ("missing", "")
        if status == "missing":
            raise UnusableResult(Verdict.ERROR, f"{model} has no row")
        if status == "not-applicable":
            raise UnusableResult(Verdict.NOT_APPLICABLE, f"{model}: {reason}")
        if status != "ok":
            raise UnusableResult(Verdict.ERROR, f"{model}: {status}: {reason}")
        return model, rows
