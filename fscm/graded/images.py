r"""Images of a ring of pressure: the surface compliance of a graded solid as a sum of exponentials.

With E* = E/(1-nu^2) at the surface,

    D(xi) = xi C(xi) E*/2 = 1 - sum_j a_j exp(-xi d_j).

Each exponential is a ring at the depth d_j (`fscm.graded.kernel`).  The depths are fixed, dense around those at which
the solid changes and sparse to both sides; the a_j, of either sign, are the least-squares solution at many xi.  The
error is measured there and in the middles between them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from fscm._typing import Array
from fscm.graded.compliance import compliance
from fscm.graded.solids import GradedHalfSpace, contact_modulus

__all__ = ["Images", "images_of"]

# Wave numbers of the fit: first and last, in units of the inverse of the deepest and of the shallowest change of the
# constants, their number for each decade, and the larger one between these factors of the same.
_LOW, _HIGH, _WAVES, _MANY, _AFTER, _BEFORE = 1e-10, 1e12, 10, 24, 0.01, 100.0
# Depths of the images: from _SHALLOW of the inverse of the last wave number to _DEEP of that of the first; so many for
# each decade, and more from _FROM of the shallowest to _TO of the deepest change.  A sum of exponentials of fewer depths
# follows a coating to 1e-6 only.
_SHALLOW, _DEEP, _SPARSE, _DENSE, _FROM, _TO = 1.0, 30.0, 7, 100, 0.3, 40.0
# Errors count relative to D, down to this wave number (unit as _LOW), and singular values below this share are left out.
_RELATIVE, _SINGULAR = 1e-6, 3e-15
# At the start of the range nothing holds the sum between its waves: this factor is left out of what counts.
_MARGIN = 10.0
# Between the waves where it is measured the error is at most this many times the one there; every so many of them the
# compliance is computed again with half the steps.
_BETWEEN, _EVERY = 2.0, 12


def _spaced(low: float, high: float, density: float) -> Array:
    count = max(1, round(np.log10(high / low) * density))
    return np.geomspace(low, high, count, endpoint=False)


def _changes(solid: GradedHalfSpace) -> tuple[float, float]:
    """Shallowest and deepest place at which the constants change."""
    depths = [solid.length, *solid.interfaces]
    return min(depths), max(depths)


@dataclass(frozen=True, eq=False)
class Images:
    """Sum of exponentials of a solid and its error.

    Attributes
    ----------
    depths, strengths : ndarray, shape (m,)
        d_j and a_j.
    waves : ndarray, shape (n,)
        Wave numbers at which the error is known, ascending.
    values : ndarray, shape (n,)
        D there.
    errors : ndarray, shape (n,)
        Bounds of the error of D there.
    """

    depths: Array
    strengths: Array
    waves: Array
    values: Array
    errors: Array

    def at(self, xi: Array) -> Array:
        """D(xi) by the images, shape of `xi`."""
        xi = np.asarray(xi, float)
        return 1.0 - np.exp(-xi[..., None] * self.depths) @ self.strengths

    @cached_property
    def relative(self) -> float:
        """Largest error relative to D where that is relative."""
        return float(np.max(self.errors / np.maximum(self.values, self._least)))

    @cached_property
    def _least(self) -> float:
        return float(np.min(self.values))

    def error(self, xi: Array) -> Array:
        """Bound of the error of D at any xi > 0, shape of `xi`.

        Between two waves the larger one of both, doubled.  Beyond the last wave 1 - D falls like 1/xi; before the first
        one both the solid and the images change by less than they do over the decade behind it.
        """
        xi = np.asarray(xi, float)
        i = np.clip(np.searchsorted(self.waves, xi), 1, len(self.waves) - 1)
        found = _BETWEEN * np.maximum(self.errors[i - 1], self.errors[i])
        last = _BETWEEN * (abs(1.0 - self.values[-1]) + self.errors[-1]) * self.waves[-1] / xi
        decade = int(np.searchsorted(self.waves, 10.0 * self.waves[0]))
        first = _BETWEEN * (abs(self.values[decade] - self.values[0]) + self.errors[0])
        return np.where(xi > self.waves[-1], last, np.where(xi < self.waves[0], first, found))


@lru_cache(maxsize=32)
def images_of(solid: GradedHalfSpace) -> Images:
    """The images of a solid, made once.

    Examples
    --------
    >>> from fscm.graded import Exponential
    >>> images = images_of(Exponential(E_surface=1.0, E_depth=4.0, length=1.0, nu=0.3))
    >>> images.relative < 1e-9, images.at(np.array([0.0, 1e9])).round(8)
    (True, array([0.25, 1.  ]))
    """
    shallow, deep = _changes(solid)
    low, high = _LOW / deep, _HIGH / shallow
    bends = _AFTER / deep, _BEFORE / shallow
    parts = [_spaced(low, bends[0], _WAVES), _spaced(*bends, _MANY), _spaced(bends[1], high, _WAVES), [high]]
    nodes = np.concatenate(parts)
    waves = np.sort(np.append(nodes, np.sqrt(nodes[1:] * nodes[:-1])))
    scale = 0.5 * contact_modulus(solid)
    values = scale * compliance(solid, waves)
    ends = _SHALLOW / high, _FROM * shallow, _TO * deep, _DEEP / low
    depths = np.concatenate([_spaced(*ends[:2], _SPARSE), _spaced(*ends[1:3], _DENSE), _spaced(*ends[2:], _SPARSE)])
    weights = 1.0 / np.maximum(values, values[np.searchsorted(waves, _RELATIVE / deep)])[::2, None]
    matrix = np.exp(-waves[::2, None] * depths)
    strengths = np.linalg.lstsq(weights * matrix, (weights * (1.0 - values[::2, None]))[:, 0], rcond=_SINGULAR)[0]
    found = 1.0 - np.exp(-waves[:, None] * depths) @ strengths
    some = slice(None, None, _EVERY)
    steps = np.abs(scale * compliance(solid, waves[some], 2) - values[some])
    # The error of the steps varies slowly: the largest of the neighbours.
    around = np.maximum.reduce([steps, np.append(steps[1:], 0.0), np.append(0.0, steps[:-1])])
    errors = np.abs(found - values) + np.repeat(around, _EVERY)[: len(waves)]
    kept = waves >= _MARGIN * low
    return Images(depths, strengths, waves[kept], values[kept], errors[kept])
