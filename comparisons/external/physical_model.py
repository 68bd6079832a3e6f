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

__all__ = ["SCALES", "InUnits", "PhysicalCase", "PhysicalModel"]


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


class InUnits:
    """A physical model as a model of dimensionless problems.

    Parameters
    ----------
    model : PhysicalModel
    poisson_ratio : float, optional
        By default 0.3; the Gibson solid k = 1 has 0.5 in any case.
    scales : int
        Which of `SCALES`.
    """

    def __init__(self, model: PhysicalModel, poisson_ratio: float | None = None, scales: int = 0) -> None:
        self._model = model
        self._poisson_ratio = 0.3 if poisson_ratio is None else poisson_ratio
        self._scales = SCALES[scales]

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the dimensionless quantity, or raise as the model does."""
        physical = self._physical(problem)
        result = self._model.evaluate_physical(physical, quantity)
        if not isinstance(result, Result):
            return result
        kind = QUANTITIES[quantity].scale
        if kind == "number":
            return result
        return dataclasses.replace(
            result,
            value=result.value / physical.scales[kind],
            u_num=result.u_num / physical.scales[kind],
        )

    def _physical(self, problem: Problem) -> PhysicalCase:
        # Q is a length^(n-1): the same length for every shape index.
        scales = self._scales | {"Q": self._scales["Q"] ** (problem.n - 1.0)}
        nu = 0.5 if problem.k == 1.0 else self._poisson_ratio
        physical = problem.in_units(nu=nu, **scales)
        E0 = physical.solid.E0  # type: ignore[union-attr]
        return PhysicalCase(E0=E0, k=problem.k, nu=nu, n=problem.n, scales=physical.units, **scales)
