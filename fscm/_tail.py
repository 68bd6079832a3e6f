"""Contributions of the radii beyond the mesh to load, displacement and energy, in closed form.

Beyond the last node, at the radius T, the height f is so large that p = -C f^-m (1 - m e/f), with
e = w - delta - singular gap.  There f grows as F (t/T)^g, and every integral is one of a power.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fscm.problem import Problem

__all__ = ["Tail", "tail_energy", "tail_of", "tail_uncertainty"]

# Beyond this multiple of the end radius the tail carries too little for the shape to matter.
_FARTHER = 4.0
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
    (load, load_rate, load_slope), (w, w_rate, w_slope) = powers(2.0), powers(1.0 - k)
    return Tail(
        load_factor * load,
        w_factor * w,
        load_factor * load_rate,
        w_factor * w_rate,
        load_factor * load_slope,
        w_factor * w_slope,
    )


def tail_uncertainty(problem: Problem, T: float, displacement: float, tail: Tail) -> float:
    """Bound on the error of the closed tail, on its load and on its displacement, whichever is larger.

    It is the next term of the expansion, and what the shape deviates from a power between T and 4 T.

    Parameters
    ----------
    problem, T, displacement
        As for `tail_of`.
    tail : Tail
        At that radius and displacement.
    """
    C, m = problem.law.decay
    F = _height(problem, T)
    if C == 0.0 or F > _ZERO:
        return 0.0
    e = (-displacement - problem.law.singular_gap) / F
    deviation = abs(_height(problem, _FARTHER * T) / (F * _FARTHER**problem.punch.growth) - 1.0)
    return (0.5 * m * (m + 1.0) * e * e + m * deviation) * max(abs(tail.load), abs(tail.displacement))


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
