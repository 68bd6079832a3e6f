"""Events of one case by each reference, as calls that a journal keeps."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import fem_reference
import fscm
from comparisons.graded_agreement.cases import QUANTITIES, AgreementCase
from comparisons.model import ComputationFailed
from comparisons.runs.code_files import code_in, files_digest

__all__ = ["ACCURACY", "finite_elements", "finite_elements_digest", "integral_equation", "integral_equation_digest"]

#: Accuracy of the finite elements.
ACCURACY = "default"

_ROOT = Path(__file__).resolve().parents[2]
#: What poses the problems.
_POSED = ("graded_agreement/cases.py", "graded_agreement/solving.py")
_FILES = {
    "fscm": ("problem/problem.py",),
    "fem_reference": ("problem/problem.py"),
}


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


def _digest(package: str) -> str:
    ours = [_ROOT / "comparisons" / name for name in (*_POSED, *_FILES[package])]
    atlas = _ROOT / "fscm" / "interpolation"
    return files_digest(_ROOT, [*(path for path in code_in(_ROOT / package) if path.parent != atlas), *ours])


def integral_equation_digest() -> str:
    """Return what identifies the code of `integral_equation`."""
    return _digest("fscm")


def finite_elements_digest() -> str:
    """Return what identifies the code of `finite_elements`."""
    return _digest("fem_reference")
