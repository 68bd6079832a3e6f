"""The points of the curves and fields of a model.

They are stored with a bound on their own distance from the exact curve, in the plane in which both axes are
scaled by the range of the curve (see `comparisons.numerics.curve_distance`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from comparisons.model import HasCurve, HasProfile, Model, NotApplicable, RadialField
from comparisons.quantities.quantity import Points

if TYPE_CHECKING:
    from comparisons.problem.problem import Problem

__all__ = ["FARTHEST_GAP", "force_curve", "near", "pull_off_gap", "pull_off_pressure"]

Array = NDArray[np.float64]

#: Profiles are stored out to this gap, in z0, where the traction has fallen to 0.2 % of its largest.
FARTHEST_GAP = 10.0


def force_curve(model: Model, problem: Problem) -> Points:
    """Return the force-displacement curve of a model, or raise `NotApplicable` or `ComputationFailed`.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> from comparisons.registry import create
    >>> round(min(force_curve(create("bradley"), Problem.dimensionless(n=2, k=0, mu=0.1)).y), 3)
    -2.0
    """
    if not isinstance(model, HasCurve):
        raise NotApplicable("the model has no force-displacement curve")
    curve = model.curve(problem)
    return _points(curve.displacement, curve.load, curve.u_distance, curve.columns)


def pull_off_pressure(model: Model, problem: Problem) -> Points:
    """Return the pressure over the radius where P is smallest."""
    profile = _pull_off_profile(model, problem)
    return _points(*near(profile.gap, profile.radius, profile.pressure), profile.u_distance)


def pull_off_gap(model: Model, problem: Problem) -> Points:
    """Return the gap over the radius where P is smallest."""
    profile = _pull_off_profile(model, problem)
    return _points(*near(profile.gap, profile.radius, profile.gap), profile.u_gap_distance)


def _pull_off_profile(model: Model, problem: Problem) -> RadialField:
    if not isinstance(model, HasProfile):
        raise NotApplicable("the model does not know the surface at pull-off")
    return model.pull_off_profile(problem)


def near(gap: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Return the points of a profile out to the gap `FARTHEST_GAP`.

    Examples
    --------
    >>> near(np.array([0.0, 9.0, 11.0]), np.array([0.1, 4.0, 5.0]), np.array([-1.0, -0.1, 0.0]))[0].tolist()
    [0.1, 4.0]
    """
    inside = gap <= FARTHEST_GAP
    return x[inside], y[inside]


def _points(x: Array, y: Array, u_distance: float, columns: dict[str, Array] | None = None) -> Points:
    return Points([float(a) for a in x], [float(b) for b in y], float(u_distance), columns or {})
