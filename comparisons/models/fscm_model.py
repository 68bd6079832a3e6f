"""The full self-consistent model, the reference with which the others are compared."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

import fscm
from comparisons.model import Curve, NotApplicable, RadialField, Result
from comparisons.models.gibson_limit import gibson_curve, gibson_profile
from comparisons.models.solver import result_of, surface_of, translated
from comparisons.problem import Problem
from fscm.states import radial_field

__all__ = ["FullSelfConsistent"]

MODELS = {"fscm": "FullSelfConsistent"}

#: Step of a curve: other curves are compared with it between its points (measured: a cubic spline is then
#: within 1e-5 of the picture).
_STEP = 0.05


class FullSelfConsistent:
    """The package `fscm`, its exceptions translated into those of the model contract.

    Examples
    --------
    >>> result = FullSelfConsistent().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force")
    >>> round(result.value, 8)
    1.78848171
    """

    name: ClassVar[str] = "fscm"
    version: ClassVar[str] = "1"
    citation: ClassVar[str] = "Zhu, Zheng, Huang & Yu, Eqs. 24-33, by adaptive panels and product integration"
    domain: ClassVar[str] = "n > 2/3, 0 <= k <= 1; to the digits of u_num where the cohesive edge is wider than 1e-6"

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise as in `comparisons.model.Model`."""
        if quantity not in fscm.QUANTITIES:
            raise NotApplicable(f"the FSCM does not compute {quantity}")
        with translated(fscm.NoSuchEvent, fscm.NotConverged):
            return result_of(fscm.solve(problem.posed, quantity))

    def curve(self, problem: Problem) -> Curve:
        """Return the whole equilibrium path, from far away into contact."""
        with translated(fscm.NoSuchEvent, fscm.NotConverged):
            if problem.posed.k == 1.0:
                return gibson_curve(problem.posed)
            path = fscm.trace(problem.posed, longest_step=_STEP)
        columns = {
            "central_gap": path.central_gap,
            "edge_radius": path.edge_radius,
            "stable_under_displacement": path.stable_under_displacement.astype(float),
            "stable_under_load": path.stable_under_load.astype(float),
        }
        shares = path.u_displacement / np.ptp(path.displacement), path.u_load / np.ptp(path.load)
        # Not a combination of two bounds, but the longest vector with components within them.
        return Curve(path.displacement, path.load, columns, u_distance=float(np.hypot(*shares)))

    def pull_off_profile(self, problem: Problem) -> RadialField:
        """Return the surface where P is smallest, and as its uncertainty the distance of the two meshes."""
        with translated(fscm.NoSuchEvent, fscm.NotConverged):
            if problem.posed.k == 1.0:
                return gibson_profile(problem.posed)
            event = fscm.Analysis(problem.posed).event("pull_off")
        return surface_of(radial_field(event.check), radial_field(event.value))
