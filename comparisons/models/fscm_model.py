"""The package `fscm` as models: the full self-consistent model and the discretisation of the paper."""

from __future__ import annotations

from functools import lru_cache
from typing import ClassVar

import fscm
from comparisons.model import ComputationFailed, Curve, RadialField, Result, refuse, translated
from comparisons.models.gibson_limit import gibson_curve, gibson_profile
from comparisons.models.solver import SolverModel, curve_of, no_critical_number, result_of, surface_of
from comparisons.problem import Problem
from fscm.states import radial_field
from fscm.stieltjes import STIELTJES_QUANTITIES, StieltjesScheme, stieltjes_solution

#: Step of a curve: other curves are compared with it between its points (measured: a cubic spline is then
#: within 1e-5 of the picture).
_STEP = 0.05

#: Columns of a curve with the stability of each state.
_MARKS = ("stable_under_displacement", "stable_under_load")

#: From this Tabor number on the contact of a ball is that of JKR to 1e-3, and its path takes a minute.
_LIKE_JKR = 100.0


class FullSelfConsistent(SolverModel):
    """The reference with which the others are compared.

    Examples
    --------
    >>> result = FullSelfConsistent().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force")
    >>> round(result.value, 8)
    1.78848171
    """

    name: ClassVar[str] = "fscm"
    citation: ClassVar[str] = "Zhu, Zheng, Huang & Yu, Eqs. 24-33, by adaptive panels and product integration"
    domain: ClassVar[str] = "n > 2/3, 0 <= k <= 1; to the digits of u_num where the cohesive edge is wider than 1e-6"
    package = fscm
    quantities = fscm.QUANTITIES

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not: every solid, punch and law is taken, but no friction."""
        if problem.solid.get("friction", "none") != "none":
            return 'the integral equation has no friction; friction = "bonded" is for fem'
        return self._undefined(quantity) or no_critical_number(problem, quantity)

    def pull_off_profile(self, problem: Problem) -> RadialField:
        """Return the surface where P is smallest, and as its uncertainty the distance of the two meshes."""
        refuse(self.skip(problem, "pull_off_gap"))
        with translated(fscm):
            if problem.posed.k == 1.0:
                return gibson_profile(problem.posed)
            _check_size(problem)
            event = self._analysis(problem.posed).event("pull_off")
        return surface_of(radial_field(event.check), radial_field(event.value))

    def _analysis(self, problem: fscm.Problem) -> fscm.Analysis:
        return fscm.Analysis(problem)

    def _result(self, problem: Problem, quantity: str) -> Result:
        _check_size(problem)
        return result_of(fscm.solve(problem.posed, quantity))

    def curve_to(self, problem: Problem, load: float) -> Curve:
        """Return the equilibrium path to a load, or raise as `evaluate`."""
        refuse(self.skip(problem, "force_curve"))
        with translated(fscm):
            return self._curve(problem, load)

    def _curve(self, problem: Problem, load: float | None = None) -> Curve:
        if problem.posed.k == 1.0:
            return gibson_curve(problem.posed)
        _check_size(problem)
        path = fscm.trace(problem.posed, max_load=load, longest_step=_STEP)
        curve = curve_of(path)
        curve.columns.update({name: getattr(path, name).astype(float) for name in _MARKS})
        return curve


class SharedAnalysis(FullSelfConsistent):
    """The same model where several questions are about one problem: they share its path and its events.

    The time of a result is without what was shared.
    """

    def pull_off_surface(self, problem: Problem) -> RadialField:
        """Return the surface where P is smallest, without its uncertainty."""
        refuse(self.skip(problem, "pull_off_gap"))
        with translated(fscm):
            if problem.posed.k == 1.0:
                return gibson_profile(problem.posed)
            _check_size(problem)
            field = radial_field(self._analysis(problem.posed).event("pull_off").value)
        return RadialField(field.radius, field.pressure, field.gap)

    def _analysis(self, problem: fscm.Problem) -> fscm.Analysis:
        return _kept_analysis(problem)

    def _result(self, problem: Problem, quantity: str) -> Result:
        if problem.posed.k == 1.0:
            return super()._result(problem, quantity)
        _check_size(problem)
        return result_of(self._analysis(problem.posed).solution(quantity))


#: Its problem and that with the exact sphere: what a description asks about.
@lru_cache(maxsize=2)
def _kept_analysis(problem: fscm.Problem) -> fscm.Analysis:
    return fscm.Analysis(problem)


def _check_size(problem: Problem) -> None:
    """Raise `ComputationFailed` for a ball that is smaller than its contact, before its path is traced."""
    if problem.punch.kind != "ball" or problem.posed.mu < _LIKE_JKR:
        return
    if problem.is_of_the_paper("solid") and problem.posed.k == 0.0:
        # Imported here: other problems do not need it.
        from comparisons.models.jkr_sphere import JKRSphereProjected

        if reason := JKRSphereProjected().skip(problem, "pull_off_force"):
            raise ComputationFailed(reason)


class StieltjesModel(SolverModel):
    """Eqs. 34-39 as printed in the paper: N uniform segments up to f = 50, Riemann-Stieltjes sums, central-gap control.

    Its curve begins at a central gap of 10 and ends at the first compressive load, at the latest at a gap of -0.4.
    """

    name: ClassVar[str] = "fscm-stieltjes"
    citation: ClassVar[str] = "Zhu, Zheng, Huang & Yu, Sec. 2.4, Eqs. 34-39"
    domain: ClassVar[str] = "k < 1, central gaps from 10 to -0.4, cohesive edge wider than the 2500 segments"
    package = fscm
    quantities = STIELTJES_QUANTITIES
    segments: ClassVar[int] = 2500

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not at k = 1."""
        if reason := super().skip(problem, quantity):
            return reason
        return f"the Stieltjes scheme is for k < 1, not k = {problem.k:g}" if problem.k >= 1.0 else None

    def _result(self, problem: Problem, quantity: str) -> Result:
        return result_of(stieltjes_solution(problem.posed, quantity, self.segments))

    def _curve(self, problem: Problem) -> Curve:
        central_gap, displacement, load = StieltjesScheme(problem.posed, self.segments).curve()
        return Curve(displacement=displacement, load=load, columns={"central_gap": central_gap})


class CoarseStieltjesModel(StieltjesModel):
    """The same with 400 segments: a second instead of minutes.

    At small and moderate Tabor numbers what it leaves out beyond f = 50 is most of its error, with 2500
    segments as with 400 (n = 2, k = 0, mu = 0.5: 0.06 % of the pull-off force with either).

    Examples
    --------
    >>> problem = Problem.dimensionless(n=2, k=0.4, mu=0.5)
    >>> result = CoarseStieltjesModel().evaluate(problem, "pull_off_force")
    >>> abs(result.value - 1.86628026) < result.u_num
    True
    """

    name: ClassVar[str] = "fscm-stieltjes-400"
    domain: ClassVar[str] = StieltjesModel.domain.replace("2500", "400")
    segments: ClassVar[int] = 400
