"""Errors of candidates in the stored results of a run, in the unit of the metric of a gate."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.judging.gates import Gate
from comparisons.judging.selection import key_of
from comparisons.numerics.bounds import combined
from comparisons.problem import Problem
from comparisons.runs.frames import keys_in
from comparisons.runs.rows import Key

#: Columns that are judged: of a table of numbers, of a table of curves.
_COLUMNS = ("status", "reason", "value", "u_num", "x", "y", "u_distance")


class UnusableResult(Exception):
    """A result that cannot be judged; holds the verdict it leads to and why."""

    def __init__(self, verdict: Verdict, reason: str) -> None:
        super().__init__(reason)
        self.verdict, self.reason = verdict, reason


def rows_by_key(tables: Iterable[pd.DataFrame], gates: Iterable[Gate]) -> dict[Key, list[dict[str, Any]]]:
    """Return the rows of tables that some gates compare, by their keys: several only for the points of a curve."""
    names = {(model, gate.quantity) for gate in gates for model in gate.models.values()}
    rows: dict[Key, list[dict[str, Any]]] = defaultdict(list)
    for table in tables:
        is_compared = [pair in names for pair in zip(table["model"], table["quantity"], strict=True)]
        compared = table.loc[is_compared]
        records = compared[compared.columns.intersection(_COLUMNS)].to_dict("records")
        for key, record in zip(keys_in(compared), records, strict=True):
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
        model, rows = self.gate.models[role], self.rows.get(key_of(self.gate, role, case))
        if not rows:
            raise UnusableResult(Verdict.ERROR, f"{model} has no row")
        status, reason = rows[0]["status"], rows[0]["reason"]
        if status == "not-applicable":
            raise UnusableResult(Verdict.NOT_APPLICABLE, f"{model}: {reason}")
        if status != "ok":
            raise UnusableResult(Verdict.ERROR, f"{model}: {status}: {reason}")
        return model, rows


@dataclass(frozen=True, slots=True)
class CaseError:
    """The error of a candidate in one case, in the unit of the metric.

    Attributes
    ----------
    error, uncertainty : float
        E and its bound U.
    bounds : dict
        The uncertainties of candidate and reference that the gate limits.
    shares : dict
        The parts of U of the candidate, the reference and the rival.
    facts : dict
        Value and u_num of both sides, in the unit of the quantity.
    """

    error: float
    uncertainty: float
    bounds: dict[str, float]
    facts: dict[str, Any]
    shares: dict[str, float] = field(default_factory=dict)


def case_error(results: GateResults, case: Problem, scale: float) -> CaseError:
    """Return the error of the gate's candidate in a case.

    Parameters
    ----------
    results : GateResults
        Of curves for the metric "curve", otherwise of scalars.
    case : Problem
    scale : float
        The range of the reference over the cases (`reference_range`).

    Raises
    ------
    UnusableResult
        If a result is missing, or has no error in this metric.
    """
    gate = results.gate
    if gate.metric == "curve":
        return _distance(results, case)
    # The candidate first: where it has no value, the reference needs none, and a run does not compute it.
    value, u_num = results.number("candidate", case)
    reference, u_reference = results.number("reference", case)
    facts = {"value": value, "u_num": u_num, "reference_value": reference, "u_reference": u_reference}
    unit = {"abs": 1.0, "range-relative": scale}.get(gate.metric, abs(reference))
    # E_n is the difference in units of the bound U, so that it has no bound of its own.
    divisor = combined(u_num, u_reference) if gate.metric == "en" else unit
    if unit == 0.0 or divisor == 0.0:
        raise UnusableResult(Verdict.ERROR, "the reference, its range, or both uncertainties are zero: use metric abs")
    error, bounds = (value - reference) / divisor, {"candidate": u_num / unit, "reference": u_reference / unit}
    if gate.metric == "en":
        return CaseError(error, 0.0, bounds, facts)

    def share(value: float) -> float:
        """The part of the reference in the bound: it is also the unit of a relative error."""
        return (abs(value / reference) if gate.metric == "rel" else 1.0) * u_reference / unit

    shares = {"candidate": u_num / unit, "reference": share(value)}
    if gate.rival:
        rival, u_rival = results.number("rival", case)
        error = abs(error) - abs((rival - reference) / unit)
        shares |= {"reference": share(value) + share(rival), "rival": u_rival / unit}
    return CaseError(error, combined(*shares.values()), bounds, facts, shares)


def reference_range(results: GateResults, cases: Iterable[Problem]) -> float:
    """Return the range of the reference over the cases; 0 where it has none or the metric needs none."""
    values = []
    for case in cases if results.gate.metric == "range-relative" else []:
        try:
            values.append(results.number("reference", case)[0])
        except UnusableResult:
            continue
    return max(values) - min(values) if values else 0.0


def _distance(results: GateResults, case: Problem) -> CaseError:
    # Gates of numbers do not wait for SciPy's interpolation.
    from comparisons.numerics.curve_distance import curve_distance

    x, y, u_candidate = results.points("candidate", case)
    *reference, u_points = results.points("reference", case)
    try:
        distance = curve_distance(x, y, *reference)
    except ValueError as error:
        raise UnusableResult(Verdict.ERROR, str(error)) from error
    u_reference = u_points + distance.u_interpolation
    shares = {"candidate": u_candidate, "reference": u_reference}
    facts = {"u_num": u_candidate, "u_reference": u_reference}
    return CaseError(distance.value, combined(u_candidate, u_reference), shares, facts, shares)
