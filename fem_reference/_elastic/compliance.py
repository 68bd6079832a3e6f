"""Compliance of the surface at every size of the contact.

Radii on the surface mesh are s = r / c, with the contact edge kept at s = 1.  Scaling lengths by c turns a
solid E(z) into E(c s): the displacement under the load vector F = integral of p phi s ds is c X(c) F, with
X(c) the compliance of E(c s) on the fixed mesh.  For E = E0 (z/c0)^k this is c^(1-k) c0^k / E0 times one
matrix that depends on k, nu and the mesh only, and serves every size.

A surface tension Y has a length of its own, Y / E: it adds Y / c to the stiffness of E(c s), times the integral of
u' v' s ds.  The compliances of two bodies that touch add.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, cast

import numpy as np
from scipy import linalg

from fem_reference._elastic.assembly import HalfSpace, assembled, half_space_of
from fem_reference._elastic.condensation import surface_stiffness
from fem_reference._elastic.mesh import Grid, MeshSpec
from fem_reference._elastic.surface_condition import FREE, SurfaceCondition
from fem_reference._elastic.surface_tension import SurfaceTension
from fem_reference._elastic.trace import Trace, trace_of
from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged
from fem_reference.modulus import Interface, Modulus, PowerLawModulus, interfaces_of
from fem_reference.poisson import PoissonRatio

__all__ = [
    "Addend",
    "Compliance",
    "compliance_for",
    "is_power_law",
    "is_scaling",
    "scaled_modulus",
    "scaled_poisson",
    "sum_of",
    "surface_compliance",
    "unit_of",
]


@dataclass(frozen=True, slots=True, eq=False)
class Addend:
    """One body in the compliance of several.

    Attributes
    ----------
    share : float
        Unit of its displacement, relative to the `factor` of the sum.
    matrix : ndarray, shape (m, m)
        Its compliance, times the share.
    """

    share: float
    matrix: Array


@dataclass(frozen=True, slots=True, eq=False)
class Compliance:
    """Surface compliance as a function of the size c of the mesh, or on a mesh of one size.

    Attributes
    ----------
    trace : Trace
        The surface functions.
    matrix : ndarray, shape (m, m)
        Normal displacement per load vector, per unit factor.
    unknowns : int
        Unknowns of the finite-element mesh behind it.
    size : float
        Of the mesh; immaterial with a law.
    unit : float
        Factor at that size.
    law : PowerLawModulus, optional
        E = E0 (z/c0)^k of a solid whose matrix serves every size.
    stiffness : float
        Modulus relative to that of the solid that was condensed.
    second : Addend, optional
        The part of `matrix` that is the second of two bodies.
    """

    trace: Trace
    matrix: Array
    unknowns: int
    size: float
    unit: float
    law: PowerLawModulus | None = None
    stiffness: float = 1.0
    second: Addend | None = None

    @property
    def scales(self) -> bool:
        """Whether the size of the mesh can change."""
        return self.law is not None

    @property
    def parts(self) -> tuple[Addend, ...]:
        """Both bodies, or the only one; their matrices add to `matrix`."""
        if self.second is None:
            return (Addend(1.0, self.matrix),)
        return (Addend(1.0, self.matrix - self.second.matrix), self.second)

    def factor(self, c: float) -> float:
        """Factor of `matrix` at a size, with the modulus of `stiffness`: c^(1-k) c0^k / E0 of a power law.

        Raises
        ------
        ValueError
            At any size but that of the mesh, without a law.
        """
        if self.law is not None:
            return _factor(self.law, c, self.stiffness)
        if abs(c / self.size - 1.0) > 1e-12:
            raise ValueError(f"this compliance holds at the size {self.size}, not {c}: the mesh has one size")
        return self.unit / self.stiffness

    def factor_slope(self, c: float) -> float:
        """Return the derivative of `factor` with respect to c; zero if the size cannot change."""
        return 0.0 if self.law is None else (1.0 - self.law.k) * self.factor(c) / c

    def stiffened(self, ratio: float) -> Compliance:
        """Return the compliance of a solid whose modulus is larger by a factor everywhere."""
        return replace(self, stiffness=ratio * self.stiffness)


def sum_of(first: Compliance, second: Compliance, size: float) -> Compliance:
    """Return the compliance of two bodies on the same surface mesh, of that size.

    Examples
    --------
    >>> spec = MeshSpec(0.25, 0.1, 50.0, 1.3, 4)
    >>> alone = compliance_for(PowerLawModulus(1.0, 1.0, 0.0), 0.3, spec, 1.0)
    >>> bool(np.all(sum_of(alone, alone, 1.0).matrix == 2.0 * alone.matrix))
    True
    """
    share = second.factor(size) / first.factor(size)
    added, unknowns = Addend(share, share * second.matrix), first.unknowns + second.unknowns
    matrix = first.matrix + added.matrix
    law = first.law if first.law and second.law and first.law.k == second.law.k else None
    return Compliance(first.trace, matrix, unknowns, size, first.factor(size), law, second=added)


@lru_cache(maxsize=24)
def _unit_compliance(k: float, nu: float, spec: MeshSpec, recoverable: bool, bonded: bool) -> tuple[Trace, Array, int]:
    stiffness, unknowns = _unit_stiffness(k, nu, spec, recoverable, bonded)
    half_space = _unit_half_space(k, nu, spec, SurfaceCondition(bonded=bonded)) if recoverable else None
    return trace_of(spec.grid(), spec.order), _inverse(stiffness, half_space), unknowns


# Without surface tension: it adds to one stiffness at every size.
@lru_cache(maxsize=24)
def _unit_stiffness(k: float, nu: float, spec: MeshSpec, recoverable: bool, bonded: bool) -> tuple[Array, int]:
    condition = SurfaceCondition(bonded=bonded)
    assembly = half_space_of if recoverable else assembled
    half_space = assembly(PowerLawModulus(1.0, 1.0, k), nu, spec, condition)
    return surface_stiffness(half_space, recoverable), half_space.unknowns


def _unit_half_space(k: float, nu: float, spec: MeshSpec, condition: SurfaceCondition) -> HalfSpace:
    """The half-space of a power law, kept for its whole system."""
    half_space = half_space_of(PowerLawModulus(1.0, 1.0, k), nu, spec, condition)
    if not half_space.eliminations:
        surface_stiffness(half_space)
    return half_space


# The path of a solid that does not scale has a compliance for each radius; one is some 1 MB.
@lru_cache(maxsize=8)
def _tense_compliance(
    law: PowerLawModulus, nu: float, spec: MeshSpec, size: float, recoverable: bool, condition: SurfaceCondition
) -> Compliance:
    """Compliance of a power law under surface tension, which is in units of the mesh."""
    stiffness, unknowns = _unit_stiffness(law.k, nu, spec, recoverable, condition.bonded)
    skin = SurfaceTension(spec.grid().r, spec.order, law.k)
    half_space = _unit_half_space(law.k, nu, spec, condition) if recoverable else None
    matrix = _inverse(stiffness + condition.tension * skin.matrix.toarray(), half_space)
    return Compliance(trace_of(spec.grid(), spec.order), matrix, unknowns, size, _factor(law, size))


def _factor(law: PowerLawModulus, c: float, stiffness: float = 1.0) -> float:
    """Displacement under a unit load vector, relative to that of E = z^k at the size 1."""
    return float(c ** (1.0 - law.k) * law.c0**law.k / (law.E0 * stiffness))


#: Largest error of the compliance by rounding, relative to its largest entry. What rounding leaves of an event is found
#: on the whole system (measured: 2.4e-7 under a coating 1e4 times as stiff as the solid, and 1e-10 of its force).
LARGEST_ROUNDING = 1e-6


#: Thickness of an element, relative to its depth, from which on rounding is no reason that a stiffness is refused
#: (measured under a fall of the modulus between two rows of a table: by a thousand, refused up to 1.3e-6; by a hundred,
#: up to 2e-8; by ten, up to 2e-9; under a rise by a hundred not down to 4e-12).
SAFE_THICKNESS = 1e-5


def surface_compliance(half_space: HalfSpace, recoverable: bool = True) -> Array:
    """Inverse of the surface stiffness of a half-space.

    Parameters
    ----------
    half_space, recoverable
        As for `fem_reference._elastic.condensation.surface_stiffness`.

    Raises
    ------
    NotConverged
        If the stiffness is not positive definite, or if rounding changes the compliance under a load in the centre or
        at the edge, where the elements are smallest.
    """
    S = surface_stiffness(half_space, recoverable)
    return _inverse(S, half_space if recoverable else None)


def _inverse(S: Array, half_space: HalfSpace | None) -> Array:
    """Inverse of a surface stiffness, checked on the half-space that it is of, which has been condensed."""
    X = linalg.cho_solve(linalg.cho_factor(S), np.eye(S.shape[0]))
    X = 0.5 * (X + X.T)
    if half_space is not None:
        loaded = [0, int(np.argmin(np.abs(half_space.grid.r - 1.0)))]
        load = np.zeros((half_space.elements.size, len(loaded)))
        load[half_space.surface[loaded], np.arange(len(loaded))] = 1.0
        change = X @ half_space.gathered(half_space.remainder(load, half_space.recovered(X[:, loaded])))
        relative = float(np.max(np.abs(change) / np.abs(X).max()))
        if not relative <= LARGEST_ROUNDING:
            raise NotConverged(
                f"rounding changes the compliance of the surface by {relative:.0e}, not {LARGEST_ROUNDING:.0e}: the "
                "elements are too thin, or the stiffness is nearly singular",
                Failure.STIFFNESS,
            )
    return X


def _divided(interfaces: tuple[Interface, ...], c: float) -> tuple[Interface, ...]:
    """Interfaces in lengths of c."""
    return tuple(Interface(i.depth / c, i.transition / c) for i in interfaces)


@dataclass(frozen=True, slots=True)
class _ScaledPoisson:
    """nu(c s) of a ratio nu(z)."""

    base: PoissonRatio
    c: float

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        return _divided(interfaces_of(self.base), self.c)

    def __call__(self, z: Array) -> Array:
        return self.base(np.asarray(z, float) * self.c)


@dataclass(frozen=True, slots=True)
class _Scaled:
    """E(c s) of a modulus E(z)."""

    base: Modulus
    c: float

    @property
    def surface_exponent(self) -> float:
        return self.base.surface_exponent

    @property
    def depth_exponent(self) -> float:
        return self.base.depth_exponent

    @property
    def surface_depth(self) -> float:
        return self.base.surface_depth / self.c

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        return _divided(interfaces_of(self.base), self.c)

    def __call__(self, z: Array) -> Array:
        return self.base(np.asarray(z, float) * self.c)


def is_scaling(modulus: Modulus, nu: float | PoissonRatio, kinks: tuple[float, ...]) -> bool:
    """Whether one mesh serves every size of the contact: a power law with one Poisson ratio, and no lines of the punch.

    Examples
    --------
    >>> is_scaling(PowerLawModulus(1.0, 1.0, 0.5), 0.3, kinks=())
    True
    """
    return is_power_law(modulus, nu) and not kinks


def is_power_law(modulus: Modulus, nu: float | PoissonRatio) -> bool:
    """Whether the compliance on a mesh is the same at every size of it, but for a factor."""
    return isinstance(modulus, PowerLawModulus) and not isinstance(nu, PoissonRatio)


def compliance_for(
    modulus: Modulus,
    nu: float | PoissonRatio,
    spec: MeshSpec,
    size: float,
    scaling: bool = True,
    recoverable: bool = False,
    condition: SurfaceCondition = FREE,
) -> Compliance:
    """Return the surface compliance of a solid on a mesh whose edge is at the radius `size`.

    Parameters
    ----------
    modulus : Modulus
        E(z).
    nu : float or PoissonRatio
        Poisson ratio, or one of depth.
    spec : MeshSpec
        Mesh in units of `size`.
    size : float
        Edge radius; immaterial if the problem scales (`is_scaling`): one compliance then serves every size.
    scaling : bool
        Whether that is made use of.
    recoverable : bool
        Whether the whole system of the mesh is solved later: the half-space is kept for it.
    condition : SurfaceCondition
        Of the surface; under tension no compliance serves two sizes.

    Returns
    -------
    Compliance

    Raises
    ------
    NotConverged
        If the stiffness of the mesh is not positive definite.
    """
    if not is_power_law(modulus, nu):
        return _fixed_compliance(cast(Hashable, modulus), cast(Hashable, nu), spec, size, recoverable, condition)
    law, ratio = cast(PowerLawModulus, modulus), cast(float, nu)
    if condition.tension:
        return _tense_compliance(law, ratio, spec, size, recoverable, unit_of(law, ratio, size, condition)[2])
    trace, matrix, unknowns = _unit_compliance(law.k, ratio, spec, recoverable, condition.bonded)
    of_every_size = law if scaling and is_scaling(modulus, nu, spec.kinks) else None
    return Compliance(trace, matrix, unknowns, size, _factor(law, size), of_every_size)


# The search for the width of the edge, and the mesh of it that the bounds need again; a few MB each.
@lru_cache(maxsize=8)
def _fixed_compliance(
    modulus: Any, nu: Any, spec: MeshSpec, size: float, recoverable: bool, condition: SurfaceCondition
) -> Compliance:
    grid, assembly = spec.grid(), half_space_of if recoverable else assembled
    try:
        scaled, ratio, in_units = unit_of(modulus, nu, size, condition)
        half_space = assembly(scaled, ratio, spec, in_units)
        matrix = surface_compliance(half_space, recoverable)
    except NotConverged as error:
        _refuse_thin_elements(grid, size, error)
        raise
    return Compliance(trace_of(grid, spec.order), matrix, half_space.unknowns, size, size)


def _refuse_thin_elements(grid: Grid, size: float, error: NotConverged) -> None:
    """Say which change of the modulus has elements so thin that rounding spoils their stiffness, if one has."""
    thickness = np.diff(grid.z)[1:] / grid.z[2:]
    thinnest = int(np.argmin(thickness))
    if thickness[thinnest] < SAFE_THICKNESS:
        raise NotConverged(
            f"the solid changes so fast at the depth {size * grid.z[thinnest + 2]:.6g} that the elements there are "
            f"{thickness[thinnest]:.1e} of that depth thick, and rounding can spoil the stiffness of those below "
            f"{SAFE_THICKNESS:g}",
            Failure.SOLID,
        ) from error


def unit_of(
    modulus: Modulus, nu: float | PoissonRatio, size: float, condition: SurfaceCondition = FREE
) -> tuple[Modulus, float | PoissonRatio, SurfaceCondition]:
    """Return modulus, Poisson ratio and condition of the half-space on a mesh in units of the size.

    `factor` of the compliance is the rest: the modulus of a power law is z^k.

    Examples
    --------
    >>> unit_of(PowerLawModulus(8.0, 1.0, 0.0), 0.3, 2.0, SurfaceCondition(tension=4.0))[2].tension
    0.25
    """
    if is_power_law(modulus, nu):
        law = cast(PowerLawModulus, modulus)
        # Elastic forces are those of the unit times c^2 / factor, and those of the tension do not change with c.
        return PowerLawModulus(1.0, 1.0, law.k), nu, condition.scaled(_factor(law, size) / size**2)
    return scaled_modulus(modulus, size), scaled_poisson(nu, size), condition.scaled(1.0 / size)


def scaled_modulus(modulus: Modulus, size: float) -> Modulus:
    """Return the modulus in lengths of `size`: E(size s) as a function of s.

    Examples
    --------
    >>> float(scaled_modulus(PowerLawModulus(1.0, 1.0, 0.5), 4.0)(np.array(1.0)))
    2.0
    """
    if isinstance(modulus, PowerLawModulus):
        return PowerLawModulus(modulus.E0, modulus.c0 / size, modulus.k)
    return _Scaled(modulus, size)


def scaled_poisson(nu: float | PoissonRatio, size: float) -> float | PoissonRatio:
    """Return the Poisson ratio in lengths of `size`.

    Examples
    --------
    >>> scaled_poisson(0.3, 4.0)
    0.3
    """
    return _ScaledPoisson(nu, size) if isinstance(nu, PoissonRatio) else nu
