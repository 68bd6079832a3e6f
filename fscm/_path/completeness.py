r"""Test whether turning points of load or displacement may be missed between neighbouring points of the path.

At both points the value f (load or displacement) and its exact rate by the continuation parameter x are known.  They
define a cubic, whose rate is the straight line between the two rates plus a bulge 4 B t (1 - t), t from 0 to 1.  The
rate is assumed to lie within twice the bulge of that line.  If a rate inside that band can have more zeros than the
signs at its ends imply, both states are solved again on one mesh, and points are inserted until no rate can.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from fscm._path.arc_length import ArcLength, Point, parameter_control, parameter_of, rate_of, rates_of
from fscm._path.continuation import moved
from fscm._surface.adaptivity import adapted, on_mesh
from fscm._surface.anchors import AtEdge
from fscm._surface.mesh import PanelMesh
from fscm._surface.newton import STEP_TOLERANCE, newton
from fscm._surface.state import State
from fscm.errors import Failure, NotConverged
from fscm.punch import kinks_of

__all__ = ["completed", "least_loads", "may_hide"]

#: The bulge of the cubic is wrong by the fourth derivative of f, which the factor stands for.
_MARGIN = 2.0
#: Largest number of halvings of an interval, and the change of load or displacement that may then be missed in it,
#: relative to 1 + |f|: below the error of the meshes of the path.
_HALVINGS, _NEGLIGIBLE = 12, 1e-7
#: Places between two points where the load is bounded from below.
_PLACES = 65
#: A change below this is rounding: measured up to 2e-16 relative to 1 + |f| at contact initiation (n = 2, k = 0.98,
#: mu = 1), where load and displacement stay the same to 1e-14.
_ROUNDING = 1e-14
#: Resolution of the pressure on a punch with kinks, with which a mesh has to move: its square, as of an integral by
#: Gauss's rule, is far below _NEGLIGIBLE.
_FINE = 1e-5
#: Newton error relative to the error of the mesh, and the smallest step towards a midpoint, in units of its distance.
_NEWTON_MARGIN, _SMALLEST = 0.01, 1e-3
#: Last step of Newton's method where only the least load is sought; the remaining error is about its square.
_LAST_STEP = 1e-5

#: Rates whose zeros are the turning points of a path.
_RATES = ("load", "displacement")


@dataclass(frozen=True)
class _Test:
    """Arc length, resolution of the pressure, functionals that may turn, and tolerance of Newton's method."""

    arc: ArcLength
    tolerance: float
    names: tuple[str, ...]
    newton: float


def completed(
    points: list[Point], tolerance: float, below: float = math.inf, names: tuple[str, ...] = _RATES
) -> list[Point]:
    """The path with points inserted wherever turning points of load or displacement may be missed.

    Parameters
    ----------
    points : list of Point
    tolerance : float
        Resolution of the pressure on the path (see `_surface.adaptivity`).
    below : float
        Only where the load may fall below this value, and below that of both points: another minimum is not the least.
    names : tuple of str
        Functionals that may turn: "load", "displacement" or both.

    Raises
    ------
    NotConverged
        When it remains undecided whether turning points are missed.
    """
    newton_step = STEP_TOLERANCE if below == math.inf else _LAST_STEP
    test = _Test(ArcLength.of(points[0].state.disc.problem), tolerance, names, newton_step)
    complete = [points[0]]
    for a, b in pairwise(points):
        if a.segment == b.segment and _may_hide_any(a, b, names) and _may_be_below(a, b, below):
            between = _subdivided(*_on_common_mesh(a, b, test), test, _HALVINGS)
            counts = [sum(_turns(p, q, name) for p, q in pairwise(between)) for name in names]
            if counts != [_turns(a, b, name) for name in names]:
                complete += between[1:-1]
        complete.append(b)
    return complete


def _may_be_below(a: Point, b: Point, below: float) -> bool:
    """Whether the load between two points may be below a value and below both their loads."""
    if below == math.inf:
        return True
    least = min(a.state.load, b.state.load)
    return least_loads(a, b) < min(below, least - _NEGLIGIBLE * (1.0 + abs(least)))


def _parameter_rate(point: Point) -> float:
    return rate_of(point.rates, point.state.parameter)


