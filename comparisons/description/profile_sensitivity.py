"""Sensitivity of the pull-off force to the two choices that a measured profile needs: smoothing and continuation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.numerics.number_text import percent_text
from comparisons.problem.problem import Problem
from comparisons.problem.units import si_text
from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task, evaluate_task

__all__ = ["GROWTHS", "ProfileChange", "content", "lines", "profile_sensitivity"]

#: Factors on the smoothing, and the exponents of the continuation; one that the file has is left out.
_FACTORS, GROWTHS = (0.5, 2.0), (1.5, 3.0)

#: Exponent of a file that states none.
_GROWTH = 2.0


@dataclass(frozen=True, slots=True)
class ProfileChange:
    """Relative change of the pull-off force by another smoothing or growth.

    Attributes
    ----------
    key : str
        "smoothing" or "growth".
    value : float
        The other value: of the smoothing in m.
    change, bound : float or None
        Of the force; None unless the status is "ok".
    status, reason : str
        As of `Row`.

    Examples
    --------
    >>> ProfileChange("growth", 3.0, -0.01, 1e-6, "ok", "").key
    'growth'
    """

    key: str
    value: float
    change: float | None
    bound: float | None
    status: str
    reason: str


def profile_sensitivity(problem: Problem, force: Row) -> list[ProfileChange]:
    """Compute the pull-off force by the FSCM with half and double the smoothing, and with other exponents of growth.

    Parameters
    ----------
    problem : Problem
    force : Row
        Its pull-off force.

    Returns
    -------
    list of ProfileChange
        Empty if the punch is no table, or if there is no force.

    Examples
    --------
    >>> from comparisons import evaluate
    >>> from comparisons.problem import Section
    >>> solid = Section("power-law", {"E0": 70e9, "c0": 1.0, "k": 0.0, "nu": 0.2})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> sphere = Problem(solid, Section("sphere", {"R": 1e-6}), law)
    >>> profile_sensitivity(sphere, evaluate("atlas", "pull_off_force", sphere))
    []
    """
    if problem.punch.kind != "table" or force.value is None or force.u_num is None:
        return []
    found = []
    for key, value in _others(problem):
        other = problem.with_value("punch", key, value)
        # A failure with its reason where the other shape is not admissible.
        changed = evaluate_task(Task("fscm", "pull_off_force", other))
        change = bound = None
        if changed.value is not None and changed.u_num is not None:
            change = relative_difference(changed.value, force.value)
            bound = relative_uncertainty(changed.value, changed.u_num, force.value, force.u_num)
        found.append(ProfileChange(key, value, change, bound, changed.status, changed.reason))
    return found


def _others(problem: Problem) -> Iterator[tuple[str, float]]:
    smoothing = problem.punch.get("smoothing")
    if smoothing is not None:
        yield from (("smoothing", factor * smoothing) for factor in _FACTORS)
    yield from (("growth", growth) for growth in GROWTHS if growth != problem.punch.get("growth", _GROWTH))


def content(found: list[ProfileChange]) -> list[dict[str, Any]]:
    """Return the changes as objects of JSON; changes are fractions.

    Examples
    --------
    >>> content([ProfileChange("growth", 3.0, -0.01, 1e-6, "ok", "")])[0]["change"]
    -0.01
    """
    return [
        {
            "key": each.key,
            "value": each.value,
            "change": each.change,
            "u_num": each.bound,
            "status": each.status,
            "reason": each.reason,
        }
        for each in found
    ]


def lines(found: list[ProfileChange]) -> list[str]:
    """Return the changes as lines of text.

    Examples
    --------
    >>> lines([ProfileChange("growth", 3.0, -0.01, 1e-6, "ok", "")])[1]
    '    growth 3: -1.00000(10) %'
    """
    text = ["  change of the pull-off force with another choice for the measured profile:"]
    for each in found:
        value = si_text(float(f"{each.value:.6g}"), 0.0, "m" if each.key == "smoothing" else "1")
        if each.change is None or each.bound is None:
            text.append(f"    {each.key} {value}: {each.status}: {each.reason}")
        else:
            text.append(f"    {each.key} {value}: {percent_text(each.change, each.bound)} %")
    return text
