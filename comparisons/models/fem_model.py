"""The finite elements as models: with small strain, and with finite strain.

`fem_reference` solves physical problems and contains no Tabor number.  Here a dimensionless problem becomes a
physical one by Eqs. 7, 24 and 29, and every result is scaled back by Eqs. 25 and 31; so where the two references
agree, those equations are right as well.  No scale is 1 and no two are equal: a wrong power of one shows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

import fem_reference
from comparisons.model import Curve, RadialField, Result, refuse, translated
from comparisons.models.solver import SolverModel, curve_of, no_critical_number, result_of, surface_of
from comparisons.numerics.curve_distance import mesh_difference
from comparisons.problem import Problem, Section
from comparisons.quantities import QUANTITIES

if TYPE_CHECKING:
    from fem_reference import export
    from fem_reference.interaction import InteractionName


#: Meshes of a curve: the coarser one, which gives its uncertainty, and that of its points.
_LEVELS = ("quick", "default")

#: Up to this gradient exponent the elements converge: at 0.9 (n = 2, mu = 1) to 5.5e-4 of the pull-off force by their
#: own bound, and to 7e-6 compared with the integral equation; at 0.95 the computation fails.
LARGEST_K = 0.9

#: Lengths, and values of the law, in which a dimensionless problem is solved.
_LENGTHS = {"c0": 3.0, "Q": 2.0}
_LAW = {"work_of_adhesion": 0.7, "z0": 0.25}


class FiniteElements(SolverModel):
    """The package `fem_reference`.

    Parameters
    ----------
    poisson_ratio : float
        Of a dimensionless problem, in [0, 0.5); its result depends on it by numerical errors only.

    Examples
    --------
    >>> FiniteElements().evaluate(Problem.dimensionless(n=2, k=0.95, mu=1.0), "pull_off_force")
    Traceback (most recent call last):
    comparisons.model.NotTaken: the finite elements need k <= 0.9, not k = 0.95: ...
    """

    name: ClassVar[str] = "fem"
    citation: ClassVar[str] = "This package: axisymmetric elements on the graded half-space, solved with pyamg"
    domain: ClassVar[str] = "n >= 1, 0 <= k <= 0.9, 0 <= nu < 0.5; power-law punch and 9-3 law"
    package = fem_reference
    quantities = (*fem_reference.QUANTITIES, "critical_tabor_number")

    def __init__(self, poisson_ratio: float = 0.3) -> None:
        self._poisson_ratio = poisson_ratio

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not: a cusp, a solid near that of Gibson, or a part that the solver refuses."""
        if reason := self._undefined(quantity) or no_critical_number(problem, quantity):
            return reason
        if problem.is_dimensionless:
            return _beyond_elements(problem)
        return _refused(problem)

    def _result(self, problem: Problem, quantity: str) -> Result:
        if quantity == "critical_tabor_number":
            return self._critical_tabor_number(problem)
        units, body = self.physical(problem)
        solution = fem_reference.solve(body, quantity, **_friction(problem))
        return result_of(solution, unit=units[QUANTITIES[quantity].scale])

    def _critical_tabor_number(self, problem: Problem) -> Result:
        """Return the Tabor number of the modulus at which jumps begin; that of the problem is not used."""
        physical = self._in_si(Problem.dimensionless(problem.n, problem.k, 1.0))
        solution = fem_reference.solve(physical.build(fem_reference), fem_reference.CRITICAL_MODULUS)
        # Eq. 29 is steeper at the lower end of the bound of the modulus.
        moduli = solution.value, solution.value - solution.u_num
        value, highest = (physical.with_value("solid.E0", E0).posed.mu for E0 in moduli)
        return result_of(replace(solution, value=value, u_num=highest - value))

    def _curve(self, problem: Problem) -> Curve:
        units, body = self.physical(problem)
        coarse, path = (fem_reference.trace(body, level, **_friction(problem)) for level in _LEVELS)
        u_distance = mesh_difference(coarse.displacement, coarse.load, path.displacement, path.load)
        return curve_of(path, units, u_distance)

    def field(self, problem: Problem, event: str) -> tuple[export.Field, float]:
        """Return displacement and stresses in the whole solid at an event.

        Returns
        -------
        field : fem_reference.export.Field
            Every length in z0, stresses and moduli in dgamma / z0, for the punch of `shape_parameter`.
        radius : float
            Where the tension at the surface is largest, in z0.
        """
        from fem_reference import export  # loads Matplotlib

        refuse(self.skip(problem, "pull_off_force"))
        units, body = self.physical(problem)
        with translated(fem_reference):
            spec, point = fem_reference.event_state(body, event)
            raw = export.contact_field(body.solid, spec, point)
        field = raw.in_units_of(units["displacement"], units["traction"])
        return field, point.edge_radius / units["displacement"]

    @staticmethod
    def shape_parameter(n: float) -> float:
        """Return Q of the punch in units of z0^(n-1): a field is that of one ratio of its two lengths.

        Examples
        --------
        >>> FiniteElements.shape_parameter(2.0)
        8.0
        """
        return _LENGTHS["Q"] / _LAW["z0"] ** (n - 1.0)

    def pull_off_profile(self, problem: Problem) -> RadialField:
        """Return the surface where P is smallest, and as its uncertainty the distance of two meshes."""
        refuse(self.skip(problem, "pull_off_gap"))
        return _surface_at_pull_off(self._poisson_ratio, problem)

    def physical(self, problem: Problem) -> tuple[Mapping[str, float], fem_reference.Problem]:
        """The units of the results, and the problem of the solver."""
        physical = self._in_si(problem) if problem.is_dimensionless else problem
        return physical.units, physical.build(fem_reference)

    def _in_si(self, problem: Problem) -> Problem:
        solid: Any = problem.posed.in_units(nu=self._poisson_ratio, **_LENGTHS, **_LAW).solid
        moduli = Section("power-law", {"E0": solid.E0, "c0": solid.c0, "k": solid.k, "nu": solid.nu})
        punch = Section("power-law", {"n": problem.n, "Q": _LENGTHS["Q"]})
        return Problem(moduli, punch, Section("lennard-jones-9-3", _LAW))


