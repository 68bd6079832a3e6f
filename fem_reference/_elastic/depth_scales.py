"""Depths and lengths of a modulus that a mesh has to follow: its jumps, and where it changes within a short length.

Every octave of depth, cut at the declared interfaces, is halved until polynomials of low degree represent E and 1/E on
each part.  The strain under a given stress follows 1/E: where a modulus falls to a small value it may be a cubic, but
its elements have to be short there.  A part that stays unresolved down to rounding has a jump, which is found by
bisection and becomes a mesh line; the parts on both sides of it are then resolved again.  A step between two moduli is
found however narrow it is, because the modulus differs on both sides; a thin layer between equal moduli is found if it
is thicker than 1/30 of its depth, or declared.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import cast

import numpy as np

from fem_reference._typing import Array
from fem_reference.modulus import Interface, Modulus, PowerLawModulus, interfaces_of
from fem_reference.modulus_checks import positive_modulus
from fem_reference.poisson import PoissonRatio, poisson_at

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


def depth_scales(modulus: Modulus, low: float, high: float, nu: float | PoissonRatio = 0.0) -> DepthScales:
    """Return what a mesh has to follow between two depths.

    Parameters
    ----------
    modulus : Modulus
        Hashable; nothing is searched in a power law.
    low, high : float
        Range of depth, positive.
    nu : float or PoissonRatio
        One of depth is followed as well, hashable.

    Returns
    -------
    DepthScales

    Raises
    ------
    ValueError
        If the modulus is not positive and finite, or changes everywhere.

    Examples
    --------
    >>> from fem_reference.depth_profiles import TransitionProfile
    >>> depth_scales(TransitionProfile(10.0, 1.0, thickness=3.0), 0.01, 100.0)
    DepthScales(lines=(3.0,), parts=())
    """
    lines: set[float] = set()
    parts: set[tuple[float, float]] = set()
    profiles: list[Modulus] = [] if isinstance(modulus, PowerLawModulus) else [modulus]
    if isinstance(nu, PoissonRatio):
        profiles.append(_UniaxialModulus(nu))
    for profile in profiles:
        scales = _scales_of(profile, low, high)
        lines.update(scales.lines)
        parts.update(scales.parts)
    return DepthScales(tuple(sorted(lines)), tuple(sorted(parts)))


@dataclass(frozen=True, slots=True)
class _UniaxialModulus:
    """Modulus of a layer that cannot widen, relative to Young's modulus: what a Poisson ratio of depth changes."""

    nu: PoissonRatio
    surface_exponent: float = 0.0
    depth_exponent: float = 0.0
    surface_depth: float = 1.0

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        return interfaces_of(self.nu)

    def __call__(self, z: Array) -> Array:
        nu = poisson_at(self.nu, z)
        return (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))


def _scales_of(modulus: Modulus, low: float, high: float) -> DepthScales:
    """What a mesh has to follow of one function of depth."""
    declared = [i for i in interfaces_of(modulus) if low < i.depth < high]
    lines = {i.depth for i in declared}
    parts = {_around(i) for i in declared if i.transition > 0}
    for octave in range(math.floor(math.log2(low / FIRST_END)), math.ceil(math.log2(high / FIRST_END))):
        scales = _octave(cast(Hashable, modulus), octave)
        lines.update(z for z in scales.lines if low < z < high)
        parts.update(interval for interval in scales.parts if interval[1] > low and interval[0] < high)
    return DepthScales(tuple(sorted(lines)), tuple(sorted(parts)))


def _around(interface: Interface) -> tuple[float, float]:
    """Interval of the length of its transition."""
    half = 0.5 * interface.transition
    return interface.depth - half, interface.depth + half


@lru_cache(maxsize=512)
def _octave(modulus: Modulus, octave: int) -> DepthScales:
    """Jumps and short parts in an octave."""
    low, high = FIRST_END * 2.0**octave, FIRST_END * 2.0 ** (octave + 1)
    lines = [i.depth for i in interfaces_of(modulus) if low < i.depth < high]
    jumps: list[float] = []
    parts: list[tuple[float, float]] = []
    ends = [low, *lines, high]
    pending = list(pairwise(ends))
    while pending:
        a, b = pending.pop()
        resolved = _resolve(modulus, a, b)
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


def _resolve(modulus: Modulus, a: float, b: float) -> list[tuple[float, float]] | float:
    """Parts of [a, b] on each of which polynomials represent E and 1/E, or the depth of a jump."""
    resolved = []
    pending = [(a, b)]
    while pending:
        left, right = pending.pop()
        if _is_polynomial(modulus, left, right):
            resolved.append((left, right))
        elif right - left <= JUMP * right:
            return _jump(modulus, left, right)
        else:
            middle = 0.5 * (left + right)
            pending += [(left, middle), (middle, right)]
    return resolved


#: Points of Chebyshev on [-1, 1], the polynomials there, and what a fit by these leaves of a function.
_X = np.cos(np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES)
_BASIS = np.polynomial.chebyshev.chebvander(_X, DEGREE)
_REMAINDER = np.eye(SAMPLES) - _BASIS @ np.linalg.pinv(_BASIS)


def _is_polynomial(modulus: Modulus, a: float, b: float) -> bool:
    """Whether polynomials represent E and 1/E between two depths, neither of which is sampled."""
    z = 0.5 * (a + b) + 0.5 * (b - a) * _X
    E = positive_modulus(modulus, z)
    return all(float(np.abs(_REMAINDER @ f).max()) <= RESOLVED * float(f.max()) for f in (E, E.min() / E))


def _jump(modulus: Modulus, a: float, b: float) -> float:
    """Depth of the largest change of E in a very short interval, by bisection to rounding."""
    E_a, E_b = (float(modulus(np.array(z))) for z in (a, b))
    while True:
        middle = 0.5 * (a + b)
        if not a < middle < b:
            return b
        E = float(modulus(np.array(middle)))
        if abs(E - E_a) > abs(E - E_b):
            b, E_b = middle, E
        else:
            a, E_a = middle, E
