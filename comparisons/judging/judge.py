"""Verdicts of gates on stored results; no model is computed.

The declared cases decide what a gate expects, not the rows that exist.  So a row that is missing, is there twice or
belongs to no declared case is an ERROR and not a smaller sample.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.decision import Verdict, crossing, decide, expecting_failure, requiring_certainty
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
    named = None if models is None else set(models)
    chosen = relevant(gates, grids, models)
    expected = _planned(chosen, grids, models) | {*others}
    numbers = stored_numbers(rows, names_in(gate for gate in chosen if gate.metric != "curve"))
    points = stored_curves(curves, names_in(gate for gate in chosen if gate.metric == "curve"))
    judged = [
        one
        for gate in chosen
        for one in _judge_gate(
            gate,
            grids,
            points if gate.metric == "curve" else numbers,
            expected,
            named,
            (domains or {}).get(gate.candidate),
        )
    ]
    return verdict_table(judged)


def verdict_table(judged: Iterable[Judged]) -> pd.DataFrame:
    """Return verdicts as a table with the fields of `Judged`; `problem` where a case is of a file."""
    return without_empty_problem(pd.DataFrame([asdict(one) for one in judged], columns=list(Judged.__slots__)))


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
    gate: Gate,
    grids: Sequence[Grid],
    results: StoredResults,
    expected: set[Key],
    models: set[str] | None,
    domain: Domain | None,
) -> Iterator[Judged]:
    if results.missing_columns:
        yield _whole(gate, f"the results have no column {', '.join(results.missing_columns)}")
        return
    cases = cases_of(gate, grids, models)
    scale = reference_range(gate, cases, results)
    judged = [_judge_case(gate, case, results, scale, domain) for case in cases]
    yield from judged
    if refusal := _refusal(gate, judged):
        yield replace(_whole(gate, refusal), verdict=Verdict.FAIL)
    evaluated = sum(one.verdict is not Verdict.NOT_APPLICABLE for one in judged)
    if evaluated < gate.min_cases:
        yield _whole(gate, f"{evaluated} cases were evaluated, {gate.min_cases} are declared")
    stray = [key for key in results.rows if key[:2] == (gate.candidate, gate.quantity) and key not in expected]
    if stray:
        yield _whole(gate, f"{len(stray)} rows belong to cases that are not declared, e.g. {stray[0][2:]}")


def _refusal(gate: Gate, judged: Sequence[Judged]) -> str:
    """Return why the candidate has too few values; nothing if it has enough, or is evaluated nowhere."""
    evaluated = [one.status for one in judged if one.status != OUTSIDE]
    answered = evaluated.count("ok") + evaluated.count(NO_EVENT)
    if gate.min_coverage is None or not evaluated or answered >= gate.min_coverage * len(evaluated):
        return ""
    return (
        f"{gate.candidate} has a value in {answered} of the {len(evaluated)} cases in which it is evaluated; the gate "
        f"requires {100.0 * gate.min_coverage:.4g} % (a model that is not for all of them declares its domain)"
    )


def _judge_case(gate: Gate, case: Problem, results: StoredResults, scale: float, domain: Domain | None) -> Judged:
    own, key = problem_for(gate.candidate, case), key_of(gate.candidate, gate, case)
    inside = domain is None or not own.is_dimensionless or domain.contains(gate.quantity, own.parameters)
    status = results.status(key) if inside else OUTSIDE
    if domain is not None and (domain.is_list or not own.is_dimensionless) and status == "not-applicable":
        status = OUTSIDE
    n, k, mu, nu, name = own.key
    one = replace(_whole(gate, ""), n=n, k=k, mu=mu, nu=nu, problem=name, status=status)
    try:
        if domain is not None and not inside:
            raise UnusableResult(Verdict.NOT_APPLICABLE, domain.refusal(gate.quantity))
        found = case_error(gate, case, results, scale)
    except UnusableResult as unusable:
        verdict, reason = unusable.verdict, unusable.reason
        if domain is not None and status == "not-applicable":
            if results.status(key_of(gate.reference, gate, gate.reference_case(case))) == "not-applicable":
                return replace(
                    one, verdict=Verdict.NOT_APPLICABLE, status=NO_EVENT, reason=f"{reason}; as the reference"
                )
            return replace(one, verdict=Verdict.FAIL, reason=f"{reason} (inside the domain that the model declares)")
        if verdict is Verdict.NOT_APPLICABLE and gate.not_applicable == "error":
            verdict, reason = Verdict.ERROR, f"{reason} ({_REMEDY})"
        return replace(one, verdict=verdict, reason=reason)
    verdict, reason = decide(found.error, found.uncertainty, gate.lower, gate.upper), ""
    if verdict is Verdict.ERROR:
        reason = f"the error {found.error:g} +- {found.uncertainty:g} is not a finite number"
    elif verdict is Verdict.INCONCLUSIVE:
        shares = {f"the {role} {getattr(gate, role)}": u for role, u in found.shares.items()}
        reason = crossing(found.error, found.uncertainty, gate.lower, gate.upper, shares)
    else:
        limited = _limited_uncertainties(gate, found)
        certain = requiring_certainty(verdict, [(u, limit) for _, u, limit in limited])
        if certain is not verdict:
            verdict, reason = certain, _too_uncertain(gate, limited)
    if gate.expected_failure:
        verdict = expecting_failure(verdict)
        reason = reason or gate.expected_failure
    if verdict not in (Verdict.ERROR, Verdict.XPASS) and (changed := _change(gate, found.error)):
        verdict, reason = Verdict.FAIL, changed
    return replace(one, **found.facts, error=found.error, uncertainty=found.uncertainty, verdict=verdict, reason=reason)


def _change(gate: Gate, error: float) -> str:
    """Return why an error is none of those that were measured when the gate was made; empty if it is one."""
    if gate.measured_range is None or gate.measured_range[0] <= error <= gate.measured_range[1]:
        return ""
    low, high = map(exact, gate.measured_range)
    return f"E = {error:.6g} has changed: the errors measured when the gate was made are between {low} and {high}"


def _limited_uncertainties(gate: Gate, found: CaseError) -> list[tuple[str, float, float | None]]:
    """Return the role of each model, its uncertainty, and the largest one that the gate tolerates."""
    return [
        ("candidate", found.u_candidate, gate.max_candidate_uncertainty),
        ("reference", found.u_reference, gate.max_reference_uncertainty),
    ]


def _too_uncertain(gate: Gate, limited: Sequence[tuple[str, float, float | None]]) -> str:
    """Return whose uncertainty is larger than the gate tolerates, with the numbers."""
    unit = " of the reference's value" if gate.metric in ("rel", "en") else ""
    too_large = [
        f"u of the {role} {getattr(gate, role)} is {u:.6g}{unit}; the gate tolerates {exact(limit)}"
        for role, u, limit in limited
        if limit is not None and u > limit
    ]
    return "; ".join(too_large)


def _whole(gate: Gate, reason: str) -> Judged:
    """Return an ERROR of the gate as a whole, which is also the blank form of a case."""
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
