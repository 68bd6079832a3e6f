r"""Surface law in a liquid (Derjaguin, Landau, Verwey, Overbeek): van der Waals forces and an electric double layer.

Two faces at the distance D between their atoms push each other by

    p(D) = A/(6 pi) (z0^6 D^-9 - D^-3) + P exp(-D/L)

with the Hamaker constant A, the distance z0 at which wall and attraction alone are in balance, and the pressure P of
the double layer, which decays over the Debye length L (J. N. Israelachvili, Intermolecular and Surface Forces, 3rd ed.,
chapter 14: P = 64 k T rho tanh^2(e psi/(4 k T)), and P = Z/(2 pi L^2) with his constant Z).  Without a double layer it
is the 9-3 law with the work of adhesion A/(16 pi z0^2).

With x = D/z0 the traction has the sign of 1 - x^6 + b x^9 exp(-x/l), b = 6 pi z0^3 P/A, l = L/z0.  That turns where
b exp(-x/l) x^3 (9 - x/l) = 6, whose left side rises to x = (13 - sqrt(61))/2 l and falls to 9 l: there are at most two
turns and three gaps without traction, two of them wells with the barrier between.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from fscm._roots import bracketed_root
from fscm._typing import Array
from fscm._validation import real_number

__all__ = ["Dlvo"]

#: Largest exp(-x/l) x^3 (9 - x/l) is at the first of these times l, and that of exp(-x/l) x^4 (10 - x/l) at the second.
_TURN, _TURN_OF_SLOPE = 0.5 * (13.0 - math.sqrt(61.0)), 0.5 * (15.0 - math.sqrt(65.0))
#: Least distance that is examined, in z0: the wall exceeds the attraction there by a factor of 1e6.
_NEAREST = 0.1
#: Tolerance of roots: four roundings.
_ROUNDING = 2.0**-50


@dataclass(frozen=True, slots=True)
class Dlvo:
    """The 9-3 law with the repulsion of a double layer, p = A/(6 pi) (z0^6 D^-9 - D^-3) + P exp(-D/L).

    Parameters
    ----------
    hamaker_constant : float
        A of the two bodies across the liquid, an energy > 0.
    z0 : float
        Distance without traction of wall and attraction alone, a length > 0: the range of the law.
    double_layer : float
        Pressure P of the double layer at D = 0, >= 0.
    debye_length : float
        Decay length L of the double layer, > 0.

    Attributes
    ----------
    distance : float
        D of the deepest well.  There the gap H is zero, H = D - `distance`.
    work_of_adhesion : float
        Energy per area to separate the faces from there.
    equilibrium_distances : tuple of float
        Distances without traction: a well, or two with the barrier between.
    peak_gap : float
        Gap of the largest tension.

    Raises
    ------
    ValueError
        When a parameter is outside its range.

    Examples
    --------
    A barrier between two wells, and the 9-3 law without it:

    >>> law = Dlvo(hamaker_constant=16.0 * np.pi, z0=1.0, double_layer=8.0 / 3.0, debye_length=1.0)
    >>> [round(distance, 4) for distance in law.equilibrium_distances]
    [1.1033, 1.8121, 4.5367]
    >>> from fscm import LennardJones
    >>> bare = Dlvo(hamaker_constant=16.0 * np.pi, z0=1.0, double_layer=0.0, debye_length=1.0)
    >>> float(bare.traction(np.array(1.0)) - LennardJones().traction(np.array(1.0)))
    0.0
    """

    hamaker_constant: float
    z0: float
    double_layer: float
    debye_length: float
    distance: float = field(init=False, compare=False)
    work_of_adhesion: float = field(init=False, compare=False)
    equilibrium_distances: tuple[float, ...] = field(init=False, compare=False)
    peak_gap: float = field(init=False, compare=False)

    def __post_init__(self) -> None:
        for name in ("hamaker_constant", "z0", "debye_length"):
            value = real_number(name, getattr(self, name), low=0.0, high=math.inf, reason="it is a positive quantity")
            object.__setattr__(self, name, value)
        reason = "the double layer of two like bodies repels; give an attractive one as a table"
        value = real_number("double_layer", self.double_layer, low=0.0, high=math.inf, reason=reason, closed_low=True)
        object.__setattr__(self, "double_layer", value)
        zeros = _roots(lambda x: self._scaled(x, 0), self._turns(_TURN, 9.0, 3, 0))
        deepest = max(zeros[::2], key=lambda x: self._scaled(x, -1))
        turns = _roots(lambda x: self._scaled(x, 1), self._turns(_TURN_OF_SLOPE, 10.0, 4, 1))
        peak = min(turns, key=lambda x: self._scaled(x, 0))
        object.__setattr__(self, "equilibrium_distances", tuple(x * self.z0 for x in zeros))
        object.__setattr__(self, "distance", deepest * self.z0)
        object.__setattr__(self, "work_of_adhesion", float(self._scaled(deepest, -1)) * self._unit * self.z0)
        object.__setattr__(self, "peak_gap", (peak - deepest) * self.z0)

    @property
    def _unit(self) -> float:
        """A/(6 pi z0^3), the unit of the traction."""
        return self.hamaker_constant / (6.0 * math.pi * self.z0**3)

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at D = 0."""
        return -self.distance

    @property
    def decay(self) -> tuple[float, float]:
        """Tension -A/(6 pi) H^-3 at large gaps."""
        return self.hamaker_constant / (6.0 * math.pi), 3.0

    def traction(self, H: Array) -> Array:
        """p(H)."""
        return self._derivative(H, 0)

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        return self._derivative(H, 1)

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        return self._derivative(H, 2)

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, A/(12 pi) (z0^6 D^-8/4 - D^-2) + P L exp(-D/L)."""
        return -self._derivative(H, -1)

    def _derivative(self, H: Array, order: int) -> Array:
        x = (np.asarray(H, float) + self.distance) / self.z0
        return np.asarray(self._scaled(x, order) * (self._unit / self.z0**order))

    def _scaled(self, x: Any, order: int) -> Any:
        """Derivative by x of p/unit = x^-9 - x^-3 + b exp(-x/l); order -1 is the primitive, 0 at infinity."""
        b, length = self.double_layer / self._unit, self.debye_length / self.z0
        return _power(x, 9.0, order) - _power(x, 3.0, order) + b * (-length) ** -order * np.exp(-x / length)

    def _turns(self, most: float, end: float, power: int, order: int) -> list[float]:
        """Distances over z0 where a derivative of p, times x^(9 + order), turns."""
        b, length = self.double_layer / self._unit, self.debye_length / self.z0
        if b == 0.0:
            return []
        # b l^(3) e^-u u^3 (9 - u) = 6 for the traction, b l^3 e^-u u^4 (10 - u) = 18 for its slope.
        level = math.log((6.0, 18.0)[order]) - math.log(b) - 3.0 * math.log(length)

        def excess(u: float) -> float:
            return power * math.log(u) - u + math.log(end - u) - level

        if excess(most) <= 0.0:
            return []
        sections = (math.exp((level - math.log(end)) / power), most), (most, end * (1.0 - _ROUNDING))
        return [length * bracketed_root(excess, *section, _ROUNDING, _ROUNDING) for section in sections]


def _power(x: Any, exponent: float, order: int) -> Any:
    """Derivative of x^-exponent; order -1 is the primitive, 0 at infinity."""
    if order == -1:
        return x ** (1.0 - exponent) / (1.0 - exponent)
    return math.prod(-exponent - i for i in range(order)) * x ** (-exponent - order)


def _roots(function: Callable[[float], float], turns: list[float]) -> list[float]:
    """Roots of a function of x that is monotone between its turns, times a power of x."""
    farthest = 2.0 * max([1.0, *turns])
    while function(farthest) * function(_NEAREST) > 0.0:
        farthest *= 2.0
    ends = [_NEAREST, *(turn for turn in turns if turn > _NEAREST), farthest]
    return [
        bracketed_root(function, a, b, _ROUNDING, _ROUNDING)
        for a, b in pairwise(ends)
        if function(a) * function(b) < 0.0
    ]
