"""The plane profile of an axisymmetric punch on a graded half-space, by the method of dimensionality reduction.

With s = (1-k)/2 a punch of the height f(r) is replaced by the profile

    g(x) = x^(1-k) integral_0^x f'(r) (x^2 - r^2)^(-s) dr,

the displacement of a contact of the radius x without adhesion (Hess, Int. J. Eng. Sci. 104 (2016) 20-33; Popov, Hess &
Willert, Handbook of Contact Mechanics, Springer 2019, chapter 9).  For r^n / n it is 1/2 B(n/2, (1+k)/2) x^n.  With the
order of integration changed, what the load has besides a^(1+k) g(a) / (1+k) is

    integral_0^a x^k g(x) dx = integral_0^a f'(r) (a^2 - r^2)^(1-s) dr / (2 - 2 s).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy

from comparisons.model import Array
from comparisons.models.quadrature import FINE


@dataclass(frozen=True, slots=True)
class PlaneProfile:
    """The profile of a punch.

    Parameters
    ----------
    height, slope : callable
        f(r) and f'(r), of the shape of r.
    breaks : tuple of float
        Radii where a derivative of f' jumps, rising: the integrals end there.
    k : float
        Gradient exponent.

    Examples
    --------
    >>> paraboloid = PlaneProfile(lambda r: 0.5 * r**2, lambda r: r, (), 0.0)
    >>> profile, moment = paraboloid.at(2.0)
    >>> round(profile, 12), round(moment, 12)  # x^2, a^3 / 3
    (4.0, 2.666666666667)
    """

    height: Callable[[Array], Array]
    slope: Callable[[Array], Array]
    breaks: tuple[float, ...]
    k: float

    def at(self, radius: float) -> tuple[float, float]:
        """Return g and the integral of x^k g up to a radius, both in units of the height."""
        s = 0.5 * (1.0 - self.k)
        profile = moment = 0.0
        for start, end in self._sections(radius):
            width = end - start
            r = start + width * FINE.z
            # (a - r)(a + r), exact where r is next to a.
            square = ((radius - end) + width * FINE.complement) * (radius + r)
            weight = width * FINE.weight * self.slope(r)
            profile += float(weight @ square**-s)
            moment += float(weight @ square ** (1.0 - s))
        return radius ** (1.0 - self.k) * profile, moment / (2.0 - 2.0 * s)

    def risen(self, radius: float, width: float, outer: float) -> float:
        """Return f(c) - f(a) + integral_0^a f'(r) I(s, 1-s; L^2 / (c^2 - r^2)) dr for a, L and c.

        Examples
        --------
        >>> paraboloid = PlaneProfile(lambda r: 0.5 * r**2, lambda r: r, (), 0.0)
        >>> round(paraboloid.risen(0.0, 2.0, 2.0), 12)
        2.0
        """
        s = 0.5 * (1.0 - self.k)
        total = float(self.height(np.array(outer)) - self.height(np.array(radius)))
        for start, end in self._sections(radius):
            r = start + (end - start) * FINE.z
            inside = ((radius - end) + (end - start) * FINE.complement) * (radius + r)
            share = scipy.special.betainc(s, 1.0 - s, width**2 / (width**2 + inside))
            total += (end - start) * float(FINE.weight @ (self.slope(r) * share))
        return total

    def _sections(self, radius: float) -> Iterator[tuple[float, float]]:
        """Yield the ends of the sections up to a radius without a break inside."""
        if radius > 0.0:
            yield from pairwise((0.0, *(r for r in self.breaks if r < radius), radius))
