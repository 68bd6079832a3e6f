"""Events of one case by each reference, as calls that a journal keeps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import fem_reference
import fscm
from comparisons.graded_agreement.cases import QUANTITIES, AgreementCase
from comparisons.model import ComputationFailed

__all__ = ["ACCURACY", "finite_elements", "integral_equation"]

#: Accuracy of the finite elements.
ACCURACY = "default"


def _events(found: Any, absent: type[Exception], units: Mapping[str, float]) -> dict[str, Any]:
    """By quantity [value, bound], or the reason why there is no such event."""
    return {
        name: str(one) if isinstance(one, absent) else [one.value / units[name], one.u_num / units[name]]
        for name, one in found.items()
    }


def integral_equation(solid: str, punch: str, mu: float) -> dict[str, Any]:
    """Return the events of a case by the integral equation, dimensionless.

    Examples
    --------
    >>> force = integral_equation("exponential-4", "sphere", 1.0)["pull_off_force"][0]
    >>> round(force, 4)
    1.6201
    """
    problem = AgreementCase(solid, punch, mu).problem.posed
    try:
        found = fscm.solve_together(problem, QUANTITIES)
    except fscm.NotConverged as failure:
        raise ComputationFailed(str(failure)) from failure
    return _events(found, fscm.NoSuchEvent, dict.fromkeys(QUANTITIES, 1.0))


def finite_elements(solid: str, punch: str, mu: float) -> dict[str, Any]:
    """Return the events of a case by the finite elements, in the same units."""
    problem = AgreementCase(solid, punch, mu).problem
    scales = problem.units
    try:
        found = fem_reference.solve_together(problem.build(fem_reference), QUANTITIES, ACCURACY)
    except fem_reference.NotConverged as failure:
        raise ComputationFailed(str(failure)) from failure
    units = {name: scales["load" if name.endswith("force") else "displacement"] for name in QUANTITIES}
    return _events(found, fem_reference.NoSuchEvent, units)
