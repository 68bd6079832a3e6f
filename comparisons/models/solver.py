"""Base of the adapters: the solutions of a solver become results of the model contract."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping
from dataclasses import replace
from types import ModuleType
from typing import Any, ClassVar

import numpy as np

from comparisons.model import EFFORT, Curve, NotTaken, RadialField, Result, refuse, translated
from comparisons.numerics.curve_distance import mesh_difference
from comparisons.problem import Problem
from comparisons.problem.problem import beyond_numbers
from comparisons.quantities import ALL_QUANTITIES, Kind

_ONES = dict.fromkeys(("displacement", "gap", "load", "radius", "traction"), 1.0)


class SolverModel(ABC):
    """A model whose quantities a solver computes.

    A subclass has `_result`; `_curve` if it has a curve, and `pull_off_profile` if it has the surface at pull-off.

    Attributes
    ----------
    name, version, citation, domain : str
        As in `comparisons.model.Model`.
    package : module
        `fscm` or `fem_reference`.
    quantities : collection of str
        What it computes.
    """

    name: ClassVar[str]
    version: str = "1"
    citation: ClassVar[str]
    domain: ClassVar[str]
    package: ModuleType
    quantities: Collection[str]

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why the solver does not take a quantity of a problem; None if it does.

        By default it takes every problem of n, k and mu.
        """
        return self._undefined(quantity) or beyond_numbers(problem, self.name)

    def _undefined(self, quantity: str) -> str | None:
        """Return why the solver does not compute a quantity; None if it does."""
        kind = ALL_QUANTITIES[quantity].kind if quantity in ALL_QUANTITIES else Kind.SCALAR
        if kind is Kind.FIELD:
            return None if hasattr(self, "pull_off_profile") else "the model does not know the surface at pull-off"
        if kind is Kind.CURVE:
            has_curve = type(self)._curve is not SolverModel._curve
            return None if has_curve else f"{self.name} has values at events and no force-displacement curve"
        return None if quantity in self.quantities else f"{self.name} does not compute {quantity}"

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise as in `comparisons.model.Model`."""
        refuse(self.skip(problem, quantity))
        with translated(self.package):
            return self._result(problem, quantity)

    def curve(self, problem: Problem) -> Curve:
        """Return the equilibrium path from far away into contact, or raise as `evaluate`."""
        refuse(self.skip(problem, "force_curve"))
        with translated(self.package):
            return self._curve(problem)

    @abstractmethod
    def _result(self, problem: Problem, quantity: str) -> Result: ...

    def _curve(self, problem: Problem) -> Curve:
        raise NotTaken(self._undefined("force_curve"))


def no_critical_number(problem: Problem, quantity: str) -> str | None:
    """Return why a problem has no critical Tabor number, if that is the quantity; None otherwise."""
    if quantity != "critical_tabor_number" or problem.is_of_the_paper():
        return None
    return "the critical Tabor number is that of a power-law solid and punch with the 9-3 law"


def result_of(solution: Any, unit: float = 1.0) -> Result:
    """Return a solution as a result, its value and uncertainty divided by `unit`.

    Examples
    --------
    >>> result_of(Result(value=3.0, u_num=3e-9), unit=2.0).value
    1.5
    """
    return Result(
        value=solution.value / unit,
        u_num=solution.u_num / unit,
        **{name: getattr(solution, name) for name in EFFORT if hasattr(solution, name)},
    )


def surface_of(coarse: Any, fine: Any, units: Mapping[str, float] = _ONES) -> RadialField:
    """Return the surface of the finer mesh in `units`; its uncertainty is the distance of the two meshes."""
    surfaces = [
        RadialField(state.radius / units["radius"], state.pressure / units["traction"], state.gap / units["gap"])
        for state in (coarse, fine)
    ]
    pressure, gap = (
        mesh_difference(*surfaces[0].shown(name)[:2], *surfaces[1].shown(name)[:2]) for name in ("pressure", "gap")
    )
    return replace(surfaces[1], u_distance=pressure, u_gap_distance=gap)


def curve_of(path: Any, units: Mapping[str, float] = _ONES, u_distance: float | None = None) -> Curve:
    """Return the path of a solver as a curve, divided by the units of the paper.

    Its bound is by default that of the solver: not a combination of two bounds, but the longest vector with components
    within them.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> path = SimpleNamespace(displacement=2.0, load=3.0, central_gap=4.0, edge_radius=5.0)
    >>> curve_of(path, {"displacement": 2.0, "load": 1.0, "gap": 2.0, "radius": 5.0}, 0.1).columns
    {'central_gap': 2.0, 'edge_radius': 1.0}
    """
    if u_distance is None:
        shares = path.u_displacement / np.ptp(path.displacement), path.u_load / np.ptp(path.load)
        u_distance = float(np.hypot(*shares).max())
    columns = {"central_gap": path.central_gap / units["gap"], "edge_radius": path.edge_radius / units["radius"]}
    return Curve(path.displacement / units["displacement"], path.load / units["load"], columns, u_distance)
