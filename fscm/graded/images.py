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
import scipy

from fscm._typing import Array
from fscm.graded.compliance import compliance
from fscm.graded.solids import GradedHalfSpace, contact_modulus

__all__ = ["Images", "images_of"]

# Wave numbers of the fit: first and last, in units of the inverse of the deepest and of the shallowest change of the
# constants, their number for each decade, and the larger one between these factors of the same.
_LOW, _HIGH, _WAVES, _MANY, _AFTER, _BEFORE = 1e-10, 1e13, 10, 24, 0.01, 100.0
# Depths of the images: from _SHALLOW of the inverse of the last wave number to _DEEP of that of the first; so many for
# each decade, and more from _FROM of the shallowest to _TO of the deepest change: fewer follow a coating to 1e-6 only.
_SHALLOW, _DEEP, _SPARSE, _DENSE, _FROM, _TO = 10.0, 10.0, 7, 80, 0.3, 40.0
# A sharp interface at the depth h reflects like powers of xi h times exp(-2 xi h n): differences, of this step and up
# to this order, of exponentials around 2 h n for n up to _REFLECTIONS, at most so many interfaces.  As columns of their
# own they are not lost among the small singular values: the error of a layer falls from 1e-9 to 1e-10.
_STEP = 0.1
_DIFFERENCES = np.array(
    [[0, 0, 1, 0, 0], [0, -0.5, 0, 0.5, 0], [0, 1, -2, 1, 0], [-0.5, 1, 0, -1, 0.5], [1, -4, 6, -4, 1]], float
)
_DIFFERENCES /= _STEP ** np.arange(5)[:, None]
_REFLECTIONS, _MOST_INTERFACES, _JUMP, _BESIDE = 8, 3, 1e-6, 1e-9
# Errors count relative to D, but not to a smaller one than this, and singular values below this share are left out.
_RELATIVE, _SINGULAR = 1e-4, 3e-15
# Longest distance that the images serve, in units of the deepest change, and its product with the first wave number:
# with 1e-4 the kernel of E ~ (z + z_s)^0.2 at a tenth of that distance was wrong by 1e-8, with 1e-6 by 1e-10.
_LONGEST, _REACH = 1e6, 1e-6
# At the start of the range nothing holds the sum between its waves: this factor is left out of what counts.
_MARGIN = 10.0
# Between the waves where it is measured the error is at most this many times the one there; every so many of them the
# compliance is computed again with half the steps.
_BETWEEN, _EVERY = 2.0, 12
# Rounding of each term of the sum: on a sharp layer, whose strengths are 3e5 together, the error in extended precision
# was three times the one in doubles.
_ROUNDOFF = 2.0**-53


def _spaced(low: float, high: float, density: float) -> Array:
    count = max(1, round(np.log10(high / low) * density))
    return np.geomspace(low, high, count, endpoint=False)


def _changes(solid: GradedHalfSpace) -> tuple[float, float]:
    """Shallowest and deepest place at which the constants change."""
    depths = [solid.length, *solid.interfaces]
    return min(depths), max(depths)


def _sharp(solid: GradedHalfSpace) -> list[float]:
    """Interfaces at which a constant jumps; none where they are many."""
    ends = np.array(solid.interfaces)
    sides = [(np.log(solid.modulus(z)), solid.poisson(z)) for z in (ends * (1.0 - _BESIDE), ends * (1.0 + _BESIDE))]
    jumps = np.maximum(*(np.abs(after - before) for before, after in zip(*sides, strict=True)))
    found: list[float] = ends[jumps > _JUMP].tolist()
    return found if len(found) <= _MOST_INTERFACES else []