def _rate(point: Point, name: str) -> float:
    """Derivative of load or displacement by the continuation parameter."""
    return float(getattr(point.rates, name) / _parameter_rate(point))


def _turns(a: Point, b: Point, name: str) -> bool:
    return _rate(a, name) * _rate(b, name) < 0.0


def may_hide(length: float, change: float, rate_a: float, rate_b: float) -> bool:
    """Whether there may be more turning points between two points than the signs of the two rates imply.

    Parameters
    ----------
    length : float
        Of the interval of the continuation parameter, with its sign.
    change : float
        Of load or displacement.
    rate_a, rate_b : float
        Rates at the two points.

    Examples
    --------
    A straight line has no turning point; x^3 - 0.1 x has two, between rates of 2.9 at its ends:

    >>> may_hide(1.0, 1.0, 1.0, 1.0), may_hide(2.0, 1.8, 2.9, 2.9)
    (False, True)
    """
    bulge = 4.0 * _MARGIN * 1.5 * abs(change / length - 0.5 * (rate_a + rate_b))
    if rate_a * rate_b <= 0.0:
        return abs(rate_b - rate_a) < bulge
    a, b = abs(rate_a), abs(rate_b)
    if abs(b - a) >= bulge:
        return False
    t = 0.5 * (1.0 - (b - a) / bulge)
    return a + (b - a) * t - bulge * t * (1.0 - t) <= 0.0


def least_loads(a: Point, b: Point) -> float:
    """Lower bound of the load between two points, over all rates inside the band."""
    if a.segment != b.segment:
        return min(a.state.load, b.state.load)
    x = _length(a, b)
    rate_a, rate_b = x * _rate(a, "load"), x * _rate(b, "load")
    bulge = 4.0 * _MARGIN * 1.5 * abs(_change(a, b, "load") - 0.5 * (rate_a + rate_b))
    # Integrals of the lower and of the upper rate from the first point, and to the last one.
    t = np.linspace(0.0, 1.0, _PLACES)
    line, more = rate_a * t + 0.5 * (rate_b - rate_a) * t**2, bulge * t**2 * (0.5 - t / 3.0)
    after = a.state.load + line - more
    before = b.state.load - (line[-1] - line) - (more[-1] - more)
    return float(np.min(np.maximum(after, before))) - _ROUNDING * (1.0 + abs(a.state.load))


def _length(a: Point, b: Point) -> float:
    return parameter_of(b.state) - parameter_of(a.state)


def _change(a: Point, b: Point, name: str) -> float:
    return float(getattr(b.state, name) - getattr(a.state, name))


def _may_hide_any(a: Point, b: Point, names: tuple[str, ...]) -> bool:
    return any(_may_hide(a, b, name) for name in names)


def _may_hide(a: Point, b: Point, name: str) -> bool:
    if _hidden(a, b, name) < _ROUNDING:
        return False
    return may_hide(_length(a, b), _change(a, b, name), _rate(a, name), _rate(b, name))


def _hidden(a: Point, b: Point, name: str) -> float:
    """Change of load or displacement that may be missed between two points, relative to 1 + |f|."""
    change = abs(_change(a, b, name) - 0.5 * _length(a, b) * (_rate(a, name) + _rate(b, name)))
    return float(1.5 * _MARGIN * change / (1.0 + abs(getattr(a.state, name))))


def _on_common_mesh(a: Point, b: Point, test: _Test) -> tuple[Point, Point]:
    """The two points on the mesh with the breaks of both, so that mesh errors cancel in their difference.

    With kinks there is no such mesh; each point is then resolved until its mesh error is negligible.
    """
    if _kinked(a):
        return _on_fine_mesh(a, test), _on_fine_mesh(b, test)
    mesh_a, mesh_b = a.state.disc.mesh, b.state.disc.mesh
    if a.state.disc is b.state.disc:
        return _solved_again(a, test), _solved_again(b, test)
    ends = np.union1d(mesh_a.offsets, mesh_b.offsets + (mesh_b.origin - mesh_a.origin))
    mesh = PanelMesh(ends, mesh_a.order, mesh_a.origin)
    guess_a = on_mesh(a.state, mesh)
    states = guess_a, replace(on_mesh(b.state, mesh), disc=guess_a.disc)
    solved = [newton(state, parameter_control(state, parameter_of(state)), test.newton) for state in states]
    return _point(solved[0], a, test), _point(solved[1], a, test)


