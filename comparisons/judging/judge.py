"""Verdicts of gates on stored results; no model is computed.

The declared cases decide what a gate expects, not the rows that exist.  So a row that is missing or is there twice is
an ERROR and not a smaller sample.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace

import pandas as pd

from comparisons.judging.decision import Verdict, crossing, decide, expecting_failure
from comparisons.judging.gates import Gate
from comparisons.judging.metrics import CaseError, GateResults, UnusableResult, case_error, reference_range, rows_by_key
from comparisons.judging.selection import cases_of, promised, relevant
from comparisons.model import HasSkip
from comparisons.numerics.number_text import exact
from comparisons.problem import Problem
from comparisons.runs.cases import Grid
from comparisons.runs.frames import without_empty_problem
from comparisons.runs.tasks import problem_for

#: What to change in a gate with a case to which a model does not apply.
_REMEDY = 'name the cases it applies to in the gate, e.g. cases = { k = [0, 0] }, or state not_applicable = "leave-out"'

#: The status of a case that is not in the domain of the candidate.
OUTSIDE = "outside"

#: The status of a case in which neither the candidate nor the reference has a value: there is no such event.
NO_EVENT = "no-event"


@dataclass(frozen=True, slots=True)
class Judged:
    """One gate in one case; n, k, mu and problem have nothing where the gate as a whole could not be judged.

    `error`, `uncertainty`, `lower` and `upper` are in the unit of the gate's metric.  `status` is that of the
    candidate's result; "outside" where the case is not in the domain that the candidate declares, "no-event" where
    neither it nor the reference has a value, and empty for the gate as a whole.
    """

    gate: str
    quantity: str
    candidate: str
    reference: str
    n: float | None = None
    k: float | None = None
    mu: float | None = None
    nu: float | None = None
    value: float | None = None
    u_num: float | None = None
    reference_value: float | None = None
    u_reference: float | None = None
    error: float | None = None
    uncertainty: float | None = None
    lower: float = math.nan
    upper: float = math.nan
    verdict: Verdict = Verdict.ERROR
    reason: str = ""
    status: str = ""
    problem: str = ""


def judge(
    gates: Iterable[Gate],
    grids: Sequence[Grid],
    rows: pd.DataFrame,
    curves: pd.DataFrame | None = None,
    models: Sequence[str] | None = None,
    taken: Mapping[str, HasSkip] | None = None,
) -> pd.DataFrame:
    """Judge stored results.

    Parameters
    ----------
    gates : iterable of Gate
    grids : sequence of Grid
        The cases that were computed.
    rows : DataFrame
        Stored results (`comparisons.runs.frames.COLUMNS`).
    curves : DataFrame, optional
        Stored curves (`comparisons.runs.frames.CURVE_COLUMNS`).
    models : sequence of str, optional
        Models that were given in place of those each grid names.
    taken : mapping of str to HasSkip, optional
        What models take, as of `promised`: inside "not applicable" is a failure, and outside it is not counted.

    Returns
    -------
    DataFrame
        The fields of `Judged`, one row a gate and case, in the order of the gates, then of the cases.
    """
    judged_gates = relevant(gates, grids, models)
    compared = rows_by_key([rows] if curves is None else [rows, curves], judged_gates)
    judged: list[Judged] = []
    for gate in judged_gates:
        of_candidate = (taken or {}).get(gate.candidate)
        judged += _judge_gate(GateResults(gate, compared), cases_of(gate, grids, models), of_candidate)
    return verdict_table(judged)


def verdict_table(judged: Iterable[Judged]) -> pd.DataFrame:
    """Return verdicts as a table with the fields of `Judged`; `problem` where a case is of a file."""
    return without_empty_problem(pd.DataFrame([asdict(row) for row in judged], columns=list(Judged.__slots__)))


def every_verdict(tables: Iterable[pd.DataFrame]) -> pd.DataFrame:
    """Return tables of verdicts as one; its columns of numbers have the type of numbers whatever is missing in them."""
    joined = pd.concat([table.astype(object) for table in tables], ignore_index=True)
    if "problem" in joined:
        joined["problem"] = joined["problem"].fillna("")
    numbers = [field.name for field in fields(Judged) if "float" in str(field.type)]
    return joined.assign(**{name: pd.to_numeric(joined[name]).astype(float) for name in numbers})


def _judge_gate(results: GateResults, cases: Sequence[Problem], taken: HasSkip | None) -> Iterator[Judged]:
    gate, scale = results.gate, reference_range(results, cases)
    judged = [_judge_case(results, case, scale, taken) for case in cases]
    yield from judged
    if refusal := _refusal(gate, judged):
        yield replace(_whole(gate, refusal), verdict=Verdict.FAIL)
    evaluated = sum(case.verdict is not Verdict.NOT_APPLICABLE for case in judged)
    if evaluated < gate.min_cases:
        stated = f"min_cases = {gate.min_cases}, which its file states: lower it if the domain has no more"
        yield _whole(gate, f"{evaluated} cases were evaluated, fewer than {stated}")


def _refusal(gate: Gate, judged: Sequence[Judged]) -> str:
    """Return why the candidate has too few values; nothing if it has enough, or is evaluated nowhere."""
    evaluated = [case.status for case in judged if case.status != OUTSIDE]
    count = evaluated.count("ok") + evaluated.count(NO_EVENT)
    if gate.min_coverage is None or not evaluated or count >= gate.min_coverage * len(evaluated):
        return ""
    return (
        f"{gate.candidate} has a value in {count} of the {len(evaluated)} cases in which it is evaluated; the gate "
        f"requires {100.0 * gate.min_coverage:.4g} % (a model that is not for all of them declares its domain)"
    )


def _judge_case(results: GateResults, case: Problem, scale: float, taken: HasSkip | None) -> Judged:
    gate = results.gate
    evaluated, status = problem_for(gate.candidate, case), results.status("candidate", case)
    is_inside = promised(taken, gate.quantity, evaluated)
    if is_inside is False or (taken is not None and is_inside is None and status == "not-applicable"):
        status = OUTSIDE
    n, k, mu, nu, problem = evaluated.key
    judged = replace(_whole(gate, ""), n=n, k=k, mu=mu, nu=nu, problem=problem, status=status)
    if taken is not None and is_inside is False:
        return replace(judged, verdict=Verdict.NOT_APPLICABLE, reason=taken.skip(evaluated, gate.quantity) or "")
    try:
        error = case_error(results, case, scale)
    except UnusableResult as unusable:
        return _without_error(judged, unusable, results, case, is_failure=is_inside and status == "not-applicable")
    verdict, reason = _decided(gate, error)
    numbers = error.facts | {"error": error.error, "uncertainty": error.uncertainty}
    return replace(judged, **numbers, verdict=verdict, reason=reason)


def _without_error(
    judged: Judged, unusable: UnusableResult, results: GateResults, case: Problem, *, is_failure: bool | None
) -> Judged:
    """Return the verdict on a case in which the candidate or a model that it is compared with has no usable result."""
    verdict, reason, status = unusable.verdict, unusable.reason, judged.status
    if is_failure and results.status("reference", case) == "not-applicable":
        verdict, status, reason = Verdict.NOT_APPLICABLE, NO_EVENT, f"{reason}; as the reference"
    elif is_failure:
        verdict, reason = Verdict.FAIL, f"{reason} (inside the domain that the model declares)"
    elif verdict is Verdict.NOT_APPLICABLE and results.gate.not_applicable == "error":
        verdict, reason = Verdict.ERROR, f"{reason} ({_REMEDY})"
    return replace(judged, verdict=verdict, status=status, reason=reason)


def _decided(gate: Gate, case: CaseError) -> tuple[Verdict, str]:
    """Return the verdict on an error, and its reason."""
    error, reason = case.error, ""
    verdict = decide(error, case.uncertainty, gate.lower, gate.upper)
    if verdict is Verdict.ERROR:
        return verdict, f"the error {error:g} +- {case.uncertainty:g} is not a finite number"
    if verdict is Verdict.INCONCLUSIVE:
        shares = {f"the {role} {gate.models[role]}": u for role, u in case.shares.items()}
        reason = crossing(error, case.uncertainty, gate.lower, gate.upper, shares)
    elif verdict is Verdict.PASS and (reason := _too_uncertain(gate, case)):
        verdict = Verdict.INCONCLUSIVE
    if gate.expected_failure:
        verdict, reason = expecting_failure(verdict), reason or gate.expected_failure
    low, high = gate.measured_range or (-math.inf, math.inf)
    if not low <= error <= high and verdict is not Verdict.XPASS:
        between = f"{exact(low)} and {exact(high)}"
        changed = f"E = {error:.6g} has changed: the errors measured when the gate was made are between {between}"
        return Verdict.FAIL, changed
    return verdict, reason


def _too_uncertain(gate: Gate, case: CaseError) -> str:
    """Return whose uncertainty is larger than the gate tolerates, with the numbers; empty if none is."""
    unit = " of the reference's value" if gate.metric in ("rel", "en") else ""
    limits = {"candidate": gate.max_candidate_uncertainty, "reference": gate.max_reference_uncertainty}
    return "; ".join(
        f"u of the {role} {gate.models[role]} is {case.bounds[role]:.6g}{unit}; the gate tolerates {exact(limit)}"
        for role, limit in limits.items()
        if limit is not None and case.bounds[role] > limit
    )


def _whole(gate: Gate, reason: str) -> Judged:
    """Return an ERROR of the gate as a whole, which is also the blank form of a case."""
    names = gate.id, gate.quantity, gate.candidate, gate.reference
    return Judged(*names, lower=float(gate.lower), upper=float(gate.upper), reason=reason)
