"""Path of a solid that does not scale: before contact on one mesh, then a mesh for each radius of the contact edge.

A state on a mesh that resolves its edge is that of the problem.  Its neighbours tell its rates, and two of them decide
whether there are turning points between them, as on one mesh.  The path goes on until load and displacement rise, the
load is compressive, and neither can turn back at a larger radius (`fem_reference._contact.jkr_tension`): a stiff layer
on a soft solid has one minimum of the load where the layer alone feels the contact, and another where the solid does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from fem_reference._contact.completeness import complete_branch
from fem_reference._contact.edge_states import EdgeStates
from fem_reference._contact.events import Anchor, Pair, PathEvents, kind_of
from fem_reference._contact.hermite import Interval, Sample
from fem_reference._contact.path import BESIDE
from fem_reference._contact.states import Point, branches_of
from fem_reference._typing import Array

__all__ = ["FARTHER", "EventsOfEdgePath", "edge_path", "with_rates"]

#: Change of the logarithm of the radius from one state to the next. The test of turning points asks for none between on
#: cones at mu = 3 whose modulus falls to a fifth below the surface, and each state is found from the last.
LOG_STEP = 0.2

#: Change of delta in lengths of the law, and of P relative to the largest tension, below which two turning points are
#: not told from none. It is above what the meshes of the search leave of a state: at most 6e-5 of the largest tension
#: (measured between the degrees 4 and 6 under a cone at mu = 3 on a solid whose modulus falls to a third).
LARGEST_CHANGE = 1e-4

#: States that give the rate of one of them: the polynomial through five at a step of 0.2 has it to 4e-3 of the largest
#: tension (measured as for `with_rates`).
RATE_POINTS = 5

#: Ratio of the last radius to that beyond which neither load nor displacement turns back in the limit of a short range
#: of the law: its elements are a third of it long, and the range of the law moves the extremes by less.
FARTHER = 1.5

#: Change of the logarithm of the radius for the slope of an interpolated function: it slows the secant method only.
SLOPE_STEP = 1e-3


def edge_path(
    states: EdgeStates, inner: float, last_turn: float, kinks: Sequence[float], highest: float
) -> list[Point]:
    """Return states in contact, so close that no pair of turning points is between two.

    Parameters
    ----------
    states : EdgeStates
    inner : float
        Radius of the first contact edge.
    last_turn : float
        Radius beyond which neither load nor displacement can turn back.
    kinks : sequence of float
        Radii where the slope of the punch jumps, and with it the rates along the path.
    highest : float
        Largest displacement before contact: the path goes on beyond it, where a jump from there ends.

    Raises
    ------
    NotConverged
        If a state is not found, or turning points cannot be excluded.
    """
    points: list[Point] = []
    for radius in _radii(inner, kinks):
        points.append(states.at(radius))
        if radius >= FARTHER * last_turn and len(points) >= RATE_POINTS and _settled(points, highest):
            break
    length = points[0].branch.contact.law.z0
    tension = abs(min(point.state.load for point in points))
    tests = ((_log_displacement_sample, LARGEST_CHANGE * length), (_log_load_sample, LARGEST_CHANGE * tension))
    return [
        point
        for branch in branches_of(points)
        for point in complete_branch(
            with_rates(branch), tests, lambda _, log_radius: states.at(math.exp(log_radius)), with_rates
        )
    ]


def _log_displacement_sample(point: Point) -> Sample:
    """Displacement and its rate along the path in the logarithm of the radius."""
    return Sample(math.log(point.parameter), point.state.displacement, point.displacement_rate * point.parameter)


def _log_load_sample(point: Point) -> Sample:
    """Load and its rate along the path in the logarithm of the radius."""
    return Sample(math.log(point.parameter), point.state.load, point.load_rate * point.parameter)


def with_rates(points: list[Point]) -> list[Point]:
    """Give the states of one branch the rates of the polynomial through each and its neighbours.

    The rates of a state on its own mesh are those of an edge that moves over the elements: 1e-5 of a load within an
    element, which is a hundredth of the radius or less, are 1e-2 of its rate (measured: 0.16 for a coating of 1 GPa and
    100 nm on 1.5 MPa, whose loads follow each other to 4e-3).
    """
    x = np.log([point.parameter for point in points])
    values = np.array([[point.state.load, point.state.displacement] for point in points])
    renewed = []
    for i, point in enumerate(points):
        start = min(max(i - RATE_POINTS // 2, 0), max(len(points) - RATE_POINTS, 0))
        stencil = slice(start, start + RATE_POINTS)
        rates = _derivative_weights(x[stencil], x[i]) @ values[stencil] / point.parameter
        renewed.append(replace(point, rates=(float(rates[0]), float(rates[1]))))
    return renewed


def _derivative_weights(x: Array, at: float) -> Array:
    """Weights of values at x in the derivative of the polynomial through them."""
    unit = float(np.ptp(x)) or 1.0
    powers = np.vander((x - at) / unit, increasing=True).T
    return np.linalg.solve(powers, np.eye(x.size)[min(1, x.size - 1)] * (x.size > 1)) / unit


def _radii(inner: float, kinks: Sequence[float]) -> Iterator[float]:
    """Radii from the first contact edge on, and both sides of each kink."""
    radius = inner
    while True:
        yield radius
        following = radius * math.exp(LOG_STEP)
        for kink in sorted(kink for kink in kinks if radius * (1.0 + 2.0 * BESIDE) < kink < following):
            yield kink * (1.0 - BESIDE)
            yield kink * (1.0 + BESIDE)
        radius = following


def _settled(points: Sequence[Point], highest: float) -> bool:
    """Whether the load is compressive, and load and displacement have risen beyond every fold."""
    previous, newest = points[-2].state, points[-1].state
    rising = newest.load > max(previous.load, 0.0) and newest.displacement > previous.displacement
    folds = [a.state.displacement for a, b in pairwise(points) if b.state.displacement < a.state.displacement]
    return rising and newest.displacement >= max(highest, *folds, previous.displacement)


class EventsOfEdgePath(PathEvents):
    """The events of a path, in contact those of the cubic through two neighbours and their rates.

    Parameters
    ----------
    approach : sequence of Point
        The complete path before contact, on one mesh.
    touching : sequence of Point
        As `edge_path` returns them.
    states : EdgeStates
        What solves on a mesh for each radius.
    """

    def __init__(self, approach: Sequence[Point], touching: Sequence[Point], states: EdgeStates) -> None:
        super().__init__((*approach, *touching))
        self._states = states
        self._slopes: dict[Point, float] = {}

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
        return self._slopes[point] if point.branch.touching else super().slope(event, point)

    def relocate(self, event: str, anchor: Anchor) -> None:
        """Move an event to its state on the mesh that is fine at its edge, which the path has within its error."""
        (vars(self) if event == kind_of(event) else self._further)[event] = anchor.point
        self._slopes[anchor.point], self._anchors[event] = anchor.slope, anchor


def _interpolated(a: Point, b: Point, x: float) -> Point:
    """A point with the load and displacement between two neighbours, and their rates."""
    load, displacement = (Interval(sample(a), sample(b), []) for sample in (_log_load_sample, _log_displacement_sample))
    y, radius = a.state.y.copy(), math.exp(x)
    y[-2] = displacement.value_at(x)
    rates = load.rate_at(x) / radius, displacement.rate_at(x) / radius
    return replace(a, parameter=radius, state=replace(a.state, y=y, load=load.value_at(x)), rates=rates)
