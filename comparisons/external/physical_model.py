"""Models of physical quantities, evaluated for dimensionless problems.

An author whose code takes a modulus, a radius and a work of adhesion writes `evaluate_physical` in place of
`evaluate`; no Tabor number is needed.  The dimensionless result must not depend on the scales of the physical
problem; `check-model` tries several.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Protocol, runtime_checkable

from comparisons.model import Result
from comparisons.quantities import QUANTITIES
from fscm.problem import Problem

__all__ = ["SCALES", "PhysicalCase", "PhysicalModel", "evaluate_in_units"]


@dataclasses.dataclass(frozen=True, slots=True)
class PhysicalCase:
    """The parameters of a power-law solid, a power-law punch and the 9-3 law, in consistent units.

    Attributes
    ----------
    E0, c0, k, nu : float
        Of the modulus E0 (z/c0)^k, and Poisson's ratio.
    Q, n : float
        Of the punch r^n / (n Q).
    work_of_adhesion, z0 : float
        Of the law.
    scales : mapping of str to float
        Units of dimensionless quantities, as of `fscm.Problem.units`.
    """

    E0: float
    c0: float
    k: float
    nu: float
    Q: float
    n: float
    work_of_adhesion: float
    z0: float
    scales: Mapping[str, float]


@runtime_checkable
class PhysicalModel(Protocol):
    """A model of the physical problem; name, version, citation and domain as in `comparisons.model.Model`."""

    name: str
    version: str
    citation: str
    domain: str

    def evaluate_physical(self, problem: PhysicalCase, quantity: str) -> Result:
        """Return the quantity in units of `problem`: a load in traction * length^2, a gap in length."""
        ...


#: Scales (c0, Q, work_of_adhesion, z0): a micrometre sphere in SI units, the same in nanometres and
#: nanonewtons, and units in which no scale is 1 and no two are equal.
SCALES: tuple[dict[str, float], ...] = (
    {"c0": 1e-6, "Q": 1e-6, "work_of_adhesion": 0.05, "z0": 3e-10},
    {"c0": 1e3, "Q": 1e3, "work_of_adhesion": 0.05, "z0": 0.3},
    {"c0": 0.7, "Q": 11.0, "work_of_adhesion": 5.0, "z0": 1.3},
)


def evaluate_in_units(
    model: PhysicalModel, problem: Problem, quantity: str, poisson_ratio: float | None = None, scales: int = 0
) -> Result:
    """Return the dimensionless quantity of a physical model, or raise as the model does.

    Parameters
    ----------
    model : PhysicalModel
    problem : fscm.Problem
    quantity : str
    poisson_ratio : float, optional
        By default 0.3; the Gibson solid k = 1 has 0.5 in any case.
    scales : int
        Which of `SCALES`.
    """
    # Q is a length^(n-1): the same length for every shape index.
    lengths = SCALES[scales] | {"Q": SCALES[scales]["Q"] ** (problem.n - 1.0)}
    nu = 0.5 if problem.k == 1.0 else 0.3 if poisson_ratio is None else poisson_ratio
    physical = problem.in_units(nu=nu, **lengths)
    E0 = physical.solid.E0  # type: ignore[union-attr]
    case = PhysicalCase(E0=E0, k=problem.k, nu=nu, n=problem.n, scales=physical.units, **lengths)
    result, kind = model.evaluate_physical(case, quantity), QUANTITIES[quantity].scale
    if not isinstance(result, Result) or kind == "number":
        return result
    unit = physical.units[kind]
    return dataclasses.replace(result, value=result.value / unit, u_num=result.u_num / unit)
