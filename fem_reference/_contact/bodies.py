"""The elastic bodies of a problem: its half-space and, if the punch is elastic, that of the punch.

Both bear the same traction, and the gap closes by the displacement of both.  A body is a half-space on a mesh of its
own; the meshes have the same radial nodes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from fem_reference._elastic.assembly import HalfSpace, half_space_of
from fem_reference._elastic.compliance import Compliance, compliance_for, is_power_law, is_scaling, sum_of, unit_of
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.surface_condition import SurfaceCondition
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._typing import Array
from fem_reference.poisson import poisson_at
from fem_reference.problem import Problem
from fem_reference.solids import Solid

__all__ = [
    "MeshedBody",
    "all_power_laws",
    "are_one_power_law",
    "compliance_of",
    "condition_of",
    "meshed_bodies",
    "plane_strain_modulus",
    "stiffness_at",
]


@dataclass(frozen=True, slots=True, eq=False)
class MeshedBody:
    """One half-space, ready for conjugate gradients."""

    half_space: HalfSpace
    preconditioner: ElasticPreconditioner


def condition_of(solid: Solid) -> SurfaceCondition:
    """Return what holds at the surface of a solid."""
    return SurfaceCondition(getattr(solid, "surface_tension", 0.0), getattr(solid, "bonded", False))


def are_one_power_law(problem: Problem, kinks: tuple[float, ...] = ()) -> bool:
    """Whether one compliance serves every size: power laws of one exponent, no surface tension, no lines of the punch.

    Examples
    --------
    >>> from fem_reference import Homogeneous, LennardJones, PowerLaw, PowerPunch
    >>> parts = PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    >>> graded, uniform = PowerLaw(1.0, 1.0, 0.4, 0.3), Homogeneous(1.0, 0.3)
    >>> [are_one_power_law(Problem(graded, *parts, punch_solid=solid)) for solid in (None, graded, uniform)]
    [True, True, False]
    """
    solids = problem.solids
    scaling = all(is_scaling(solid.modulus, solid.poisson, kinks) for solid in solids)
    tense = any(condition_of(solid).tension for solid in solids)
    return scaling and not tense and len({solid.modulus.depth_exponent for solid in solids}) == 1


def compliance_of(
    problem: Problem, spec: MeshSpec, size: float, scaling: bool = True, recoverable: bool = False
) -> Compliance:
    """Return the sum of the compliances of all bodies; the arguments are those of `compliance_for`."""
    first, *others = [
        compliance_for(solid.modulus, solid.poisson, mesh, size, scaling, recoverable, condition_of(solid))
        for solid, mesh in _meshes(problem, spec)
    ]
    for other in others:
        first = sum_of(first, other, size)
    return first


def meshed_bodies(problem: Problem, spec: MeshSpec, size: float) -> tuple[MeshedBody, ...]:
    """Return the bodies on their meshes in units of the size, ready for their whole system."""
    units = tuple(
        (*unit_of(solid.modulus, solid.poisson, size, condition_of(solid)), mesh)
        for solid, mesh in _meshes(problem, spec)
    )
    return _preconditioned(units)


# One: the factors of a body take some 300 MB on a mesh of 5e4 unknowns.
@lru_cache(maxsize=1)
def _preconditioned(units: Any) -> tuple[MeshedBody, ...]:
    half_spaces = [half_space_of(modulus, nu, mesh, condition) for modulus, nu, condition, mesh in units]
    return tuple(MeshedBody(half_space, ElasticPreconditioner(half_space)) for half_space in half_spaces)


def _meshes(problem: Problem, spec: MeshSpec) -> Iterator[tuple[Solid, MeshSpec]]:
    return zip(problem.solids, (spec, spec.of_punch()), strict=False)


def plane_strain_modulus(problem: Problem, length: Array) -> float:
    """Return the modulus E / (1 - nu^2) that the bodies together have for waves of a length, with surface tension."""
    return _in_series(
        [
            float(solid.modulus(length) / (1.0 - poisson_at(solid.poisson, length) ** 2))
            + 2.0 * condition_of(solid).tension / float(length)
            for solid in problem.solids
        ]
    )


def stiffness_at(problem: Problem, depth: Array) -> float:
    """Return the modulus E that the bodies together have at a depth."""
    return _in_series([float(solid.modulus(depth)) for solid in problem.solids])


def _in_series(moduli: list[float]) -> float:
    return moduli[0] if len(moduli) == 1 else 1.0 / sum(1.0 / modulus for modulus in moduli)


def all_power_laws(problem: Problem) -> bool:
    """Whether each body is a power law with one Poisson ratio."""
    return all(is_power_law(solid.modulus, solid.poisson) for solid in problem.solids)
