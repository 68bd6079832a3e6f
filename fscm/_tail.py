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

# Quadrature behind the mesh: pieces on which the radius grows by _FARTHER (less for steep punches), nodes of each.
_FARTHER, _PIECES, _QUADRATURE = 4.0, 3, 20
# A steeper punch overflows at _FARTHER times the radius; its tail is zero to all digits.
_STEEPEST = 150.0
# Height from which on the tail is zero: the tension there is below 1e-60 for m > 1.
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
    """Tail from the radius T on, at the approach delta.

    Parameters
    ----------
    problem : Problem
    T : float
        End of the mesh, in (Q z0)^(1/n).
    displacement : float
        delta, in z0; w is neglected there beside it.
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
        first, second = 1.0 / (m * g - power), m / ((m + 1.0) * g - power)
        # e falls like 1/F, hence like T^-g.
        return first - e * second, (power - m * g) * (first - e * second) + g * e * second, second / F

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
    """Errors of the closed tail: of its load, its displacement and its energy.

    The closed forms are compared with quadrature of the law itself, on the undeformed punch, over the next radii;
    behind them the closed forms are used again, and wrong by far less.

    Parameters
    ----------
    problem, T, displacement
        As for `tail_of`.

    Returns
    -------
    known : ndarray, shape (3,)
        Closed form less quadrature.
    remainder : ndarray, shape (3,)
        Bound on what is unknown behind the radii of the quadrature: the next term of the expansion, and what the shape
        and the law deviate from powers.  That of the energy is the part that differs between states.

    Examples
    --------
    >>> known, remainder = tail_errors(Problem(n=2, k=0, mu=1), 1414.0, 0.5)
    >>> bool(abs(known[0]) < 1e-15), bool(remainder[0] < 1e-6 * abs(known[0]))
    (True, True)
    """
    C, m = problem.law.decay
    if C == 0.0 or _height(problem, T) > _ZERO:
        return np.zeros(3), np.zeros(3)
    g, k = problem.punch.growth, problem.k
    rule = np.polynomial.legendre.leggauss(_QUADRATURE)
    ratio = _FARTHER ** min(1.0, 2.0 / g)
    far = T * ratio**_PIECES
    log_t = math.log(T) + math.log(ratio) * (np.arange(_PIECES)[:, None] + 0.5 * (1.0 + rule[0])).ravel()
    t = np.exp(log_t)
    weights = np.tile(0.5 * math.log(ratio) * rule[1], _PIECES) * t
    gap = problem.punch.height(t) - displacement
    pressure = problem.law.traction(gap)
    share = 1.0 if problem.response is None else problem.response.far(T)
    near = np.array(
        [
            2.0 * float((weights * t) @ pressure),
            problem.compliance * share * (1.0 - k) * float((weights * t**-k) @ pressure),
            2.0 * float((weights * t) @ problem.law.energy(gap)),
        ]
    )
    first, rest = tail_of(problem, T, displacement), tail_of(problem, far, displacement)
    energies = tail_energy(problem, T, displacement), tail_energy(problem, far, displacement)
    known = np.array([first.load - rest.load, first.displacement - rest.displacement, energies[0] - energies[1]]) - near

    F = _height(problem, far)
    e = (-displacement - problem.law.singular_gap) / F
    shape = abs(_height(problem, _FARTHER * far) / (F * _FARTHER**g) - 1.0) if g < _STEEPEST else 0.0
    exact = float(problem.law.traction(np.array([F - displacement]))[0])
    law = abs(exact / (-C * (F - displacement - problem.law.singular_gap) ** -m) - 1.0)
    relative = 0.5 * m * (m + 1.0) * e * e + m * shape + law
    work = abs(rest.load * (displacement + problem.law.singular_gap))
    remainder = np.array([abs(rest.load) * relative, abs(rest.displacement) * relative, work * (relative + m * abs(e))])
    return known, remainder


def tail_energy(problem: Problem, T: float, displacement: float) -> float:
    """int e(H) 2 r dr beyond the radius T, e = -C/(m-1) f^(1-m) (1 - (m-1) e/f).

    Its finite part when the integral diverges: the constant left out is the same for all states of a problem.

    Parameters
    ----------
    problem, T, displacement
        As for `tail_of`.
    """
    C, m = problem.law.decay
    F = _height(problem, T)
    if C == 0.0 or F > _ZERO:
        return 0.0
    g = problem.punch.growth
    excess = (m - 1.0) * g - 2.0
    leading = -math.log(T) if excess == 0.0 else 1.0 / excess
    shift = (-displacement - problem.law.singular_gap) / F
    return -2.0 * C / (m - 1.0) * F ** (1.0 - m) * T**2 * (leading - (m - 1.0) * shift / (m * g - 2.0))


def _height(problem: Problem, T: float) -> float:
    return float(problem.punch.height(np.array([T]))[0])
