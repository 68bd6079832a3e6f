r"""Displacement at the center by a distant ring of pressure, computed in two ways.

A ring of unit pressure at the radius t lifts the center by (2/E*) G(0, t), with D = xi C(xi) E*/2 and

    G(0, t) = t int_0^oo D(xi) J0(xi t) d(xi) = int_0^oo D(x/t) J0(x) dx,

1 for a homogeneous solid.  The first way is that of the panels, by images (`response.kernel`).  The second takes the
integral over x with the values of D that the compliance has at the waves of the fit: it needs no image.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from fscm._surface.response.kernel import GradedKernel
from fscm._typing import Array

__all__ = ["DistantRing"]

#: The images are interpolated in log t, on intervals of this ratio of the radii, with this degree: measured, to 5e-14
#: on coatings with contrasts of 1e-4 to 1e4 and on offset power laws (`tests/fscm/test_tail.py`).
_RATIO, _DEGREE = 4.0, 23
#: Radius up to which the images are used, in units of the inverse of their least wave number: at least 1e6 times the
#: deepest change of the constants, so that the response beyond is a power of the radius.  Measured there: both ways
#: differ by 1e-6 or less.
_REACH = 1e-3
#: Bessel integral: the first zero of J0 is reached in _HALVINGS intervals that double, then over _INTERVALS between
#: zeros, the last _AVERAGED of which are weighted by Euler's transformation of an alternating series; nodes of each.
_HALVINGS, _INTERVALS, _AVERAGED, _NODES = 44, 40, 24, 10
#: Waves around a place, through which log D is interpolated; step of its slope at the ends.
_AROUND, _STEP = 6, 1e-3


@lru_cache(maxsize=1)
def _bessel_rule() -> tuple[Array, Array]:
    """Nodes x and weights of int_0^oo f(x) J0(x) dx for a function f that is smooth in log x."""
    from scipy.special import bdtrc, j0, jn_zeros

    zeros = jn_zeros(0, _INTERVALS + 1)
    ends = np.concatenate([[0.0], zeros[0] * 2.0 ** np.arange(-_HALVINGS, 1.0), zeros[1:]])
    left = np.arange(_AVERAGED, 0, -1)
    # Share of the partial sums, averaged _AVERAGED times with their successors, that contain an interval.
    shares = np.concatenate([np.ones(len(ends) - 1 - _AVERAGED), bdtrc(_AVERAGED - left, _AVERAGED, 0.5)])
    u, w = np.polynomial.legendre.leggauss(_NODES)
    half = 0.5 * np.diff(ends)
    x = (ends[:-1] + half)[:, None] + half[:, None] * u
    return x.ravel(), ((shares * half)[:, None] * w * j0(x)).ravel()


class DistantRing:
    """G(0, t) of a graded solid.

    Parameters
    ----------
    kernel : GradedKernel

    Examples
    --------
    >>> from fscm import Exponential
    >>> ring = DistantRing(GradedKernel(Exponential(E_surface=1.0, E_depth=4.0, length=1.0, nu=0.3)))
    >>> radii = np.array([10.0, 1e9])
    >>> ring.by_images(radii).round(6), ring.by_waves(radii).round(6)
    (array([0.25039, 0.25   ]), array([0.25039, 0.25   ]))
    """

    def __init__(self, kernel: GradedKernel) -> None:
        self._kernel = kernel
        self._intervals: dict[int, Array] = {}
        #: Radius beyond which the response is taken for a power of the radius.
        self.reach = _REACH / float(kernel.images.waves[0])

    def by_images(self, t: Array) -> Array:
        """G(0, t) by the images, interpolated; a power of t beyond their reach."""
        t = np.asarray(t, float)
        near = np.minimum(t, self.reach)
        position = np.log(near) / math.log(_RATIO)
        out, index = np.empty(t.shape), np.floor(position).astype(int)
        for i in np.unique(index):
            inside = index == i
            out[inside] = chebyshev.chebval(2.0 * (position[inside] - i) - 1.0, self._coefficients(int(i)))
        if np.any(t > near):
            value, exponent = self.at_reach
            out = np.where(t > near, value * (t / self.reach) ** exponent, out)
        return out

    def _coefficients(self, index: int) -> Array:
        """Chebyshev series of G(0, t) for log t / log _RATIO from an integer to the next."""
        if index not in self._intervals:
            u = chebyshev.chebpts1(_DEGREE + 1)
            values = self._exactly(_RATIO ** (index + 0.5 * (u + 1.0)))
            self._intervals[index] = np.asarray(chebyshev.chebfit(u, values, _DEGREE), float)
        return self._intervals[index]

    def _exactly(self, t: Array) -> Array:
        return self._kernel.response(np.zeros_like(t), t)

    @cached_property
    def at_reach(self) -> tuple[float, float]:
        """G(0, t) at the reach, and the exponent of t there."""
        before, value = self._exactly(self.reach / np.array([_RATIO, 1.0]))
        # On a solid whose modulus rises faster than the depth nothing is left at such distances.
        exponent = math.log(value / before) / math.log(_RATIO) if min(before, value) > 0.0 else 0.0
        return float(value), exponent

    def by_waves(self, t: Array) -> Array:
        """G(0, t) by the integral over the wave numbers, without the images."""
        t = np.asarray(t, float)
        x, weights = _bessel_rule()
        return np.asarray(self._compliance(np.log(x) - np.log(t)[..., None]) @ weights)

    def _compliance(self, log_xi: Array) -> Array:
        """D between the waves at which it is known, and a power of xi beyond them."""
        log_waves, log_values = self._at_waves
        inside = np.clip(log_xi, log_waves[0], log_waves[-1])
        after, before = (_interpolated(log_waves, log_values, log_waves[[0, -1]] + x) for x in (_STEP, -_STEP))
        beyond = np.where(log_xi < inside, *(after - before) / (2.0 * _STEP)) * (log_xi - inside)
        return np.asarray(np.exp(_interpolated(log_waves, log_values, inside) + beyond))

    @cached_property
    def _at_waves(self) -> tuple[Array, Array]:
        images = self._kernel.images
        return np.log(images.waves), np.log(images.values)


def _interpolated(x: Array, y: Array, at: Array) -> Array:
    """Values at any places by the polynomials through the _AROUND nearest of ascending x."""
    first = np.clip(np.searchsorted(x, at) - _AROUND // 2, 0, len(x) - _AROUND)
    nodes = [x[first + i] for i in range(_AROUND)]
    total = np.zeros(at.shape)
    for i, node in enumerate(nodes):
        share = y[first + i]
        for other in nodes[:i] + nodes[i + 1 :]:
            share = share * (at - other) / (node - other)
        total += share
    return total
