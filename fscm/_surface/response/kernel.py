r"""The response of graded solids to a ring of pressure, by their images.

    G(r, t) = t int_0^oo D(xi) J0(xi r) J0(xi t) d(xi) = t [D_oo f(0) - Re sum_j a_j f(d_j)],
    f(d) = (2/pi) K(m) / sqrt((r+t)^2 + d^2) = 1 / agm(sqrt((r+t)^2 + d^2), sqrt((r-t)^2 + d^2)),

so that a ring of unit pressure lifts the surface by (2/E*) G, E* = E/(1-nu^2) at the surface (`response.images`).
For a homogeneous solid D = 1, and G is that of Eq. 6 at k = 0.  Where every surface has a tension D_oo = 0.
"""

from __future__ import annotations

import numpy as np

from fscm._surface.response.images import Images, images_of
from fscm._typing import Array, ComplexArray
from fscm.bodies import Bodies
from fscm.solids import Solid

__all__ = ["GradedKernel", "image_ring", "image_sum", "ring_mean"]

#: Points of the bound of the error for each decade of the wave number, and decades beyond the waves of the fit.
_POINTS, _DECADES = 40, 6
#: Pairs of radii evaluated together: their products with the images take 4 MB.
_CHUNK = 1000
#: Relative difference of both means below which the next one is exact to rounding.
_EQUAL = 1e-8
#: |J0(x)| <= min(1, sqrt(_BESSEL / x)).
_BESSEL = 2.0 / np.pi


def image_ring(total: Array, distance: Array, depth: Array) -> Array:
    """f(d) of a ring at a depth, from r + t, abs(r - t) and d.

    Examples
    --------
    >>> float(image_ring(2.0, 2.0, 0.0))           # at the center of a ring of radius 2
    0.5
    """
    from scipy.special import ellipkm1

    outer = total * total + depth * depth
    ratio = (distance * distance + depth * depth) / outer
    return _BESSEL * ellipkm1(ratio) / np.sqrt(outer)


def ring_mean(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Arithmetic-geometric mean of the roots of complex numbers whose arguments are less than a right angle apart.

    Examples
    --------
    >>> bool(abs(1.0 / ring_mean(np.array(5.0 + 0j), np.array(5.0 + 0j)) - image_ring(2.0, 2.0, 1.0)) < 1e-16)
    True
    """
    a, b = np.sqrt(a), np.sqrt(b)
    while np.any(np.abs(a - b) > _EQUAL * np.abs(a)):
        a, b = 0.5 * (a + b), np.sqrt(a * b)
    return 0.5 * (a + b)


def image_sum(total: Array, distance: Array, depths: ComplexArray, strengths: ComplexArray) -> Array:
    """Re sum_j a_j f(d_j), shape of both arguments, which end with an axis of length 1."""
    real = depths.imag == 0.0
    squared = depths[~real] ** 2
    rings = 1.0 / ring_mean(total * total + squared, distance * distance + squared)
    return image_ring(total, distance, depths[real].real) @ strengths[real].real + (rings @ strengths[~real]).real


class GradedKernel:
    """G(r, t) of solids that are no power law, or have surface tension.

    Parameters
    ----------
    solids : Bodies or Solid
    longest : float, optional
        Longest distance of interest, by default 1e6 times the deepest change of the constants.

    Examples
    --------
    >>> from fscm import Exponential
    >>> kernel = GradedKernel(Exponential(E_surface=1.0, E_depth=4.0, length=1.0, nu=0.3))
    >>> kernel.response(np.array([0.0, 0.0]), np.array([1e-6, 1e6])).round(3)
    array([1.  , 0.25])
    """

    def __init__(self, solids: Bodies | Solid, longest: float | None = None) -> None:
        self.images: Images = images_of(solids, longest)

    def images_at(self, total: Array, distance: Array) -> Array:
        """Re sum_j a_j f(d_j), shape of both arguments."""
        total, distance = np.broadcast_arrays(np.asarray(total, float), np.asarray(distance, float))
        out, A, B = np.empty(total.size), total.ravel(), distance.ravel()
        for i in range(0, len(out), _CHUNK):
            chunk = slice(i, i + _CHUNK)
            out[chunk] = image_sum(A[chunk, None], B[chunk, None], self.images.depths, self.images.strengths)
        return out.reshape(total.shape)

    def response(self, r: Array, t: Array, distance: Array | None = None) -> Array:
        """G(r, t), dimensionless; `distance` is abs(r - t) where the radii cannot carry it."""
        r, t = np.broadcast_arrays(np.asarray(r, float), np.asarray(t, float))
        gap = np.abs(r - t) if distance is None else np.asarray(distance, float)
        # Infinite at r = t without surface tension alone.
        shortest = self.images.shortest and self.images.shortest * image_ring(r + t, gap, np.zeros(()))
        return np.asarray(t * (shortest - self.images_at(r + t, gap)))

    def error(self, r: Array, t: Array) -> Array:
        """Bound of the error of G(r, t): t int eps(xi) |J0(xi r) J0(xi t)| d(xi), with the error eps of D.

        Examples
        --------
        >>> from fscm import Exponential
        >>> kernel = GradedKernel(Exponential(E_surface=1.0, E_depth=4.0, length=1.0, nu=0.3))
        >>> bool(kernel.error(np.array([1.0]), np.array([2.0]))[0] < 1e-9)
        True
        """
        r, t = np.broadcast_arrays(np.asarray(r, float), np.asarray(t, float))
        low, high = self.images.waves[0], self.images.waves[-1]
        count = int(np.log10(high / low) + 2 * _DECADES) * _POINTS
        xi = np.geomspace(low * 10.0**-_DECADES, high * 10.0**_DECADES, count)
        # d(xi) = xi d(log xi); beyond the largest wave number the integrand falls at least like xi^-2.
        weights = self.images.error(xi) * xi * np.log(xi[1] / xi[0])

        def envelope(x: Array) -> Array:
            return np.sqrt(np.minimum(1.0, _BESSEL / np.maximum(x, 1e-300)))

        return t * ((envelope(r[..., None] * xi) * envelope(t[..., None] * xi)) @ weights)
