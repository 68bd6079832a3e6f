"""Contributions of the radii beyond the mesh to load, displacement and energy, in closed form.

Beyond the last node, at the radius T, the height f is so large that p = -C f^-m (1 - m e/f), with
e = w - delta - singular gap.  There f grows as F (t/T)^g, and every integral is one of a power.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fscm._typing import Array
from fscm.problem import Problem

__all__ = ["Tail", "tail_energy", "tail_errors", "tail_of"]

#: Quadrature behind the mesh: pieces on which the radius grows by _FARTHER (less for steep punches), nodes of each.
_FARTHER, _PIECES = 4.0, 3
_GAUSS = np.polynomial.legendre.leggauss(20)
#: A steeper punch overflows at _FARTHER times the radius; its tail is negligible.
_STEEPEST = 150.0
#: Rounding of a number of pieces.
_SAME = 1e-9
#: Approximate height above which the energy takes the punch for a power of the radius; a rounded cone is one to 1e-12.
_FARTHEST = 1e12
#: Height above which the tail is neglected: the tension there is below 1e-60 for m > 1.
_ZERO = 1e60


@dataclass(frozen=True)
class Tail:
    """Load and displacement from radii beyond the mesh, and their exact derivatives.

    Attributes
    ----------
    load, load_rate, load_slope : float
        Part of P, dimensionless (unit of Eq. 31); its derivatives by log c and by delta.
    displacement, displacement_rate, displacement_slope : float
        Part of w, in z0, the same at every radius of the mesh; its derivatives by log c and by delta.
    """

    load: float
    displacement: float
    load_rate: float
    displacement_rate: float
    load_slope: float
    displacement_slope: float


def tail_of(problem: Problem, T: float, displacement: float) -> Tail:
    """Tail beyond the radius T, at the displacement delta.

    Parameters
    ----------
    problem : Problem
    T : float
        End of the mesh, in (Q z0)^(1/n).
    displacement : float
        delta, in z0; w is neglected.
    """
    C, m = problem.law.decay
    F = _height(problem, T)
    if C == 0.0 or F > _ZERO:
        return Tail(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    g, k = problem.punch.growth, problem.k
    e = (-displacement - problem.law.singular_gap) / F
    strength = C * F**-m

    def powers(power: float) -> tuple[float, float, float]:
        """-int of t^(power-1) p from T on, over C F^-m T^power; its derivatives by log T and by delta."""
        leading, following = 1.0 / (m * g - power), m / ((m + 1.0) * g - power)
        # e falls like 1/F, hence like T^-g.
        return leading - e * following, (power - m * g) * (leading - e * following) + g * e * following, following / F

    load_factor = -2.0 * strength * T**2
    w_factor = -problem.compliance * (1.0 - k) * strength * T ** (1.0 - k)
    if problem.response is not None:
        w_factor *= problem.response.far(T)
    (load, load_rate, load_slope), (w, w_rate, w_slope) = powers(2.0), powers(1.0 - k)
    return Tail(
        load_factor * load,
        w_factor * w,
        load_factor * load_rate,
        w_factor * w_rate,
        load_factor * load_slope,
        w_factor * w_slope,
    )


def tail_errors(problem: Problem, T: float, displacement: float) -> tuple[Array, Array]:
    """Errors of load, displacement and energy of the closed tail.

    The closed forms are compared with quadrature of the law, on the undeformed punch, over the next radii; beyond,
    the closed forms have a much smaller error.

    Parameters
    ----------
    problem, T, displacement
        As for `tail_of`.

    Returns
    -------
    computed : ndarray, shape (3,)
        Closed form minus quadrature; the energy, which is by quadrature, is compared with a finer one.
    remainder : ndarray, shape (3,)
        Bound on the error beyond the quadrature: the next term of the expansion, and the deviations of shape and law
        from powers.  That of the energy is the part that differs between states.

    Examples
    --------
    >>> computed, remainder = tail_errors(Problem(n=2, k=0, mu=1), 1414.0, 0.5)
    >>> bool(abs(computed[0]) < 1e-15), bool(remainder[0] < 1e-6 * abs(computed[0]))
    (True, True)
    """
    C, m = problem.law.decay
    if C == 0.0 or _height(problem, T) > _ZERO:
        return np.zeros(3), np.zeros(3)
    g, k = problem.punch.growth, problem.k
    far = T * math.exp(_PIECES * _log_ratio(g))
    t, weights = _quadrature(T, far, g)
    pressure = problem.law.traction(problem.punch.height(t) - displacement)
    share = 1.0 if problem.response is None else problem.response.far(T)
    quadrature = np.array(
        [
            2.0 * float((weights * t) @ pressure),
            problem.compliance * share * (1.0 - k) * float((weights * t**-k) @ pressure),
        ]
    )
    closed, beyond = tail_of(problem, T, displacement), tail_of(problem, far, displacement)
    computed = np.array([closed.load - beyond.load, closed.displacement - beyond.displacement]) - quadrature
    of_energy = tail_energy(problem, T, displacement) - _tail_energy(problem, T, displacement, 2)

    relative, _ = _deviations(problem, far, displacement)
    remainder = np.array([abs(beyond.load), abs(beyond.displacement)]) * relative
    farthest = _farthest(problem)
    relative, e = _deviations(problem, farthest, displacement)
    work = abs(tail_of(problem, farthest, displacement).load * (displacement + problem.law.singular_gap))
    return np.append(computed, of_energy), np.append(remainder, work * (relative + m * abs(e)))


def _deviations(problem: Problem, far: float, displacement: float) -> tuple[float, float]:
    """Relative error of the closed forms beyond a radius, and the small parameter of the expansion there."""
    C, m = problem.law.decay
    g = problem.punch.growth
    F = _height(problem, far)
    e = (-displacement - problem.law.singular_gap) / F
    shape = abs(_height(problem, _FARTHER * far) / (F * _FARTHER**g) - 1.0) if g < _STEEPEST else 0.0
    exact = float(problem.law.traction(np.array([F - displacement]))[0])
    closed = -C * (F - displacement - problem.law.singular_gap) ** -m
    law = abs(exact / closed - 1.0) if closed else 0.0
    return 0.5 * m * (m + 1.0) * e * e + m * shape + law, e


def tail_energy(problem: Problem, T: float, displacement: float) -> float:
    """int e(H) 2 r dr beyond the radius T on the undeformed punch.

    The finite part if the integral diverges: the omitted constant is the same for all states of a problem, wherever
    their meshes end, because the power of the punch is taken at one radius for all of them.

    Parameters
    ----------
    problem, T, displacement
        As for `tail_of`.
    """
    return _tail_energy(problem, T, displacement, 1)


def _tail_energy(problem: Problem, T: float, displacement: float, cuts: int) -> float:
    """The same, with each piece of the quadrature divided by `cuts`."""
    C, m = problem.law.decay
    if C == 0.0 or _height(problem, T) > _ZERO:
        return 0.0
    g, far = problem.punch.growth, _farthest(problem)
    power = _height(problem, far) / far**g
    shift = -displacement - problem.law.singular_gap

    def leading(f: Array) -> Array:
        return -C / (m - 1.0) * f ** (1.0 - m) * (1.0 - (m - 1.0) * shift / f)

    # The law on the shape minus the leading terms on a power of the radius, from T to where the shape is a power.
    t, weights = _quadrature(T, far, g, cuts)
    exact = problem.law.energy(problem.punch.height(t) - displacement)
    deviation = 2.0 * float((weights * t) @ (exact - leading(power * t**g)))
    excess = (m - 1.0) * g - 2.0
    closed = -math.log(T) if excess == 0.0 else 1.0 / excess
    F = power * T**g
    size = -2.0 * C / (m - 1.0) * power ** (1.0 - m) * T**-excess
    return deviation + size * (closed - (m - 1.0) * shift / F / (m * g - 2.0))


def _quadrature(start: float, stop: float, growth: float, cuts: int = 1) -> tuple[Array, Array]:
    """Radii and weights from one radius to another, also inwards."""
    x, w = _GAUSS
    length = math.log(stop / start)
    pieces = cuts * max(1, math.ceil(abs(length) / _log_ratio(growth) - _SAME))
    half = 0.5 * length / pieces
    t = start * np.exp(half * (2.0 * np.arange(pieces)[:, None] + 1.0 + x).ravel())
    return t, half * np.tile(w, pieces) * t


def _log_ratio(growth: float) -> float:
    """Logarithm of the ratio of the radii at the ends of a piece."""
    return math.log(_FARTHER) * min(1.0, 2.0 / growth)


def _farthest(problem: Problem) -> float:
    """Radius beyond which the energy takes the punch for a power of the radius."""
    return float(_FARTHEST ** (1.0 / problem.punch.growth))


def _height(problem: Problem, T: float) -> float:
    return float(problem.punch.height(np.array([T]))[0])
