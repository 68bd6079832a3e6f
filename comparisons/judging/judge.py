"""The judge: gates and stored results in, a table of verdicts out; it computes no model.

What is expected in a gate is decided by the cases that were declared, never by the rows that happen to exist,
so that a row that is missing, is there twice or was never asked for is an ERROR and not a smaller sample.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from comparisons.judging.decision import Verdict, combined, crossing, decide, expecting_failure
from comparisons.judging.gates import GIVEN, Gate
from comparisons.numerics.curve_distance import curve_distance
from comparisons.numerics.kappa import relative_difference
from comparisons.numerics.number_text import exact
from comparisons.runs.cases import Case, Grid
from comparisons.runs.tasks import case_for, plan

__all__ = ["Judged", "judge", "relevant", "skipped_gates"]

_NEEDED = {"model", "quantity", "n", "k", "mu", "nu", "value", "u_num", "status", "reason"}
_NEEDED_OF_CURVES = {"model", "quantity", "n", "k", "mu", "nu", "x", "y", "u_distance", "status", "reason"}

#: What to change in a gate that asks a model where it does not apply.
_CURE = 'name the cases it applies to in the gate, e.g. cases = { k = [0, 0] }, or state not_applicable = "leave-out"'

Key = tuple[str, str, float, float, float, float | None]


@dataclass(frozen=True, slots=True)
class Judged:
    """One gate in one case; n, k and mu are None where the gate as a whole could not be judged.

    `error`, `uncertainty`, `lower` and `upper` are in the unit of the gate's metric.
    """

    gate: str
    quantity: str
    candidate: str
    reference: str
    n: float | None
    k: float | None
    mu: float | None
    nu: float | None
    value: float | None
    u_num: float | None
    reference_value: float | None
    u_reference: float | None
    error: float | None
    uncertainty: float | None
    lower: float
    upper: float
    verdict: Verdict
    reason: str


@dataclass(frozen=True, slots=True)
class _Error:
    """The error of a candidate in one case, in the unit of the metric.

    `shares` holds the parts of the uncertainty that the candidate, the reference and the rival have; the gate limits
    `u_candidate` and `u_reference`.
    """

    error: float
    uncertainty: float
    u_candidate: float
    u_reference: float
    shares: dict[str, float]
    facts: dict[str, Any]


class _Unusable(Exception):
    """An answer cannot be judged; holds the verdict it leads to and why."""

    def __init__(self, verdict: Verdict, reason: str) -> None:
        super().__init__(reason)
        self.verdict, self.reason = verdict, reason


def relevant(gates: Iterable[Gate], grids: Sequence[Grid], models: Sequence[str] | None) -> list[Gate]:
    """Return the gates a run can judge, one for each given model where a gate is for all of them.

    Parameters
    ----------
    gates : iterable of Gate
    grids : sequence of Grid
        The cases that are computed.
    models : sequence of str or None
        Models given in place of those each grid names; None for those.
    """
    chosen: list[Gate] = []
    for gate in gates:
        if gate.candidate == GIVEN:
            # A model is compared with itself neither as the rival nor, in the same cases, as the reference.
            others = {gate.rival} if gate.reference_at else {gate.rival, gate.reference}
            chosen += [replace(gate, candidate=name) for name in models or () if name not in others]
        elif models is None or (gate.candidate in models and not _not_computed(gate, grids, models)):
            chosen.append(gate)
    return chosen


def skipped_gates(gates: Iterable[Gate], grids: Sequence[Grid], models: Sequence[str] | None) -> list[Gate]:
    """Return the gates about models that are not given, which a run leaves out.

    Parameters
    ----------
    gates, grids, models
        As of `relevant`.

    Raises
    ------
    ValueError
        If a gate is about a model that is given, but its reference or rival is not computed: left out as well, it
        would let the run pass without having been asked.
    """
    if models is None:
        return [gate for gate in gates if gate.candidate == GIVEN]
    others = []
    for gate in gates:
        missing = sorted(_not_computed(gate, grids, models))
        if gate.candidate not in {GIVEN, *models}:
            others.append(gate)
        elif missing:
            raise ValueError(
                f"gate {gate.id} needs {' and '.join(missing)}, which this run does not compute: "
                f"add --model {' '.join(missing)}"
            )
    return others


def _not_computed(gate: Gate, grids: Sequence[Grid], models: Sequence[str]) -> set[str]:
    """Return which of the models that a gate compares with are neither given nor the reference of a grid."""
    needed = {gate.reference} if gate.rival is None else {gate.reference, gate.rival}
    return needed - {grid.reference for grid in grids} - set(models)


def judge(
    gates: Iterable[Gate],
    grids: Sequence[Grid],
    rows: pd.DataFrame,
    curves: pd.DataFrame | None = None,
    models: Sequence[str] | None = None,
) -> pd.DataFrame:
    """Judge stored results.

    Parameters
    ----------
    gates : iterable of Gate
    grids : sequence of Grid
        The cases that were computed.
    rows : DataFrame
        Stored results (`comparisons.runs.rows.COLUMNS`).
    curves : DataFrame, optional
        Stored curves (`comparisons.runs.rows.CURVE_COLUMNS`).
    models : sequence of str, optional
        Models that were given in place of those each grid names.

    Returns
    -------
    DataFrame
        The fields of `Judged`, one row a gate and case, in the order of the gates, then of the cases.
    """
    expected = {task.key for task in plan(grids, None if models is None else list(models))}
    given = None if models is None else set(models)
    answers, shapes = _Answers(rows, _NEEDED), _Answers(curves, _NEEDED_OF_CURVES)
    judged = [
        one
        for gate in relevant(gates, grids, models)
        for one in _judge_gate(gate, grids, shapes if gate.metric == "curve" else answers, expected, given)
    ]
    return pd.DataFrame([asdict(one) for one in judged], columns=list(Judged.__slots__))


class _Answers:
    """The stored rows of each question."""

    def __init__(self, table: pd.DataFrame | None, needed: set[str]) -> None:
        table = pd.DataFrame(columns=sorted(needed)) if table is None else table
        self.lost = sorted(needed - set(table.columns))
        self.records: dict[Key, list[dict[Hashable, Any]]] = defaultdict(list)
        if not self.lost:
            for record in table[sorted(needed)].to_dict("records"):
                nu = record["nu"]
                nu = None if nu is None or pd.isna(nu) else float(nu)
                self.records[record["model"], record["quantity"], record["n"], record["k"], record["mu"], nu].append(
                    record
                )

    def usable(self, key: Key) -> list[dict[Hashable, Any]]:
        """The records of a question that has an answer; raises `_Unusable` otherwise."""
        records = self.records.get(key, [])
        if not records:
            raise _Unusable(Verdict.ERROR, f"{key[0]} has no row")
        first = records[0]
        if first["status"] == "not-applicable":
            raise _Unusable(Verdict.NOT_APPLICABLE, f"{key[0]}: {first['reason']}")
        if first["status"] != "ok":
            raise _Unusable(Verdict.ERROR, f"{key[0]}: {first['status']}: {first['reason']}")
        return records

    def number(self, key: Key) -> tuple[float, float]:
        """Value and u_num of a question."""
        records = self.usable(key)
        if len(records) > 1:
            raise _Unusable(Verdict.ERROR, f"{key[0]} has {len(records)} rows")
        value, u_num = (_real(records[0][name]) for name in ("value", "u_num"))
        if not (math.isfinite(value) and math.isfinite(u_num) and u_num >= 0.0):
            raise _Unusable(Verdict.ERROR, f"{key[0]} has the value {value:g} +- {u_num:g}")
        return value, u_num

    def points(self, key: Key) -> tuple[np.ndarray, np.ndarray, float]:
        """The points of a curve and the bound on their distance from it."""
        table = pd.DataFrame(self.usable(key))
        u = float(table["u_distance"].max(skipna=False))
        if not (math.isfinite(u) and u >= 0.0):
            raise _Unusable(Verdict.ERROR, f"{key[0]} states the uncertainty {u:g} of its curve")
        return table["x"].to_numpy(float), table["y"].to_numpy(float), u


def _real(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _judge_gate(
    gate: Gate, grids: Sequence[Grid], answers: _Answers, expected: set[Key], given: set[str] | None
) -> Iterator[Judged]:
    if answers.lost:
        yield _whole(gate, f"the results have no column {', '.join(answers.lost)}")
        return
    cases = _cases(gate, grids, given)
    scale = _range(gate, cases, answers)
    judged = [_judge_case(gate, case, answers, scale) for case in cases]
    yield from judged
    evaluated = sum(one.verdict is not Verdict.NOT_APPLICABLE for one in judged)
    if evaluated < gate.min_cases:
        yield _whole(gate, f"{evaluated} cases were evaluated, {gate.min_cases} are declared")
    stray = [key for key in answers.records if key[:2] == (gate.candidate, gate.quantity) and key not in expected]
    if stray:
        yield _whole(gate, f"{len(stray)} rows answer cases that were not asked, e.g. {stray[0][2:]}")


def _cases(gate: Gate, grids: Sequence[Grid], given: set[str] | None) -> list[Case]:
    """Return the cases that the candidate was asked and the gate selects, sorted."""
    chosen = {
        case
        for grid in grids
        if gate.quantity in grid.quantities
        and gate.candidate in (given if given is not None else set(grid.models)) | {grid.reference}
        for case in grid.cases
        if gate.selects(grid, case)
    }
    return sorted(chosen, key=lambda case: (case.n, case.k, case.mu, -1.0 if case.nu is None else case.nu))


def _key(model: str, gate: Gate, case: Case) -> Key:
    asked = case_for(model, case)
    return model, gate.quantity, asked.n, asked.k, asked.mu, asked.nu


def _range(gate: Gate, cases: list[Case], answers: _Answers) -> float:
    """Range of the reference over the cases; 0 when it has none, which no error survives."""
    values = []
    for case in cases if gate.metric == "range-relative" else []:
        try:
            values.append(answers.number(_key(gate.reference, gate, gate.reference_case(case)))[0])
        except _Unusable:
            continue
    return max(values) - min(values) if values else 0.0


def _judge_case(gate: Gate, case: Case, answers: _Answers, scale: float) -> Judged:
    blank = _whole(gate, "")
    one = replace(blank, n=case.n, k=case.k, mu=case.mu, nu=case_for(gate.candidate, case).nu)
    try:
        found = _distance(gate, case, answers) if gate.metric == "curve" else _error(gate, case, answers, scale)
    except _Unusable as trouble:
        verdict, reason = trouble.verdict, trouble.reason
        if verdict is Verdict.NOT_APPLICABLE and gate.not_applicable == "error":
            verdict, reason = Verdict.ERROR, f"{reason} ({_CURE})"
        return replace(one, verdict=verdict, reason=reason)
    verdict, reason = decide(found.error, found.uncertainty, gate.lower, gate.upper), ""
    if verdict is Verdict.ERROR:
        reason = f"the error {found.error:g} +- {found.uncertainty:g} is not a finite number"
    elif verdict is Verdict.INCONCLUSIVE:
        shares = {f"the {role} {getattr(gate, role)}": u for role, u in found.shares.items()}
        reason = crossing(found.error, found.uncertainty, gate.lower, gate.upper, shares)
    elif verdict is Verdict.PASS and (reason := _too_uncertain(gate, found)):
        verdict = Verdict.INCONCLUSIVE
    if gate.expected_failure:
        verdict = expecting_failure(verdict)
        reason = reason or gate.expected_failure
    return replace(one, **found.facts, error=found.error, uncertainty=found.uncertainty, verdict=verdict, reason=reason)


def _too_uncertain(gate: Gate, found: _Error) -> str:
    """Return whose uncertainty is larger than the gate tolerates, with the numbers; nothing if none is."""
    unit = " of the reference's value" if gate.metric in ("rel", "en") else ""
    too_large = [
        f"u of the {role} {getattr(gate, role)} is {u:.6g}{unit}; the gate tolerates {exact(limit)}"
        for role, u, limit in (
            ("candidate", found.u_candidate, gate.max_candidate_uncertainty),
            ("reference", found.u_reference, gate.max_reference_uncertainty),
        )
        if limit is not None and u > limit
    ]
    return "; ".join(too_large)


def _error(gate: Gate, case: Case, answers: _Answers, scale: float) -> _Error:
    true, u_true = answers.number(_key(gate.reference, gate, gate.reference_case(case)))
    if gate.metric == "en":
        return _normalised(*answers.number(_key(gate.candidate, gate, case)), true, u_true)
    unit = {"rel": abs(true), "abs": 1.0, "range-relative": scale}[gate.metric]
    if unit == 0.0:
        raise _Unusable(Verdict.ERROR, f"the reference {gate.reference} is or has a range of zero: use metric abs")
    value, u_num = answers.number(_key(gate.candidate, gate, case))
    error, u, share = _metric(gate, value, u_num, true, u_true, unit)
    shares = {"candidate": u_num / unit, "reference": share}
    if gate.rival:
        other, u_other = answers.number(_key(gate.rival, gate, case))
        rival, u_rival, share_of_rival = _metric(gate, other, u_other, true, u_true, unit)
        error, u = abs(error) - abs(rival), math.hypot(u, u_rival)
        shares |= {"reference": math.hypot(share, share_of_rival), "rival": u_other / unit}
    facts = {"value": value, "u_num": u_num, "reference_value": true, "u_reference": u_true}
    return _Error(error, combined(u), u_num / unit, u_true / unit, shares, facts)


def _normalised(value: float, u_num: float, true: float, u_true: float) -> _Error:
    """E_n of ISO 13528: the error in units of what both sides claim, so that it has no uncertainty of its own."""
    claimed = math.hypot(u_num, u_true)
    if claimed == 0.0 or true == 0.0:
        raise _Unusable(Verdict.ERROR, "the reference or both uncertainties are zero: use metric abs")
    facts = {"value": value, "u_num": u_num, "reference_value": true, "u_reference": u_true}
    return _Error((value - true) / claimed, 0.0, u_num / abs(true), u_true / abs(true), {}, facts)


def _metric(
    gate: Gate, value: float, u_num: float, true: float, u_true: float, unit: float
) -> tuple[float, float, float]:
    """Error, its uncertainty and the reference's share; a relative error moves with its denominator too."""
    error = relative_difference(value, true) if gate.metric == "rel" else (value - true) / unit
    share = u_true / unit * (abs(value / true) if gate.metric == "rel" else 1.0)
    return error, math.hypot(u_num / unit, share), share


def _distance(gate: Gate, case: Case, answers: _Answers) -> _Error:
    x, y, u = answers.points(_key(gate.candidate, gate, case))
    true_x, true_y, u_true = answers.points(_key(gate.reference, gate, gate.reference_case(case)))
    try:
        found = curve_distance(x, y, true_x, true_y)
    except ValueError as refusal:
        raise _Unusable(Verdict.ERROR, str(refusal)) from refusal
    u_true = math.hypot(u_true, found.u_interpolation)
    shares = {"candidate": u, "reference": u_true}
    return _Error(found.value, combined(u, u_true), u, u_true, shares, {"u_num": u, "u_reference": u_true})


def _whole(gate: Gate, reason: str) -> Judged:
    """An ERROR of the gate as a whole, and the blank form of a case."""
    return Judged(
        gate=gate.id,
        quantity=gate.quantity,
        candidate=gate.candidate,
        reference=gate.reference,
        n=None,
        k=None,
        mu=None,
        nu=None,
        value=None,
        u_num=None,
        reference_value=None,
        u_reference=None,
        error=None,
        uncertainty=None,
        lower=float(gate.lower),
        upper=float(gate.upper),
        verdict=Verdict.ERROR,
        reason=reason,
    )
