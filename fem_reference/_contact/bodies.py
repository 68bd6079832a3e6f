"""The elastic bodies of a problem: its half-space and, if the punch is elastic, that of the punch.

Both bear the same traction, and the gap closes by the displacement of both.  A body is a half-space on a mesh of its
own; the meshes have the same radial nodes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from fem_reference._elastic.assembly import HalfSpace, half_space_of
from fem_reference._elastic.compliance import Compliance, compliance_for, sum_of, unit_of
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._typing import Array
from fem_reference.solid import Solid

__all__ = [
    "MeshedBody",
    "are_one_power_law",
    "compliance_of",
    "meshed_bodies",
    "plane_strain_modulus",
    "stiffness_at",
]


#: The half-space, and that of an elastic punch.
Solids = tuple[Solid, ...]


@dataclass(frozen=True, slots=True, eq=False)
class MeshedBody:
    """One half-space, ready for conjugate gradients."""

    half_space: HalfSpace
    preconditioner: ElasticPreconditioner


def are_one_power_law(solids: Solids) -> bool:
    """Whether one compliance serves every size: power laws of one exponent without surface tension.

    Examples
    --------
    >>> from fem_reference import Homogeneous, PowerLaw
    >>> graded, uniform = PowerLaw(1.0, 1.0, 0.4, 0.3), Homogeneous(1.0, 0.3)
    >>> [are_one_power_law(solids) for solids in ((graded,), (graded, graded), (graded, uniform))]
    [True, True, False]
    """
    laws = [solid.as_power_law for solid in solids]
    exponents = {None if law is None or law.surface_tension else law.k for law in laws}
    return len(exponents) == 1 and None not in exponents


def compliance_of(
    solids: Solids, spec: MeshSpec, size: float, scaling: bool = True, recoverable: bool = False
) -> Compliance:
    """Return the sum of the compliances of all bodies; the arguments are those of `compliance_for`."""
    first, *others = [compliance_for(solid, mesh, size, scaling, recoverable) for solid, mesh in _meshes(solids, spec)]
    for other in others:
        first = sum_of(first, other, size)
    return first


def meshed_bodies(solids: Solids, spec: MeshSpec, size: float) -> tuple[MeshedBody, ...]:
    """Return the bodies on their meshes in units of the size, ready for their whole system."""
    return _preconditioned(tuple((unit_of(solid, size), mesh) for solid, mesh in _meshes(solids, spec)))


# One: the factors of a body take some 300 MB on a mesh of 5e4 unknowns.
@lru_cache(maxsize=1)
def _preconditioned(bodies: tuple[tuple[Solid, MeshSpec], ...]) -> tuple[MeshedBody, ...]:
    half_spaces = [half_space_of(unit, mesh) for unit, mesh in bodies]
    return tuple(MeshedBody(half_space, ElasticPreconditioner(half_space)) for half_space in half_spaces)


def _meshes(solids: Solids, spec: MeshSpec) -> Iterator[tuple[Solid, MeshSpec]]:
    return zip(solids, (spec, spec.of_punch()), strict=False)


def plane_strain_modulus(solids: Solids, length: Array) -> float:
    """Return the modulus E / (1 - nu^2) that the bodies together have for waves of a length, with surface tension."""
    return _in_series(
        [
            float(solid.modulus(length) / (1.0 - solid.poisson(length) ** 2))
            + 2.0 * solid.surface_tension / float(length)
            for solid in solids
        ]
    )


def stiffness_at(solids: Solids, depth: Array) -> float:
    """Return the modulus E that the bodies together have at a depth."""
    return _in_series([float(solid.modulus(depth)) for solid in solids])


def _in_series(moduli: list[float]) -> float:
    return moduli[0] if len(moduli) == 1 else 1.0 / sum(1.0 / modulus for modulus in moduli)
