"""Problem of a graded solid in physical units, and its conversion to the dimensionless one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fscm._typing import Array
from fscm._validation import real_number
from fscm.graded.problem import GradedProblem
from fscm.graded.solids import GradedHalfSpace
from fscm.laws import SurfaceLaw
from fscm.physical import PhysicalProblem
from fscm.punch import PunchShape

__all__ = ["ScaledSolid", "graded_problem"]


@dataclass(frozen=True, slots=True)
class ScaledSolid:
    """A solid whose depths are measured in another unit.

    Parameters
    ----------
    solid : GradedHalfSpace
    unit : float
        The new unit in the old one, > 0.

    Examples
    --------
    >>> from fscm.graded import Exponential
    >>> ScaledSolid(Exponential(E_surface=1.0, E_depth=2.0, length=3.0, nu=0.3), unit=6.0).length
    0.5
    """

    solid: GradedHalfSpace
    unit: float

    def __post_init__(self) -> None:
        unit = real_number("unit", self.unit, low=0.0, high=float("inf"), reason="it is a length")
        object.__setattr__(self, "unit", unit)

    @property
    def length(self) -> float:
        """A depth over which the constants change."""
        return self.solid.length / self.unit

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths at which the constants or their derivatives jump."""
        return tuple(z / self.unit for z in self.solid.interfaces)

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.solid.modulus(self.unit * np.asarray(z, float))

    def poisson(self, z: Array) -> Array:
        """nu(z)."""
        return self.solid.poisson(self.unit * np.asarray(z, float))


def graded_problem(
    solid: GradedHalfSpace,
    *,
    Q: float,
    n: float,
    work_of_adhesion: float,
    z0: float,
    punch: PunchShape | None = None,
    law: SurfaceLaw | None = None,
) -> tuple[GradedProblem, PhysicalProblem]:
    """The dimensionless problem of a graded solid, and the physical problem of its surface, which has the units.

    Parameters
    ----------
    solid : GradedHalfSpace
        In any consistent units.
    Q, n, work_of_adhesion, z0 : float
        As for `PhysicalProblem`.
    punch, law
        As for `Problem`, dimensionless.

    Examples
    --------
    A sphere of 1 micrometre on 1 GPa that rises to 10 GPa over 100 nm; newtons and metres.

    >>> from fscm.graded import Exponential
    >>> pad = Exponential(E_surface=1e9, E_depth=10e9, length=1e-7, nu=0.3)
    >>> problem, surface = graded_problem(pad, Q=1e-6, n=2, work_of_adhesion=0.05, z0=3e-10)
    >>> round(problem.mu, 6), round(problem.solid.length, 6), round(surface.scales["load"], 13)
    (4.248344, 5.773503, 1.570796e-07)
    """
    at = np.zeros(1)
    E, nu = float(solid.modulus(at)[0]), float(solid.poisson(at)[0])
    surface = PhysicalProblem(E, 1.0, 0.0, nu, Q, n, work_of_adhesion, z0)
    return GradedProblem(n, surface.tabor_number, ScaledSolid(solid, surface.length_r), punch, law), surface
