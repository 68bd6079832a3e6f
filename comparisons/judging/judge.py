"""Verdicts of gates on stored results; no model is computed.

The declared cases decide what a gate expects, not the rows that exist.  So a row that is missing, is there twice or
belongs to no declared case is an ERROR and not a smaller sample.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.decision import Verdict, crossing, decide, expecting_failure
from comparisons.judging.gates import Gate
from comparisons.judging.metrics import CaseError, case_error, reference_range
from comparisons.judging.selection import cases_of, key_of, names_in, relevant
from comparisons.judging.stored_results import StoredResults, UnusableResult, stored_curves, stored_numbers
from comparisons.numerics.number_text import exact
from comparisons.problem import Problem
from comparisons.runs.case_columns import without_empty_problem
from comparisons.runs.cases import Grid
from comparisons.runs.rows import Key
from comparisons.runs.tasks import Task, problem_for

__all__ = ["NO_EVENT", "OUTSIDE", "Judged", "judge", "verdict_table"]

#: What to change in a gate with a case to which a model does not apply.
_REMEDY = 'name the cases it applies to in the gate, e.g. cases = { k = [0, 0] }, or state not_applicable = "leave-out"'


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


#: The status of a case that is not in the domain of the candidate.
OUTSIDE = "outside"

#: The status of a case in which neither the candidate nor the reference has a value: there is no such event.
NO_EVENT = "no-event"


def judge(
    gates: Iterable[Gate],
    grids: Sequence[Grid],
    rows: pd.DataFrame,
    curves: pd.DataFrame | None = None,
    models: Sequence[str] | None = None,
    domains: Mapping[str, Domain] | None = None,
    others: Collection[Key] = (),
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
    domains : mapping of str to Domain, optional
        The domains that models declare: there "not applicable" is a failure, and outside it counts for nothing.
    others : collection of key, optional
        Rows of other cases that are declared elsewhere.

    Returns
    -------
    DataFrame
        The fields of `Judged`, one row a gate and case, in the order of the gates, then of the cases.
    """
    judged_gates = relevant(gates, grids, models)
    expected = _planned(judged_gates, grids, models) | {*others}
    numbers = stored_numbers(rows, names_in(gate for gate in judged_gates if gate.metric != "curve"))
    points = stored_curves(curves, names_in(gate for gate in judged_gates if gate.metric == "curve"))
    judged: list[Judged] = []
    for gate in judged_gates:
        results, domain = points if gate.metric == "curve" else numbers, (domains or {}).get(gate.candidate)
        judged += _judge_gate(gate, cases_of(gate, grids, models), results, expected, domain)
    return verdict_table(judged)


def verdict_table(judged: Iterable[Judged]) -> pd.DataFrame:
    """Return verdicts as a table with the fields of `Judged`; `problem` where a case is of a file."""
    return without_empty_problem(pd.DataFrame([asdict(row) for row in judged], columns=list(Judged.__slots__)))


def _planned(gates: Collection[Gate], grids: Sequence[Grid], models: Sequence[str] | None) -> set[Key]:
    """Return the keys of the declared cases, of the candidates and quantities of some gates."""
    candidates = {gate.candidate for gate in gates}
    quantities = {gate.quantity for gate in gates}
    return {
        Task(model, quantity, case).key
        for grid in grids
        for model in candidates.intersection((grid.reference, *(models or grid.models)))
        for quantity in quantities.intersection(grid.quantities)
        for case in (problem_for(model, declared) for declared in grid.cases)
    }


def _judge_gate(
    gate: Gate, cases: Sequence[Problem], results: StoredResults, expected: set[Key], domain: Domain | None
) -> Iterator[Judged]:
    if results.missing_columns:
        yield _whole(gate, f"the results have no column {', '.join(results.missing_columns)}")
        return
    scale = reference_range(gate, cases, results)
    judged = [_judge_case(gate, case, results, scale, domain) for case in cases]
    yield from judged
    if refusal := _refusal(gate, judged):
        yield replace(_whole(gate, refusal), verdict=Verdict.FAIL)
    evaluated = sum(case.verdict is not Verdict.NOT_APPLICABLE for case in judged)
    if evaluated < gate.min_cases:
        yield _whole(gate, f"{evaluated} cases were evaluated, {gate.min_cases} are declared")
    stray = [key for key in results.rows if key[:2] == (gate.candidate, gate.quantity) and key not in expected]
    if stray:
        yield _whole(gate, f"{len(stray)} rows belong to cases that are not declared, e.g. {stray[0][2:]}")


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


