"""The registry of what can be asked besides numbers: curves, one row a kind.

The points of a shape are stored with a bound on their own distance from the exact curve, in the plane in
which both axes are scaled by the range of the curve (see `comparisons.numerics.curve_distance`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.model import Curve, HasCurve, HasProfile, Model, NotApplicable, RadialField
from fscm.problem import Problem

__all__ = ["SHAPES", "Points", "Shape", "near", "traced"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Points:
    """Points in the order of the curve, dimensionless, and the bound on their distance from it."""

    x: list[float]
    y: list[float]
    u_distance: float


@dataclass(frozen=True, slots=True)
class Shape:
    """A kind of curve: name, what is on its axes, their units, and how a model is asked for it."""

    name: str
    x: str
    y: str
    unit: str
    meaning: str
    ask: Callable[[Model, Problem], Points]


def traced(model: Model, problem: Problem) -> Curve:
    """Return the force-displacement curve of a model, or raise `NotApplicable` or `ComputationFailed`.

    Examples
    --------
    >>> from comparisons.registry import create
    >>> curve = traced(create("bradley"), Problem(n=2, k=0, mu=0.1))
    >>> round(float(curve.load.min()), 3)
    -2.0
    """
    if not isinstance(model, HasCurve):
        raise NotApplicable("the model has no force-displacement curve")
    return model.curve(problem)


def _force_curve(model: Model, problem: Problem) -> Points:
    curve = traced(model, problem)
    return _points(curve.displacement, curve.load, curve.u_distance)


def _pull_off_profile(model: Model, problem: Problem) -> RadialField:
    if not isinstance(model, HasProfile):
        raise NotApplicable("the model does not know the surface at pull-off")
    return model.pull_off_profile(problem)


def _pull_off_pressure(model: Model, problem: Problem) -> Points:
    profile = _pull_off_profile(model, problem)
    return _points(*near(profile.gap, profile.radius, profile.pressure), profile.u_distance)


def _pull_off_gap(model: Model, problem: Problem) -> Points:
    profile = _pull_off_profile(model, problem)
    return _points(*near(profile.gap, profile.radius, profile.gap), profile.u_gap_distance)


#: Profiles are stored out to this gap, in z0, where the traction has fallen to 0.2 % of its largest.
FARTHEST_GAP = 10.0


def near(gap: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Return the points of a profile out to the gap `FARTHEST_GAP`.

    Examples
    --------
    >>> near(np.array([0.0, 9.0, 11.0]), np.array([0.1, 4.0, 5.0]), np.array([-1.0, -0.1, 0.0]))[0].tolist()
    [0.1, 4.0]
    """
    inside = gap <= FARTHEST_GAP
    return x[inside], y[inside]


def _points(x: Array, y: Array, u_distance: float) -> Points:
    return Points([float(a) for a in x], [float(b) for b in y], float(u_distance))


SHAPES: dict[str, Shape] = {
    shape.name: shape
    for shape in (
        Shape(
            "force_curve",
            "displacement",
            "load",
            "z0; pi Q^(2/n) dgamma z0^(2/n-1)",
            "equilibrium path, from far away into contact",
            _force_curve,
        ),
        Shape(
            "pull_off_pressure",
            "radius",
            "pressure",
            "(Q z0)^(1/n); dgamma / z0",
            "pressure over the radius where P is smallest; tension negative",
            _pull_off_pressure,
        ),
        Shape(
            "pull_off_gap",
            "radius",
            "gap",
            "(Q z0)^(1/n); z0",
            "gap over the radius where P is smallest",
            _pull_off_gap,
        ),
    )
}