@lru_cache(maxsize=1)
def _surface_at_pull_off(poisson_ratio: float, problem: Problem) -> RadialField:
    """Keep the last surface: its pressure and its gap are requested one after the other."""
    units, body = FiniteElements(poisson_ratio).physical(problem)
    with translated(fem_reference):
        friction = _friction(problem)
        coarse, fine = (fem_reference.profile(body, accuracy=level, **friction) for level in _LEVELS)
    return surface_of(coarse, fine, units)


def _friction(problem: Problem) -> dict[str, Any]:
    """The friction that a problem states, as an argument of the solver."""
    stated = problem.solid.get("friction")
    return {} if stated is None else {"friction": stated}


def _beyond_elements(problem: Problem) -> str | None:
    """Return why the elements do not take n and k; None if they do."""
    if problem.n < 1.0:
        return f"the finite elements need n >= 1, not n = {problem.n:g}: a cusp has no finite slope"
    if problem.k > LARGEST_K:
        return (
            f"the finite elements need k <= {LARGEST_K:g}, not k = {problem.k:g}: towards the Gibson solid the "
            "contact has an edge too narrow for their mesh"
        )
    return None


def _refused(problem: Problem) -> str | None:
    """Return why the solver refuses a part of the problem of a file; None if it does not."""
    try:
        problem.build(fem_reference)
    except ValueError as error:
        return f"the finite elements do not take this problem: {error}"
    return None


class LargeStrain(SolverModel):
    """`fem_reference.solve_large_strain`: a neo-Hookean solid and the traction on its deformed surface, no friction.

    Parameters
    ----------
    interaction : str
        Where the surface force is taken if the problem does not state it: "auto" is the potential of the punch where
        that is known, else the law at the vertical gap, which is "derjaguin".

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 1e-7})
    >>> gel = Problem(Section("homogeneous", {"E": 1e6, "nu": 0.5}), Section("ball", {"R": 1e-5}), law)
    >>> result = LargeStrain().evaluate(gel, "pull_off_force")
    >>> round(result.value, 4), result.u_num < 1e-5
    (1.5569, True)
    """

    name: ClassVar[str] = "fem-large-strain"
    citation: ClassVar[str] = "This package: axisymmetric elements of a neo-Hookean half-space, without friction"
    domain: ClassVar[str] = (
        "problems in physical units, modulus that does not vanish at the surface, tension below 0.4 E*"
    )
    package = fem_reference
    quantities = fem_reference.LARGE_STRAIN_QUANTITIES

    def __init__(self, interaction: InteractionName = "auto") -> None:
        self._interaction = interaction

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, unless a rigid punch is on a plane solid without friction, in SI."""
        if reason := self._undefined(quantity) or no_critical_number(problem, quantity):
            return reason
        if problem.is_dimensionless:
            return "n, k and mu do not state how large the strains are; give a problem file"
        stated = ["solid.friction"] if "solid.friction" in problem.surface else []
        stated += ["punch_solid"] if problem.punch_solid else []
        stated += ["punch.R_solid"] if "R_solid" in problem.punch.values else []
        if not stated:
            return _refused(_compressible(problem))
        return (
            f"finite strain is for a rigid punch on a plane solid without friction: leave out {', '.join(stated)}, or "
            "take small strains"
        )

    def _result(self, problem: Problem, quantity: str) -> Result:
        solution = fem_reference.solve_large_strain(_body(problem), quantity, interaction=self._stated(problem))
        return result_of(solution, unit=problem.units[QUANTITIES[quantity].scale])

    def _curve(self, problem: Problem) -> Curve:
        path = fem_reference.trace_large_strain(_body(problem), interaction=self._stated(problem))
        return curve_of(path, problem.units)

    def _stated(self, problem: Problem) -> InteractionName:
        """The interaction of the problem, or else of this model."""
        stated: InteractionName = problem.law.get("interaction", self._interaction)
        return stated


def _body(problem: Problem) -> fem_reference.Problem:
    """Return the problem of the solver, whose homogeneous solid may be incompressible."""
    body: fem_reference.Problem = _compressible(problem).build(fem_reference)
    if problem.solid.kind != "homogeneous":
        return body
    solid = problem.solid
    tension = solid.get("surface_tension", 0.0)
    return replace(body, solid=fem_reference.NeoHookean(solid["E"], solid["nu"], surface_tension=tension))


def _compressible(problem: Problem) -> Problem:
    """Return the problem with nu = 0 in place of that of a homogeneous solid, which small strains need below 0.5."""
    return problem.with_value("solid.nu", 0.0) if problem.solid.kind == "homogeneous" else problem
