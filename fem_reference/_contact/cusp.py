"""Cusp of the path: the modulus at which the two folds of the displacement merge, and the point where they do.

At a fixed modulus the displacement delta is a function of the central gap H0 along the path, and g its derivative.  A
path without jumps has no zero of g, one with jumps has two, and between them lies the modulus at which g and dg/dH0
vanish at one point.  These are two equations for H0 and the logarithm of the modulus.  The central gap is the parameter
also where the contact edge exists, since the radius of the edge has a minimum near the cusp.  g and its first
derivatives are exact but for a central difference of the tangent; the second ones, which decide only how fast Newton's
method ends, are differences of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import linalg

from fem_reference._contact.completeness import load_scale
from fem_reference._contact.controls import CentralGap, GapRise, mesh_control
from fem_reference._contact.states import Branch, Point, point_at
from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged

__all__ = ["DisplacementRates", "cusp_from", "displacement_rates", "slowest", "slowest_sample"]

#: Change of y, in lengths of the law, for the derivative of the tangent: its error is 1e-10, as is that of rounding.
TANGENT_STEP = 1e-5

#: Change of the central gap, in lengths of the law, for the second derivatives: they are right to as much, and what a
#: step leaves falls by that factor.
NEIGHBOUR = 1e-3

#: Largest change of the central gap, in lengths of the law, and of the logarithm of the modulus in one step.
LARGEST_STEP, LARGEST_RATIO = 0.3, 0.2

#: Largest number of steps: from a sample of the path five are usual, from another mesh two.
STEPS = 25

#: Samples of a path on either side of the slowest one between which the displacement may be slower still, and the
#: spacing of the central gap there, in lengths of the law.
NEARBY, SPACING = 2, 0.08

#: Last step of the logarithm of the modulus, of which a thousandth is left, and of the central gap in lengths of the
#: law, on which the modulus does not depend to first order.
TOLERANCE, PLACE_TOLERANCE = 1e-9, 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class DisplacementRates:
    """Rate of the displacement at a point, and its derivatives.

    Attributes
    ----------
    value : float
        Derivative g of delta with respect to the parameter of the branch.
    along, modulus : float
        Derivatives of g with respect to the parameter and to the logarithm of the modulus.
    change : ndarray, shape (m + 2,)
        Derivative of y with respect to the logarithm of the modulus, at the same parameter.
    """

    value: float
    along: float
    modulus: float
    change: Array


def displacement_rates(point: Point) -> DisplacementRates:
    """Return the rate of the displacement at a point, with its derivatives."""
    contact, y, rate, t = point.branch.contact, point.state.y, point.state.rate, point.parameter
    factors = linalg.lu_factor(_tangent(point.branch, y, t), check_finite=False)
    adjoint = linalg.lu_solve(factors, np.eye(y.size)[-2], trans=1, check_finite=False)
    # The compliance is inversely proportional to the modulus: d(residual) = w, d(tangent) rate = that part of rate.
    change = -linalg.lu_solve(factors, _without_controls(y), check_finite=False)

    def twice(direction: Array, parameter_rate: float) -> float:
        """Return adjoint . (derivative of the tangent in a direction) . rate."""
        h = TANGENT_STEP * contact.law.z0 / float(np.abs(direction).max())
        after = _tangent(point.branch, y + h * direction, t + h * parameter_rate)
        before = _tangent(point.branch, y - h * direction, t - h * parameter_rate)
        return float(adjoint @ ((after - before) @ rate)) / (2.0 * h)

    modulus = -float(adjoint @ _without_controls(rate)) - twice(change, 0.0)
    return DisplacementRates(float(rate[-2]), -twice(rate, 1.0), modulus, change)


def slowest_sample(points: Sequence[Point]) -> int:
    """Return the index of the sample where the displacement is slowest relative to the load."""
    length = points[0].branch.contact.law.z0
    scale = load_scale(points)

    def relative(i: int) -> float:
        rate = points[i].displacement_rate / length
        return rate / math.hypot(rate, points[i].load_rate / scale)

    return min(range(len(points)), key=relative)


def slowest(points: Sequence[Point]) -> Point:
    """Return the point where the displacement is slowest relative to the load, to `SPACING` of the central gap.

    Parameters
    ----------
    points : sequence of Point
        A path.

    Returns
    -------
    Point
        Its parameter is the central gap; the path has jumps if delta rises with it there.

    Raises
    ------
    NotConverged
        If the path cannot be followed in the central gap there.
    """
    length = points[0].branch.contact.law.z0
    i = slowest_sample(points)
    point = _by_central_gap(points[max(i - NEARBY, 0)])
    final_gap = min(points[min(i + NEARBY, len(points) - 1)].state.central_gap, point.parameter)
    gaps = np.linspace(point.parameter, final_gap, 1 + math.ceil((point.parameter - final_gap) / (SPACING * length)))
    followed = [point]
    for H0 in gaps[1:]:
        followed.append(point_at(followed[-1], float(H0)))
    return max(followed, key=lambda point: point.state.displacement_rate)


def cusp_from(point: Point) -> Point:
    """Find the cusp from a point near it, on the same mesh.

    Parameters
    ----------
    point : Point
        On the path of a modulus near that of the cusp.

    Returns
    -------
    Point
        Its compliance has the modulus of the cusp, and its parameter is the central gap.

    Raises
    ------
    NotConverged
        If Newton's method does not find it.
    """
    point, unit = _by_central_gap(point), point.branch.contact.law.z0
    for _ in range(STEPS):
        rates = displacement_rates(point)
        h = NEIGHBOUR * unit
        shifted = displacement_rates(point.branch.solve(point.parameter + h, point.predict(point.parameter + h)))
        # The mixed derivative is that of the derivative by the modulus.
        jacobian = np.array(
            [[rates.along, rates.modulus], [(shifted.along - rates.along) / h, (shifted.modulus - rates.modulus) / h]]
        )
        step = -np.linalg.solve(jacobian, [rates.value, rates.along])
        if not np.all(np.isfinite(step)):
            break
        shift, ratio = np.clip(step, [-LARGEST_STEP * unit, -LARGEST_RATIO], [LARGEST_STEP * unit, LARGEST_RATIO])
        point = _moved(point, rates, float(shift), float(ratio))
        if abs(ratio) <= TOLERANCE and abs(shift) <= PLACE_TOLERANCE * unit:
            return point
    raise NotConverged(
        f"the modulus at which jumps begin was not found near delta = {point.state.displacement:.6g}", Failure.EVENT
    )


def _by_central_gap(point: Point) -> Point:
    """The same point on a branch whose parameter is the central gap."""
    contact, y = point.branch.contact, point.state.y
    fixed = mesh_control(contact, GapRise(GapRise(0.0).value(contact, y)))
    return Branch(contact, fixed, CentralGap, touching=False).solve(point.state.central_gap, y)


def _moved(point: Point, rates: DisplacementRates, shift: float, ratio: float) -> Point:
    """The point at another parameter and another logarithm of the modulus."""
    contact = point.branch.contact
    stiffer = replace(contact, compliance=contact.compliance.stiffened(math.exp(ratio)))
    y = point.predict(point.parameter + shift) + ratio * rates.change
    return replace(point.branch, contact=stiffer).solve(point.parameter + shift, y)


def _tangent(branch: Branch, y: Array, parameter: float) -> Array:
    """Derivative of the equations and both controls with respect to y, shape (m + 2, m + 2)."""
    contact = branch.contact
    rows = branch.fixed.gradient(contact, y), branch.family(parameter).gradient(contact, y)
    return np.vstack([contact.tangent(y), *rows])


def _without_controls(vector: Array) -> Array:
    """The vector with zeros in place of its last two entries."""
    return np.concatenate([vector[:-2], [0.0, 0.0]])
