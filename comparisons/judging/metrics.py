"""Error of a candidate in one case and its bound, in the unit of the metric of a gate."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from comparisons.judging.decision import Verdict
from comparisons.judging.stored_results import GateResults, UnusableResult
from comparisons.numerics.bounds import combined, relative_difference
from comparisons.problem import Problem


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
    if gate.metric == "en":
        # The difference in units of the bound U, so that it has no bound of its own.
        bound, unit = combined(u_num, u_reference), abs(reference)
        if bound == 0.0 or unit == 0.0:
            raise UnusableResult(Verdict.ERROR, "the reference or both uncertainties are zero: use metric abs")
        bounds = {"candidate": u_num / unit, "reference": u_reference / unit}
        return CaseError((value - reference) / bound, 0.0, bounds, facts)
    unit = {"rel": abs(reference), "abs": 1.0, "range-relative": scale}[gate.metric]
    if unit == 0.0:
        raise UnusableResult(Verdict.ERROR, f"the reference {gate.reference} is or has a range of zero: use metric abs")

    def error_of(value: float) -> tuple[float, float]:
        """The error of a value, and the share of the reference: it is also the unit of a relative error."""
        if gate.metric == "rel":
            return relative_difference(value, reference), abs(value / reference) * u_reference / unit
        return (value - reference) / unit, u_reference / unit

    error, share = error_of(value)
    shares = {"candidate": u_num / unit, "reference": share}
    if gate.rival:
        rival_value, u_rival = results.number("rival", case)
        error_of_rival, share_of_rival = error_of(rival_value)
        error = abs(error) - abs(error_of_rival)
        shares |= {"reference": share + share_of_rival, "rival": u_rival / unit}
    bounds = {"candidate": u_num / unit, "reference": u_reference / unit}
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
