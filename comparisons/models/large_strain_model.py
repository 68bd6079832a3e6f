"""The finite elements of finite strain as a model: a neo-Hookean solid, and the traction on its deformed surface."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import fem_reference
from comparisons.model import Curve, NotApplicable, Result
from comparisons.models.solver import result_of, translated
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES

__all__ = ["LargeStrain"]

MODELS = {"fem-large-strain": "LargeStrain"}


class LargeStrain:
    """`fem_reference.solve_large_strain`, without friction.

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
    version: ClassVar[str] = "1"
    citation: ClassVar[str] = "This package: axisymmetric elements of a neo-Hookean half-space, without friction"
    domain: ClassVar[str] = (
        "problems in physical units, modulus that does not vanish at the surface, tension below 0.4 E*"
    )
    #: It checks them itself (`comparisons.problem.evaluation`).
    punches: ClassVar[tuple[str, ...]] = ()

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise as in `comparisons.model.Model`."""
        if quantity not in fem_reference.LARGE_STRAIN_QUANTITIES:
            raise NotApplicable(f"finite strain does not state {quantity}")
        if not problem.name:
            raise NotApplicable("n, k and mu do not state how large the strains are; give a problem file")
        with translated(fem_reference.NoSuchEvent, fem_reference.NotConverged):
            solution = fem_reference.solve_large_strain(self._body(problem), quantity)
        return result_of(solution, unit=problem.units[QUANTITIES[quantity].scale])

    def curve(self, problem: Problem) -> Curve:
        """Raise `NotApplicable`: where the branches of a path with finite strain meet is not verified yet."""
        raise NotApplicable("finite strain states values at events, no force curve")

    @staticmethod
    def _body(problem: Problem) -> fem_reference.Problem:
        """The problem of the solver; a homogeneous solid may be incompressible."""
        try:
            if problem.solid.kind != "homogeneous":
                return problem.build(fem_reference)
            body = problem.with_value("solid", "nu", 0.0).build(fem_reference)
        except ValueError as error:
            raise NotApplicable(f"the finite elements do not take this problem: {error}") from None
        return replace(body, solid=fem_reference.NeoHookean(problem.solid["E"], problem.solid["nu"]))
