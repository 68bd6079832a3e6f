r"""Images of a ring of pressure: the surface compliance of graded solids as a sum of exponentials.

With E* = E/(1-nu^2) at the surface,

    D(xi) = xi C(xi) E*/2 = D_oo - Re sum_j a_j exp(-xi d_j).

Of several bodies C is the sum, and so is 2/E*.  D_oo is 1, or the share of the bodies without surface tension.

Each exponential is a ring at the depth d_j (`response.kernel`).  Depths are real, or complex with an argument of 45
degrees.  Real ones do not suffice: a stiff layer on a soft solid bends, D ~ 1/(1 + (xi/xi_0)^3), whose poles at
xi_0 exp(+-i pi/3) have positive real parts, so that its Laplace transform grows, and strengths of 1e9 cancel.  On rays
between 30 and 90 degrees the transform decays; that of a stiff layer on a thin soft one with a stiff solid below,
D ~ xi/(1 + (xi/xi_0)^4), does not grow at 45 degrees.  The depths are fixed; the a_j are the least-squares solution at
many xi.  The error is measured there and at midpoints between them.

Surface tension adds 1/(1 + l xi) = int_0^oo exp(-s) exp(-s l xi) ds, rings at all depths (`response.body`): in log s
the trapezoidal rule converges exponentially.  What is left of D decays at short waves like xi^-2, and is fitted.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from fscm._surface.response.body import Body, bodies_of
from fscm._typing import Array, ComplexArray
from fscm.bodies import Bodies, ScaledSolid
from fscm.solids import Solid

__all__ = ["RAY", "STEP", "Images", "images_of"]

#: Wave numbers of the fit: least and largest, in units of the inverse of the deepest and of the shallowest change of
#: the constants, and their number for each decade: _MANY from _AFTER to _BEFORE times these inverses, else _WAVES.
_LOW, _HIGH, _WAVES, _MANY, _AFTER, _BEFORE = 1e-10, 1e13, 10, 40, 0.01, 500.0
#: Least wave number, in units of the inverse of the deepest change, and number for each decade of those at which the
#: largest compliance is sought; at longer waves it is that of the substrate.
_SOFTEST, _FEW = 1e-6, 4
#: Logarithm of the ratio of neighbouring depths of the lattice, and the direction of the complex ones.
STEP, RAY = math.log(2.0) / 6.0, cmath.exp(0.25j * math.pi)
#: Depths of the images, from _SHALLOW times the inverse of the largest wave number to _DEEP times that of the least:
#: real ones at every _SPARSE-th step, and every _DENSE-th from _FROM times the shallowest to _TO times the deepest
#: change, where the complex ones are, at every _COMPLEX-th, from _FROM_COMPLEX times the shallowest on.  Measured:
#: error 1e-11 of D or less on sharp and smooth coatings with contrasts of 1e-4 to 1e4, 1e-10 on three layers stiff,
#: soft, stiff, 3e-8 on five.  A ray of 55 degrees has 4e-10 there, but the error for a modulus that rises 1000 times is
#: then larger between the waves.
_SHALLOW, _DEEP, _SPARSE, _DENSE, _FROM, _TO = 10.0, 10.0, 3, 2, 0.05, 30.0
_FROM_COMPLEX, _COMPLEX = 0.3, 1
#: Errors are relative to D, or to _RELATIVE where D is smaller; smaller singular values than this share are omitted.
_RELATIVE, _SINGULAR = 1e-4, 3e-15
#: Longest distance for which the images hold, in units of the deepest change, and its product with the least wave
#: number: with 1e-4 the kernel of E ~ (z + z_s)^0.2 at a tenth of that distance was wrong by 1e-8, with 1e-6 by 1e-10.
_LONGEST, _REACH = 1e6, 1e-6
#: Ratio of the longest distances of images that are kept for other units.
_ROUNDED = 1e3
#: The sum is not controlled at the least wave numbers: those within this factor are omitted from the result.
_MARGIN = 10.0
#: Bound of the error between the waves, in units of that measured there; at every _EVERY-th wave the compliance is also
#: computed with half the step length.
_BETWEEN, _EVERY = 2.0, 12
#: Rounding of each term of the sum.
_ROUNDOFF = 2.0**-53
#: Steps of the lattice between rings of surface tension, and the first and the last over its length: the trapezoidal
#: rule in log s is exact to rounding, because the integrand is analytic in a strip of half-width pi/2; exp(-s) is below
#: rounding beyond the last, and the rings above the first are those of waves of 1e-20 of the length.
_RING_STEPS, _FIRST_RING, _LAST_RING = 2, 1e-22, 40.0


def _spaced(low: float, high: float, density: float) -> Array:
    count = max(1, round(math.log10(high / low) * density))
    return np.geomspace(low, high, count, endpoint=False)


def _on_lattice(low: float, high: float, every: int) -> Array:
    """Depths of a stretch, in the unit of the lattice."""
    steps = np.arange(*(math.ceil(math.log(end) / (every * STEP)) for end in (low, high)))
    return np.exp(STEP * every * steps)


def _changes(bodies: tuple[Body, ...]) -> tuple[float, float]:
    """Shallowest and deepest change of the constants; the deepest is at least the length over which a layer bends.

    That length grows with the third root of the largest compliance: at the longest waves on a soft solid, or at shorter
    ones on a soft layer with a stiff solid below.
    """
    shallow, deep = math.inf, 0.0
    for body in bodies:
        depths = body.elastic_depths()
        if depths:
            first, last = min(depths), max(depths)
            waves = np.append(_LOW / last, _spaced(_SOFTEST / last, 1.0 / first, _FEW))
            softest = body.stiffness * float(np.max(body.compliance(waves)))
            shallow, deep = min(shallow, first), max(deep, last * max(1.0, softest) ** (1.0 / 3.0))
        if body.tension:
            shallow, deep = min(shallow, body.tension_length), max(deep, body.tension_length)
    return shallow, deep


@dataclass(frozen=True, eq=False)
class Images:
    """Sum of exponentials of a solid and its error.

    Attributes
    ----------
    depths, strengths : ndarray, shape (m,), complex
        d_j and a_j.
    waves : ndarray, shape (n,)
        Wave numbers at which the error is measured, ascending.
    values : ndarray, shape (n,)
        D there.
    errors : ndarray, shape (n,)
        Bounds of the error of D there.
    shortest : float
        D_oo.
    unit : float
        Depths are unit exp(STEP m) with whole numbers m, some of them times RAY.
    source : Images, optional
        The same in another unit of length.
    """

    depths: ComplexArray
    strengths: ComplexArray
    waves: Array
    values: Array
    errors: Array
    shortest: float
    unit: float
    source: Images | None = None

    @property
    def of_solid(self) -> Images:
        """The same for all units in which a solid is measured."""
        return self if self.source is None else self.source

    def scaled(self, unit: float) -> Images:
        """The same with lengths in another unit."""
        depths, waves = self.depths / unit, self.waves * unit
        return replace(self, depths=depths, waves=waves, unit=self.unit / unit, source=self.of_solid)

    def at(self, xi: Array) -> Array:
        """D(xi) by the images, shape of `xi`."""
        xi = np.asarray(xi, float)
        return self.shortest - (np.exp(-xi[..., None] * self.depths) @ self.strengths).real

    @cached_property
    def relative(self) -> float:
        """Largest error relative to D, or to 1e-4 where D is smaller."""
        return float(np.max(self.errors / np.maximum(self.values, _RELATIVE)))

    @cached_property
    def largest(self) -> float:
        """Largest D, at least 1."""
        return max(1.0, float(np.max(self.values)))

    def error(self, xi: Array) -> Array:
        """Bound of the error of D at any xi > 0, shape of `xi`.

        Between two waves twice the largest error at both and their neighbours.  Beyond the largest wave number D_oo - D
        falls like 1/xi; below the least one both the solid and the images change by less than over the next decade.
        """
        xi = np.asarray(xi, float)
        i = np.clip(np.searchsorted(self.waves, xi), 1, len(self.waves) - 1)
        around = np.pad(self.errors, 1, mode="edge")
        between = _BETWEEN * np.maximum.reduce([around[i - 1], around[i], around[i + 1], around[i + 2]])
        beyond = _BETWEEN * (abs(self.shortest - self.values[-1]) + self.errors[-1]) * self.waves[-1] / xi
        decade = int(np.searchsorted(self.waves, 10.0 * self.waves[0]))
        before = _BETWEEN * (abs(self.values[decade] - self.values[0]) + self.errors[0])
        return np.where(xi > self.waves[-1], beyond, np.where(xi < self.waves[0], before, between))


def common_stiffness(bodies: tuple[Body, ...]) -> float:
    """E*/2 of several bodies together."""
    return bodies[0].stiffness if len(bodies) == 1 else 1.0 / sum(1.0 / body.stiffness for body in bodies)


def _rings_of_tension(bodies: tuple[Body, ...], scale: float, unit: float) -> tuple[ComplexArray, ComplexArray]:
    """Depths and strengths of the images of the surface tensions."""
    depths, strengths = [np.zeros(0)], [np.zeros(0)]
    for body in bodies:
        if body.tension:
            length = body.tension_length / unit
            rings = _on_lattice(_FIRST_RING * length, _LAST_RING * length, _RING_STEPS) / length
            depths.append(rings * body.tension_length)
            strengths.append(-scale / body.stiffness * _RING_STEPS * STEP * rings * np.exp(-rings))
    return np.concatenate(depths).astype(complex), np.concatenate(strengths).astype(complex)


def _waves(changes: tuple[float, float], low: float, high: float) -> Array:
    """Wave numbers of the fit, and between each two of them one at which its error is measured."""
    bends = _AFTER / changes[1], _BEFORE / changes[0]
    parts = _spaced(low, bends[0], _WAVES), _spaced(*bends, _MANY), _spaced(bends[1], high, _WAVES)
    nodes = np.append(np.concatenate(parts), high)
    return np.sort(np.append(nodes, np.sqrt(nodes[1:] * nodes[:-1])))


def _fit(
    changes: tuple[float, float], ends: tuple[float, float], waves: Array, target: Array, values: Array
) -> tuple[ComplexArray, ComplexArray, Array, Array]:
    """Images of a function of the wave number.

    Parameters
    ----------
    changes : tuple of float
        Shallowest and deepest change of the constants.
    ends : tuple of float
        Least and largest wave number.
    waves, target : ndarray, shape (n,)
        Wave numbers, every other one of which is fitted, and the function there.
    values : ndarray, shape (n,)
        D, to which the error is relative.

    Returns
    -------
    depths, strengths : ndarray, complex
    approximation : ndarray, shape (n,)
    rounding : ndarray, shape (n,)
    """
    (shallow, deep), (low, high) = changes, ends
    first, dense, sparse, last = (end / shallow for end in (_SHALLOW / high, _FROM * shallow, _TO * deep, _DEEP / low))
    stretches = (first, dense, _SPARSE), (dense, sparse, _DENSE), (sparse, last, _SPARSE)
    real = np.concatenate([_on_lattice(*stretch) for stretch in stretches])
    on_ray = RAY * _on_lattice(_FROM_COMPLEX, sparse, _COMPLEX)
    depths = np.asarray(shallow * np.concatenate([real, on_ray]), complex)
    exponentials = np.exp(-waves[:, None] * depths)
    columns = np.concatenate([exponentials.real, -exponentials.imag[:, len(real) :]], axis=1)
    weights = 1.0 / np.maximum(values, _RELATIVE)
    matrix, right = weights[:, None] * columns, weights * target
    solved = np.linalg.lstsq(matrix[::2], right[::2], rcond=_SINGULAR)[0]
    strengths = solved[: len(depths)].astype(complex)
    strengths.imag[len(real) :] = solved[len(depths) :]
    return depths, strengths, columns @ solved, _ROUNDOFF * (np.abs(columns) @ np.abs(solved))


@lru_cache(maxsize=32)
def images_of(solids: Bodies | Solid, longest: float | None = None) -> Images:
    """The images of a solid or of several, cached.

    Parameters
    ----------
    solids : Bodies or Solid
        None of them one power law without surface tension, whose response is exact.
    longest : float, optional
        Longest distance of interest, by default 1e6 times the deepest change of the constants.

    Examples
    --------
    >>> from fscm import Exponential
    >>> images = images_of(Exponential(E_surface=1.0, E_depth=4.0, length=1.0, nu=0.3))
    >>> images.relative < 1e-9, images.at(np.array([1e-9, 1e9])).round(8)
    (True, array([0.25, 1.  ]))
    """
    bodies = bodies_of(solids)
    if len(bodies) == 1 and isinstance(bodies[0].solid, ScaledSolid):
        solid, unit = bodies[0].solid.solid, bodies[0].solid.unit
        # Rounded up, so that they serve many units.
        reach = (
            None
            if longest is None
            else solid.length * _ROUNDED ** math.ceil(math.log(longest * unit / solid.length, _ROUNDED))
        )
        return images_of(solid, reach).scaled(unit)
    shallow, deep = changes = _changes(bodies)
    low = min(_LOW / deep, _REACH / (_LONGEST * deep if longest is None else longest))
    high = _HIGH / shallow
    waves, scale = _waves(changes, low, high), common_stiffness(bodies)

    def values_at(xi: Array, refinement: int = 1) -> Array:
        first, *others = (body.compliance(xi, refinement) for body in bodies)
        return scale * sum(others, first)

    values = values_at(waves)
    shortest = sum((scale / body.stiffness for body in bodies if not body.tension), 0.0)
    depths, strengths = _rings_of_tension(bodies, scale, shallow)
    rings = np.exp(-waves[:, None] * depths.real)
    by_rings, errors = rings @ strengths.real, _ROUNDOFF * (rings @ np.abs(strengths))
    if all(body.surface.k == 0.0 and not body.is_graded for body in bodies):
        errors += np.abs(shortest - values - by_rings)
    else:
        target = shortest - values - by_rings
        fitted, of_fitted, approximation, rounding = _fit(changes, (low, high), waves, target, values)
        depths, strengths = np.concatenate([depths, fitted]), np.concatenate([strengths, of_fitted])
        sampled = slice(None, None, _EVERY)
        steps = np.abs(values_at(waves[sampled], 2) - values[sampled])
        # The error of the steps varies slowly: that of the neighbours bounds it.
        around = np.maximum.reduce([steps, np.append(steps[1:], 0.0), np.append(0.0, steps[:-1])])
        errors += np.abs(shortest - approximation - values - by_rings) + np.repeat(around, _EVERY)[: len(waves)]
        errors += rounding
    served = waves >= _MARGIN * low
    order = np.argsort(np.abs(depths))
    return Images(depths[order], strengths[order], waves[served], values[served], errors[served], shortest, shallow)