def _judge_case(gate: Gate, case: Problem, results: StoredResults, scale: float, domain: Domain | None) -> Judged:
    evaluated, status = problem_for(gate.candidate, case), results.status(key_of(gate.candidate, gate, case))
    numbers = evaluated.numbers if evaluated.is_dimensionless else {}
    outside = domain is not None and numbers != {} and not domain.contains(gate.quantity, numbers)
    # A list of cases has no others, and the domain has no problem of a file.
    unlisted = domain is not None and (domain.is_list or not evaluated.is_dimensionless) and status == "not-applicable"
    n, k, mu, nu, name = evaluated.key
    judged = replace(_whole(gate, ""), n=n, k=k, mu=mu, nu=nu, problem=name)
    judged = replace(judged, status=OUTSIDE if outside or unlisted else status)
    try:
        if domain is not None and outside:
            raise UnusableResult(Verdict.NOT_APPLICABLE, domain.refusal(gate.quantity))
        error = case_error(gate, case, results, scale)
    except UnusableResult as unusable:
        reference = results.status(key_of(gate.reference, gate, gate.reference_case(case)))
        return _without_error(gate, judged, unusable, domain is not None, reference)
    verdict, reason = _decided(gate, error)
    facts = error.facts | {"error": error.error, "uncertainty": error.uncertainty}
    return replace(judged, **facts, verdict=verdict, reason=reason)


def _without_error(
    gate: Gate, judged: Judged, unusable: UnusableResult, has_domain: bool, status_of_reference: str
) -> Judged:
    """Return the verdict on a case in which the candidate or a model that it is compared with has no usable result."""
    verdict, reason, status = unusable.verdict, unusable.reason, judged.status
    if has_domain and status == "not-applicable":
        if status_of_reference == "not-applicable":
            verdict, status, reason = Verdict.NOT_APPLICABLE, NO_EVENT, f"{reason}; as the reference"
        else:
            verdict, reason = Verdict.FAIL, f"{reason} (inside the domain that the model declares)"
    elif verdict is Verdict.NOT_APPLICABLE and gate.not_applicable == "error":
        verdict, reason = Verdict.ERROR, f"{reason} ({_REMEDY})"
    return replace(judged, verdict=verdict, status=status, reason=reason)


def _decided(gate: Gate, case: CaseError) -> tuple[Verdict, str]:
    """Return the verdict on an error, and its reason."""
    error, reason = case.error, ""
    verdict = decide(error, case.uncertainty, gate.lower, gate.upper)
    if verdict is Verdict.ERROR:
        return verdict, f"the error {error:g} +- {case.uncertainty:g} is not a finite number"
    if verdict is Verdict.INCONCLUSIVE:
        shares = {f"the {role} {getattr(gate, role)}": u for role, u in case.shares.items()}
        reason = crossing(error, case.uncertainty, gate.lower, gate.upper, shares)
    elif verdict is Verdict.PASS and (reason := _too_uncertain(gate, case)):
        verdict = Verdict.INCONCLUSIVE
    if gate.expected_failure:
        verdict, reason = expecting_failure(verdict), reason or gate.expected_failure
    if gate.measured_range and verdict is not Verdict.XPASS:
        low, high = gate.measured_range
        if not low <= error <= high:
            between = f"{exact(low)} and {exact(high)}"
            changed = f"E = {error:.6g} has changed: the errors measured when the gate was made are between {between}"
            return Verdict.FAIL, changed
    return verdict, reason


def _too_uncertain(gate: Gate, case: CaseError) -> str:
    """Return whose uncertainty is larger than the gate tolerates, with the numbers; empty if none is."""
    unit = " of the reference's value" if gate.metric in ("rel", "en") else ""
    uncertainties = {
        "candidate": (case.u_candidate, gate.max_candidate_uncertainty),
        "reference": (case.u_reference, gate.max_reference_uncertainty),
    }
    return "; ".join(
        f"u of the {role} {getattr(gate, role)} is {u:.6g}{unit}; the gate tolerates {exact(limit)}"
        for role, (u, limit) in uncertainties.items()
        if limit is not None and u > limit
    )


def _whole(gate: Gate, reason: str) -> Judged:
    """Return an ERROR of the gate as a whole, which is also the blank form of a case."""
    names = gate.id, gate.quantity, gate.candidate, gate.reference
    return Judged(*names, lower=float(gate.lower), upper=float(gate.upper), reason=reason)
