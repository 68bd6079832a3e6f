"""Compliance of the surface at every size of the contact.

Radii on the surface mesh are s = r / c, with the contact edge kept at s = 1.  Scaling lengths by c turns a
solid E(z) into E(c s): the displacement under the load vector F = integral of p phi s ds is c X(c) F, with
X(c) the compliance of E(c s) on the fixed mesh.  For E = E0 (z/c0)^k this is c^(1-k) c0^k / E0 times one
matrix that depends on k, nu and the mesh only, and serves every size.

A surface tension Y has a length of its own, Y / E: it adds Y / c to the stiffness of E(c s), times the integral of
u' v' s ds.  The compliances of two bodies that touch add.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy import linalg

from fem_reference._elastic.assembly import HalfSpace, assembled, half_space_of
from fem_reference._elastic.condensation import surface_stiffness
from fem_reference._elastic.mesh import Grid, MeshSpec
from fem_reference._elastic.surface_tension import SurfaceTension
from fem_reference._elastic.trace import Trace, trace_of
from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged
from fem_reference.solid import PowerLaw, ScaledSolid, Solid

__all__ = [
    "Addend",
    "Compliance",
    "checked_inverse",
    "compliance_for",
    "sum_of",
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
    law : PowerLaw, optional
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
    law: PowerLaw | None = None
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
    >>> alone = compliance_for(PowerLaw(1.0, 1.0, 0.0, 0.3), spec, 1.0)
    >>> bool(np.all(sum_of(alone, alone, 1.0).matrix == 2.0 * alone.matrix))
    True
    """
    share = second.factor(size) / first.factor(size)
    added, unknowns = Addend(share, share * second.matrix), first.unknowns + second.unknowns
    matrix = first.matrix + added.matrix
    law = first.law if first.law and second.law and first.law.k == second.law.k else None
    return Compliance(first.trace, matrix, unknowns, size, first.factor(size), law, second=added)


# The path of a solid that does not scale has a compliance for each radius, and the next problem has most of them again;
# one is some 0.5 MB.
@lru_cache(maxsize=64)
def _unit_compliance(unit: Solid, spec: MeshSpec, recoverable: bool) -> tuple[Trace, Array, int]:
    """Surface functions, compliance and number of unknowns of a solid in units of the mesh."""
    stiffness, unknowns = _stiffness(unit.without_tension(), spec, recoverable)
    if unit.surface_tension:
        skin = SurfaceTension(spec.grid().r, spec.order, unit.depth_exponent)
        stiffness = stiffness + unit.surface_tension * skin.matrix.toarray()
    half_space = half_space_of(unit, spec) if recoverable else None
    if half_space is not None and not half_space.eliminations:
        surface_stiffness(half_space)
    return trace_of(spec.grid(), spec.order), checked_inverse(stiffness, half_space), unknowns


# A power law under surface tension has one stiffness for every size.
@lru_cache(maxsize=8)
def _stiffness(unit: Solid, spec: MeshSpec, recoverable: bool) -> tuple[Array, int]:
    half_space = (half_space_of if recoverable else assembled)(unit, spec)
    return surface_stiffness(half_space, recoverable), half_space.unknowns


def _factor(law: PowerLaw, c: float, stiffness: float = 1.0) -> float:
    """Displacement under a unit load vector, relative to that of E = z^k at the size 1."""
    return float(c ** (1.0 - law.k) * law.c0**law.k / (law.E0 * stiffness))


#: Largest error of the compliance by rounding, relative to its largest entry. What rounding leaves of an event is found
#: on the whole system (measured: 2.4e-7 under a coating 1e4 times as stiff as the solid, and 1e-10 of its force).
LARGEST_ROUNDING = 1e-6


#: Thickness of an element, relative to its depth, from which on rounding is no reason that a stiffness is refused
#: (measured under a fall of the modulus between two rows of a table: by a thousand, refused up to 1.3e-6; by a hundred,
#: up to 2e-8; by ten, up to 2e-9; under a rise by a hundred not down to 4e-12).
SAFE_THICKNESS = 1e-5


def checked_inverse(S: Array, half_space: HalfSpace | None) -> Array:
    """Inverse of a surface stiffness, checked on the half-space that it is of, which has been condensed.

    Raises
    ------
    NotConverged
        If rounding changes the compliance under a load in the centre or at the edge, where the elements are smallest.
    """
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


def compliance_for(
    solid: Solid, spec: MeshSpec, size: float, scaling: bool = True, recoverable: bool = False
) -> Compliance:
    """Return the surface compliance of a solid on a mesh whose edge is at the radius `size`.

    Parameters
    ----------
    solid : Solid
    spec : MeshSpec
        Mesh in units of `size`.
    size : float
        Edge radius; immaterial for a power law without surface tension: one compliance then serves every size.
    scaling : bool
        Whether that is made use of.
    recoverable : bool
        Whether the whole system of the mesh is solved later: the half-space is kept for it.

    Returns
    -------
    Compliance

    Raises
    ------
    NotConverged
        If the stiffness of the mesh is not positive definite.
    """
    try:
        trace, matrix, unknowns = _unit_compliance(unit_of(solid, size), spec, recoverable)
    except NotConverged as error:
        _refuse_thin_elements(spec.grid(), size, error)
        raise
    law = solid.as_power_law
    if law is None:
        return Compliance(trace, matrix, unknowns, size, size)
    serves_all = scaling and not law.surface_tension
    return Compliance(trace, matrix, unknowns, size, _factor(law, size), law if serves_all else None)


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


def unit_of(solid: Solid, size: float) -> Solid:
    """Return the solid on a mesh in units of the size.

    `factor` of the compliance is the rest: the modulus of a power law is z^k.

    Examples
    --------
    >>> unit_of(PowerLaw(8.0, 1.0, 0.0, 0.3, surface_tension=4.0), 2.0)
    PowerLaw(E0=1.0, c0=1.0, k=0.0, nu=0.3, surface_tension=0.25)
    """
    law = solid.as_power_law
    if law is None:
        return solid.in_lengths(size)
    # Elastic forces are those of the unit times c^2 / factor, and those of the tension do not change with c.
    tension = law.surface_tension * _factor(law, size) / size**2
    unit = PowerLaw(1.0, 1.0, law.k, law.nu, tension)
    return ScaledSolid(unit, bonded=True) if solid.bonded else unit