def _solved_again(point: Point, test: _Test) -> Point:
    state = newton(point.state, parameter_control(point.state, parameter_of(point.state)), test.newton)
    return _point(state, point, test)


def _kinked(point: Point) -> bool:
    return bool(kinks_of(point.state.disc.problem.punch))


def _on_fine_mesh(point: Point, test: _Test) -> Point:
    state = adapted(point.state, parameter_control(point.state, parameter_of(point.state)), _FINE)
    return _point(state, point, test)


def _point(state: State, like: Point, test: _Test) -> Point:
    return Point(state, test.arc.tangent(state), like.segment)


def _middle(a: Point, b: Point, test: _Test) -> Point:
    """The state halfway in the continuation parameter, from the Hermite cubic as a guess."""
    x = _length(a, b)

    factor_a, factor_b = (1.0 / _parameter_rate(point) for point in (a, b))

    def middle(start: Any, end: Any, start_rate: Any, end_rate: Any) -> Any:
        return 0.5 * (start + end) + x / 8.0 * (factor_a * start_rate - factor_b * end_rate)

    scale = math.sqrt(a.state.scale * b.state.scale)
    displacement = middle(a.state.displacement, b.state.displacement, a.rates.displacement, b.rates.displacement)
    unknowns = middle(a.state.unknowns, b.state.unknowns, a.rates.unknowns, b.rates.unknowns)
    guess = replace(a.state, scale=scale, unknowns=unknowns, displacement=displacement)
    if isinstance(a.state.anchor, AtEdge):
        guess = guess.at_anchor(a.state.anchor.gap_at(a.state.disc.problem, a.state.scale))
    parameter = 0.5 * (parameter_of(a.state) + parameter_of(b.state))
    return _point(newton(guess, parameter_control(guess, parameter), test.newton), a, test)


def _reached_middle(a: Point, b: Point, test: _Test, tolerance: float) -> Point:
    """The state halfway, reached in steps from the first point with the mesh refined at each."""
    state, rates = a.state, a.rates.scaled(1.0 / _parameter_rate(a))
    middle = 0.5 * (parameter_of(a.state) + parameter_of(b.state))
    step = middle - parameter_of(state)
    while parameter_of(state) != middle:
        x = parameter_of(state)
        target = middle if abs(step) >= abs(middle - x) * (1.0 - 1e-9) else x + step
        try:
            new = moved(state, rates, target, _NEWTON_MARGIN * tolerance)
            state = adapted(new, parameter_control(new, target), tolerance)
        except NotConverged:
            step *= 0.5
            if abs(step) < _SMALLEST * abs(middle - parameter_of(a.state)):
                raise
            continue
        if target == middle:
            break
        rates = rates_of(state)
    return _point(state, a, test)


def _middle_on_any_mesh(a: Point, b: Point, test: _Test) -> Point:
    """The state halfway, on the mesh of the ends if that resolves it, else on a finer one."""
    if _kinked(a):
        return _reached_middle(a, b, test, _FINE)
    try:
        state = _middle(a, b, test).state
        state = adapted(state, parameter_control(state, parameter_of(state)), test.tolerance)
    except NotConverged:
        return _reached_middle(a, b, test, test.tolerance)
    return _point(state, a, test)


def _subdivided(a: Point, b: Point, test: _Test, halvings: int) -> list[Point]:
    """Points from a to b between which no turning point can be missed."""
    if not _may_hide_any(a, b, test.names):
        return [a, b]
    if halvings == 0:
        for name in test.names:
            if _hidden(a, b, name) > _NEGLIGIBLE:
                raise NotConverged(
                    f"the path of {a.state.disc.problem} may hide turning points of the {name} near "
                    f"delta = {a.state.displacement:.6g}, P = {a.state.load:.6g}",
                    Failure.FOLDS,
                )
        return [a, b]
    middle = _middle_on_any_mesh(a, b, test)
    halves = (a, middle), (middle, b)
    if middle.state.disc is not a.state.disc and not _kinked(a):
        # The mesh of the two ends does not resolve the edge between them: it would pin it, and make false folds.
        halves = _on_common_mesh(a, middle, test), _on_common_mesh(middle, b, test)
    left, right = (_subdivided(*half, test, halvings - 1) for half in halves)
    return [*left[:-1], *right]
