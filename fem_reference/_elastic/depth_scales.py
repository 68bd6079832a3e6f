"""Depths and lengths of a solid that a mesh has to follow: its jumps, and where it changes within a short length.

Every octave of depth, cut at the declared interfaces, is halved until polynomials of low degree represent E and 1/E on
each part.  The strain under a given stress follows 1/E: where a modulus falls to a small value it may be a cubic, but
its elements have to be short there.  A part that stays unresolved down to rounding has a jump, which is found by
bisection and becomes a mesh line; the parts on both sides of it are then resolved again.  A step between two moduli is
found however narrow it is, because the modulus differs on both sides; a thin layer between equal moduli is found if it
is thicker than 1/30 of its depth, or declared.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from fem_reference._typing import Array
from fem_reference.solid import Interface, Solid, positive_modulus

__all__ = ["DepthScales", "depth_scales"]

#: Degree of the polynomials: that of the elements, in which the displacement of a modulus resolved so is resolved.
DEGREE = 6

#: Error of a polynomial on a part, relative to the largest E, or 1/E, there. An element of that length and degree has
#: the displacement to about as much, and the energy to the square of it, weighted with the share of the part in the
#: depth.
RESOLVED = 1e-3

#: Points a part: enough to see a change on a part from its inside and from both ends.
SAMPLES = 32

#: Length of a part relative to its depth below which a modulus that is not resolved has a jump.
JUMP = 2.0**-40

#: One end of an octave; the others are its multiples by powers of 2. A jump at an end or at a middle is not seen, and
#: interfaces are at round depths.
FIRST_END = 1.0737

#: Jumps in one octave beyond which the modulus is refused: it is noise and not layers.
MOST_JUMPS = 64


@dataclass(frozen=True, slots=True)
class DepthScales:
    """What a mesh has to follow.

    Attributes
    ----------
    lines : tuple of float
        Depths of mesh lines, rising.
    parts : tuple of (float, float)
        Intervals of depth in which elements must not be longer than the interval (times the density of the mesh).
    """

    lines: tuple[float, ...] = ()
    parts: tuple[tuple[float, float], ...] = ()

    def scaled(self, size: float) -> DepthScales:
        """Return the same in lengths of `size`.

        Examples
        --------
        >>> DepthScales((2.0,), ((1.0, 4.0),)).scaled(2.0)
        DepthScales(lines=(1.0,), parts=((0.5, 2.0),))
        """
        return DepthScales(tuple(z / size for z in self.lines), tuple((a / size, b / size) for a, b in self.parts))


def depth_scales(solid: Solid, low: float, high: float) -> DepthScales:
    """Return what a mesh has to follow between two depths.

    Parameters
    ----------
    solid : Solid
        Nothing is searched in a power law.
    low, high : float
        Range of depth, positive.

    Returns
    -------
    DepthScales

    Raises
    ------
    ValueError
        If the modulus is not positive and finite, or changes everywhere.

    Examples
    --------
    >>> from fem_reference import Coating
    >>> depth_scales(Coating(10.0, 1.0, thickness=3.0, transition=0.0, nu_coating=0.3), 0.01, 100.0)
    DepthScales(lines=(3.0,), parts=())
    """
    if solid.as_power_law is not None:
        return DepthScales()
    declared = [i for i in solid.interfaces if low < i.depth < high]
    lines = {i.depth for i in declared}
    parts = {_around(i) for i in declared if i.transition > 0}
    for octave in range(math.floor(math.log2(low / FIRST_END)), math.ceil(math.log2(high / FIRST_END))):
        scales = _octave(solid, octave)
        lines.update(z for z in scales.lines if low < z < high)
        parts.update(interval for interval in scales.parts if interval[1] > low and interval[0] < high)
    return DepthScales(tuple(sorted(lines)), tuple(sorted(parts)))


def _around(interface: Interface) -> tuple[float, float]:
    """Interval of the length of its transition."""
    half = 0.5 * interface.transition
    return interface.depth - half, interface.depth + half


@lru_cache(maxsize=512)
def _octave(solid: Solid, octave: int) -> DepthScales:
    """Jumps and short parts in an octave."""
    low, high = FIRST_END * 2.0**octave, FIRST_END * 2.0 ** (octave + 1)
    lines = sorted(i.depth for i in solid.interfaces if low < i.depth < high)
    jumps: list[float] = []
    parts: list[tuple[float, float]] = []
    ends = [low, *lines, high]
    pending = list(pairwise(ends))
    while pending:
        a, b = pending.pop()
        resolved = _resolve(solid, a, b)
        if isinstance(resolved, float):
            jumps.append(resolved)
            if len(jumps) > MOST_JUMPS:
                raise ValueError(
                    f"the modulus jumps at more than {MOST_JUMPS} depths between {low:g} and {high:g}: "
                    "a mesh cannot follow it; smooth the data it comes from"
                )
            pending += [(a, resolved), (resolved, b)]
        else:
            parts += [interval for interval in resolved if interval[1] - interval[0] < b - a]
    return DepthScales(tuple(jumps), tuple(parts))


def _resolve(solid: Solid, a: float, b: float) -> list[tuple[float, float]] | float:
    """Parts of [a, b] on each of which polynomials represent the moduli, or the depth of a jump."""
    resolved = []
    pending = [(a, b)]
    while pending:
        left, right = pending.pop()
        if _is_polynomial(solid, left, right):
            resolved.append((left, right))
        elif right - left <= JUMP * right:
            return _jump(solid, left, right)
        else:
            middle = 0.5 * (left + right)
            pending += [(left, middle), (middle, right)]
    return resolved


#: Points of Chebyshev on [-1, 1], the polynomials there, and what a fit by these leaves of a function.
_X = np.cos(np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES)
_BASIS = np.polynomial.chebyshev.chebvander(_X, DEGREE)
_REMAINDER = np.eye(SAMPLES) - _BASIS @ np.linalg.pinv(_BASIS)


def _is_polynomial(solid: Solid, a: float, b: float) -> bool:
    """Whether polynomials represent the moduli and their inverse between two depths, neither of which is sampled."""
    moduli = _moduli(solid, 0.5 * (a + b) + 0.5 * (b - a) * _X)
    functions = [*moduli, *(moduli.min(axis=1, keepdims=True) / moduli)]
    return all(float(np.abs(_REMAINDER @ f).max()) <= RESOLVED * float(f.max()) for f in functions)


def _moduli(solid: Solid, z: Array) -> Array:
    """E, and the modulus of a layer that cannot widen relative to it, which Poisson's ratio changes: shape (2, n)."""
    nu = solid.poisson(z)
    return np.array([positive_modulus(solid, z), (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))])


def _jump(solid: Solid, a: float, b: float) -> float:
    """Depth of the largest change of the moduli in a very short interval, by bisection to rounding."""
    at_a, at_b = (_moduli(solid, np.array([z])) for z in (a, b))
    while True:
        middle = 0.5 * (a + b)
        if not a < middle < b:
            return b
        at_middle = _moduli(solid, np.array([middle]))
        if np.abs(np.log(at_middle / at_a)).sum() > np.abs(np.log(at_middle / at_b)).sum():
            b, at_b = middle, at_middle
        else:
            a, at_a = middle, at_middle