def _basis(depths: Array, interfaces: list[float]) -> tuple[Array, Array]:
    """Depths of all exponentials, shape (m,), and the columns of the fit in terms of them, shape (m, columns)."""
    centers = [2.0 * z * (n + 1) for z in interfaces for n in range(_REFLECTIONS)]
    clusters = [c * (1.0 + _STEP * np.arange(-2, 3)) for c in centers]
    columns = scipy.linalg.block_diag(np.eye(len(depths)), *[_DIFFERENCES.T] * len(centers))
    return np.concatenate([depths, *clusters]), columns


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
        """Largest error relative to D, or to 1e-4 where D is below."""
        return float(np.max(self.errors / np.maximum(self.values, _RELATIVE)))

    def error(self, xi: Array) -> Array:
        """Bound of the error of D at any xi > 0, shape of `xi`.

        Between two waves the largest one of both and their neighbours, doubled: both may be small by chance.  Beyond
        the last wave 1 - D falls like 1/xi; before the first one both the solid and the images change by less than they
        do over the decade behind it.
        """
        xi = np.asarray(xi, float)
        i = np.clip(np.searchsorted(self.waves, xi), 1, len(self.waves) - 1)
        around = np.pad(self.errors, 1, mode="edge")
        found = _BETWEEN * np.maximum.reduce([around[i - 1], around[i], around[i + 1], around[i + 2]])
        last = _BETWEEN * (abs(1.0 - self.values[-1]) + self.errors[-1]) * self.waves[-1] / xi
        decade = int(np.searchsorted(self.waves, 10.0 * self.waves[0]))
        first = _BETWEEN * (abs(self.values[decade] - self.values[0]) + self.errors[0])
        return np.where(xi > self.waves[-1], last, np.where(xi < self.waves[0], first, found))


@lru_cache(maxsize=32)
def images_of(solid: GradedHalfSpace, longest: float | None = None) -> Images:
    """The images of a solid, made once.

    Parameters
    ----------
    solid : GradedHalfSpace
    longest : float, optional
        Longest distance of interest, by default 1e6 times the deepest change of the constants.

    Examples
    --------
    >>> from fscm.graded import Exponential
    >>> images = images_of(Exponential(E_surface=1.0, E_depth=4.0, length=1.0, nu=0.3))
    >>> images.relative < 1e-9, images.at(np.array([1e-9, 1e9])).round(8)
    (True, array([0.25, 1.  ]))
    """
    shallow, deep = _changes(solid)
    low = min(_LOW / deep, _REACH / (_LONGEST * deep if longest is None else longest))
    high = _HIGH / shallow
    bends = _AFTER / deep, _BEFORE / shallow
    parts = _spaced(low, bends[0], _WAVES), _spaced(*bends, _MANY), _spaced(bends[1], high, _WAVES)
    nodes = np.append(np.concatenate(parts), high)
    waves = np.sort(np.append(nodes, np.sqrt(nodes[1:] * nodes[:-1])))
    scale = 0.5 * contact_modulus(solid)
    values = scale * compliance(solid, waves)
    ends = _SHALLOW / high, _FROM * shallow, _TO * deep, _DEEP / low
    depths = np.concatenate([_spaced(*ends[:2], _SPARSE), _spaced(*ends[1:3], _DENSE), _spaced(*ends[2:], _SPARSE)])
    depths, columns = _basis(depths, _sharp(solid))
    exponentials = np.exp(-waves[:, None] * depths)
    weights = 1.0 / np.maximum(values, _RELATIVE)
    matrix = (weights[:, None] * (exponentials @ columns))[::2]
    solved = np.linalg.lstsq(matrix, (weights * (1.0 - values))[::2], rcond=_SINGULAR)[0]
    order = np.argsort(depths)
    strengths = columns @ solved
    some = slice(None, None, _EVERY)
    steps = np.abs(scale * compliance(solid, waves[some], 2) - values[some])
    # The error of the steps varies slowly: the largest of the neighbours.
    around = np.maximum.reduce([steps, np.append(steps[1:], 0.0), np.append(0.0, steps[:-1])])
    errors = np.abs(1.0 - exponentials @ strengths - values) + np.repeat(around, _EVERY)[: len(waves)]
    errors += _ROUNDOFF * (exponentials @ np.abs(strengths))
    kept = waves >= _MARGIN * low
    return Images(depths[order], strengths[order], waves[kept], values[kept], errors[kept])
