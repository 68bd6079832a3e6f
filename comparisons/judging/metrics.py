"""Error of a candidate in one case and its bound, in the unit of the metric of a gate."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from comparisons.judging.decision import Verdict
from comparisons.judging.gates import Gate
from comparisons.judging.selection import key_of
from comparisons.judging.stored_results import StoredResults, UnusableResult
from comparisons.numerics.bounds import combined
from comparisons.numerics.kappa import relative_difference
from comparisons.problem import Problem

__all__ = ["CaseError", "case_error", "reference_range"]


@dataclass(frozen=True, slots=True)
class CaseError:
    """The error of a candidate in one case, in the unit of the metric.

    Attributes
    ----------
    error, uncertainty : float
        E and its bound U.
    u_candidate, u_reference : float
        The bounds that the gate limits.
    shares : dict
        The parts of U of the candidate, the reference and the rival.
    facts : dict
        Value and u_num of both sides, in the unit of the quantity.
    """

    error: float
    uncertainty: float
    u_candidate: float
    u_reference: float
    shares: dict[str, float]
    facts: dict[str, Any]


def case_error(gate: Gate, case: Problem, results: StoredResults, scale: float) -> CaseError:
    """Return the error of the gate's candidate in a case.

    Parameters
    ----------
    gate, case
    results : StoredResults
        Of curves for the metric "curve", otherwise of scalars.
    scale : float
        The range of the reference over the cases (`reference_range`).

    Raises
    ------
    UnusableResult
        If a result is missing, or has no error in this metric.
    """
    if gate.metric == "curve":
        return _distance(gate, case, results)
    # The candidate first: where it has no value, the reference needs none, and a run does not compute it.
    value, u_num = results.number(key_of(gate.candidate, gate, case))
    reference, u_reference = results.number(key_of(gate.reference, gate, gate.reference_case(case)))
    if gate.metric == "en":
        return _normalised(value, u_num, reference, u_reference)
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
        rival_value, u_other = results.number(key_of(gate.rival, gate, case))
        error_of_rival, share_of_rival = error_of(rival_value)
        error = abs(error) - abs(error_of_rival)
        shares = {"candidate": u_num / unit, "reference": share + share_of_rival, "rival": u_other / unit}
    facts = {"value": value, "u_num": u_num, "reference_value": reference, "u_reference": u_reference}
    return CaseError(error, combined(*shares.values()), u_num / unit, u_reference / unit, shares, facts)


def reference_range(gate: Gate, cases: Iterable[Problem], results: StoredResults) -> float:
    """Return the range of the reference over the cases; 0 where it has none or the metric needs none."""
    values = []
    for case in cases if gate.metric == "range-relative" else []:
        try:
            values.append(results.number(key_of(gate.reference, gate, gate.reference_case(case)))[0])
        except UnusableResult:
            continue
    return max(values) - min(values) if values else 0.0


def _normalised(value: float, u_num: float, reference: float, u_reference: float) -> CaseError:
    """E_n: the difference in units of the bound U, so that it has no bound of its own."""
    bound = combined(u_num, u_reference)
    if bound == 0.0 or reference == 0.0:
        raise UnusableResult(Verdict.ERROR, "the reference or both uncertainties are zero: use metric abs")
    facts = {"value": value, "u_num": u_num, "reference_value": reference, "u_reference": u_reference}
    unit = abs(reference)
    return CaseError((value - reference) / bound, 0.0, u_num / unit, u_reference / unit, {}, facts)


def _distance(gate: Gate, case: Problem, results: StoredResults) -> CaseError:
    # Gates of numbers do not wait for SciPy's interpolation.
    from comparisons.numerics.curve_distance import curve_distance

    x, y, u_candidate = results.points(key_of(gate.candidate, gate, case))
    *reference, u_points = results.points(key_of(gate.reference, gate, gate.reference_case(case)))
    try:
        distance = curve_distance(x, y, *reference)
    except ValueError as error:
        raise UnusableResult(Verdict.ERROR, str(error)) from error
    u_reference = u_points + distance.u_interpolation
    shares = {"candidate": u_candidate, "reference": u_reference}
    facts = {"u_num": u_candidate, "u_reference": u_reference}
    return CaseError(distance.value, combined(u_candidate, u_reference), u_candidate, u_reference, shares, facts)
