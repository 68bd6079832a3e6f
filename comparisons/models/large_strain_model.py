"""The finite elements with finite strain as a model."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np

import fem_reference
from comparisons.model import Curve, NotApplicable, Result
from comparisons.models.fem_model import built
from comparisons.models.solver import SolverModel, curve_of, result_of
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES

MODELS = {"fem-large-strain": "LargeStrain"}


class LargeStrain(SolverModel):
    """`fem_reference.solve_large_strain`: a neo-Hookean solid and the traction on its deformed surface, no friction.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 1e-7})
    >>> gel = Problem(Section("homogeneous", {"E": 1e6, "nu": 0.5}), Section("ball", {"R": 1e-5}), law)
    >>> result = LargeStrain().evaluate(gel, "pull_off_force")
    >>> round(result.value, 4), result.u_num < 1e-5
    (1.5343, True)
    """

    name: ClassVar[str] = "fem-large-strain"
    citation: ClassVar[str] = "This package: axisymmetric elements of a neo-Hookean half-space, without friction"
    domain: ClassVar[str] = (
        "problems in physical units, modulus that does not vanish at the surface, tension below 0.4 E*"
    )
    package = fem_reference
    quantities = fem_reference.LARGE_STRAIN_QUANTITIES
    checks_problems: ClassVar[bool] = True

    def _result(self, problem: Problem, quantity: str) -> Result:
        solution = fem_reference.solve_large_strain(_body(problem), quantity)
        return result_of(solution, unit=problem.units[QUANTITIES[quantity].scale])

    def _curve(self, problem: Problem) -> Curve:
        body, units = _body(problem), problem.units
        path = fem_reference.trace_large_strain(body)
        errors = path.u_displacement / np.ptp(path.displacement), path.u_load / np.ptp(path.load)
        return curve_of(path, units, float(np.hypot(*errors).max()))


def _body(problem: Problem) -> fem_reference.Problem:
    """Return the problem of the solver, whose homogeneous solid may be incompressible."""
    if not problem.name:
        raise NotApplicable("n, k and mu do not state how large the strains are; give a problem file")
    if problem.solid.kind != "homogeneous":
        return built(problem)
    solid = fem_reference.NeoHookean(problem.solid["E"], problem.solid["nu"])
    return replace(built(problem.with_value("solid", "nu", 0.0)), solid=solid)
