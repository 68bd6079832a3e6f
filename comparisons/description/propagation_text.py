"""Propagated uncertainty as text and as JSON."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from comparisons.description.propagation import Contribution, Propagated, Range, propagated
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.problem.problem import Problem
from comparisons.problem.units import si_text

__all__ = ["Outcome", "content", "lines", "outcome_of"]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What is printed of the uncertainties of a file.

    Attributes
    ----------
    content : dict
        Object of JSON.
    lines : list of str
    failed : bool
        Whether a computation did not converge.
    """

    content: dict[str, Any]
    lines: list[str]
    failed: bool = False


def outcome_of(problem: Problem, quantity: str) -> Outcome:
    """Propagate the uncertainties of a file; an event that does not exist, or is not reached, gives a reason.

    Raises
    ------
    ValueError
        As `propagated`.
    """
    try:
        found = propagated(problem, quantity)
    except (NotApplicable, ComputationFailed) as error:
        failed = isinstance(error, ComputationFailed)
        status = "failed" if failed else "not-applicable"
        reason = {"quantity": quantity, "status": status, "reason": str(error)}
        return Outcome(reason, [f"uncertainty of {quantity}: {status}: {error}"], failed)
    return Outcome(content(found), lines(found))


def content(found: Propagated) -> dict[str, Any]:
    """Return what follows from the uncertainties as an object of JSON, in SI."""
    return {
        "quantity": found.quantity,
        "model": "fscm",
        "value": found.value,
        "u_num": found.u_num,
        "unit": found.unit,
        "status": "ok",
        "parameters": [_parameter(one) for one in found.contributions],
        "standard_deviation": found.standard_deviation,
        "range": found.range and _range(found.range),
    }


def _parameter(one: Contribution) -> dict[str, Any]:
    kind = "half_width" if one.uncertainty.is_interval else "standard_deviation"
    return {
        "parameter": one.name,
        "value": one.value,
        kind: one.uncertainty.size,
        "slope": one.slope,
        "elasticity": one.elasticity,
        "contribution": one.size,
    }


def _range(found: Range) -> dict[str, Any]:
    return {
        "first_order": [found.low, found.high],
        "solved": found.solved and list(found.solved),
        "is_monotone": found.is_monotone,
    }


def lines(found: Propagated) -> list[str]:
    """Return what follows from the uncertainties as lines of text."""
    value = si_text(found.value, found.u_num, found.unit)
    text = [
        f"uncertainty of {found.quantity} = {value} (fscm) from those of the file",
        "  d ln(value)/d ln(p) and contribution of each parameter p:",
    ]
    rows = [
        (
            one.name,
            one.uncertainty.written.strip(),
            "" if one.elasticity is None else f"{one.elasticity:+.4f}",
            _rounded(one.size, found.unit),
        )
        for one in found.contributions
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(3)]
    text += [f"    {a:{widths[0]}}  {b:{widths[1]}}  {c:>{widths[2]}}  {d}" for a, b, c, d in rows]
    if found.standard_deviation is not None:
        share = f" ({100 * found.standard_deviation / abs(found.value):.2g} %)" if found.value else ""
        text.append(
            f"  standard deviation {_rounded(found.standard_deviation, found.unit)}{share}, of independent parameters"
        )
    if found.range is not None:
        text += _range_lines(found.range, found.unit)
    return text


def _range_lines(found: Range, unit: str) -> list[str]:
    first = f"  range over the intervals {_ends(found.low, found.high, unit)} to first order"
    if found.solved is None:
        return [f"{first}; there is no value at its ends"]
    words = "" if found.is_monotone else ", but the slopes change their signs: the range may be wider"
    return [first, f"  {_ends(*found.solved, unit)} solved at its ends{words}"]


def _ends(low: float, high: float, unit: str) -> str:
    return f"{_rounded(low, unit, 5)} to {_rounded(high, unit, 5)}"


def _rounded(value: float, unit: str, digits: int = 3) -> str:
    return si_text(float(f"{value:.{digits}g}"), 0.0, unit)
