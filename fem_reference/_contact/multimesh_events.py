"""Events of a path whose states in contact lie on several meshes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from scipy.optimize import brentq

from fem_reference._contact.edge_states import EdgeStates
from fem_reference._contact.events import Pair, PathEvents, anchor_of, kind_of
from fem_reference._contact.hermite import Interval
from fem_reference._contact.multimesh_path import log_displacement_sample, log_load_sample
from fem_reference._contact.path import Point

__all__ = ["MultimeshEvents"]

#: Change of the logarithm of the radius for the slope of an interpolated function: it slows the secant method only.
SLOPE_STEP = 1e-3


class MultimeshEvents(PathEvents):
    """The events of a path, in contact those of the cubic through two neighbours and their rates.

    Parameters
    ----------
    approach : sequence of Point
        The complete path before contact, on one mesh.
    touching : sequence of Point
        As `fem_reference._contact.multimesh_path.multimesh_path` returns them.
    states : EdgeStates
        What solves on a mesh for each radius.
    """

    def __init__(self, approach: Sequence[Point], touching: Sequence[Point], states: EdgeStates) -> None:
        super().__init__((*approach, *touching))
        self._states = states
        self._slopes: dict[Point, float] = {}
        self._doubts: dict[str, float] = {}

    @property
    def points(self) -> Sequence[Point]:
        """The samples, which are complete."""
        return self.samples

    def between(self, a: Point, b: Point, parameter: float) -> Point:
        """Return the state at a parameter between two neighbours."""
        if not a.branch.touching:
            return super().between(a, b, parameter)
        rates = _interpolated(a, b, math.log(parameter)).rates
        return replace(self._states.at(parameter), rates=rates)

    def root(self, pair: Pair, function: Callable[[Point], float]) -> Point:
        """Find the point between two neighbours where the function vanishes."""
        a, b = pair
        if not a.branch.touching:
            return super().root(pair, function)

        def value(x: float) -> float:
            return function(_interpolated(a, b, x))

        x = float(brentq(value, math.log(a.parameter), math.log(b.parameter)))
        point = self.between(a, b, math.exp(x))
        self._slopes[point] = (value(x + SLOPE_STEP) - value(x - SLOPE_STEP)) / (2.0 * SLOPE_STEP * point.parameter)
        return point

    def slope(self, event: str, point: Point) -> float:
        """Return the derivative, at an event, of the function that vanishes there."""
        return self._slopes[point] if point.branch.touching else anchor_of(event, point)[1]

    def anchor(self, event: str) -> tuple[Point, float]:
        """Return the state at an event, and the slope there of the function that vanishes."""
        point = self.at(event)
        return point, self.slope(event, point)

    def take(self, event: str, point: Point, slope: float, doubt: float) -> None:
        """Set the state at an event to that on its own mesh, where the path has several within their errors."""
        (vars(self) if event == kind_of(event) else self._further)[event] = point
        self._slopes[point], self._doubts[event] = slope, doubt

    def doubt(self, event: str) -> float:
        """Return the relative error of the radius of the edge at an event."""
        return self._doubts.get(event, 0.0)


def _interpolated(a: Point, b: Point, x: float) -> Point:
    """A point with the load and displacement between two neighbours, and their rates."""
    load, displacement = (Interval(sample(a), sample(b), []) for sample in (log_load_sample, log_displacement_sample))
    y, radius = a.state.y.copy(), math.exp(x)
    y[-2] = displacement.value_at(x)
    rates = load.rate_at(x) / radius, displacement.rate_at(x) / radius
    return replace(a, parameter=radius, state=replace(a.state, y=y, load=load.value_at(x)), rates=rates)
