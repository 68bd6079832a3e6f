"""The equilibria of a model as a function of the fitted numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from comparisons.fitting.equilibria import (
    Equilibria,
    by_fscm,
    by_jkr,
    has_series,
    is_limit,
    is_without_adhesion,
    paths_alike,
    series_of,
)
from comparisons.fitting.parameters import Key, changed
from comparisons.model import Array
from comparisons.problem import Problem

#: Step of a number for the derivative of a path.
_STEP = 1e-2

#: Derivatives serve numbers that differ by less: they change by a third of that, as the powers of the JKR limit do.
_SAME = 0.1


@dataclass(frozen=True, eq=False)
class Curves:
    """The equilibria of a model for power-law solids and punches.

    Attributes
    ----------
    model : str
        "fscm" or "jkr".
    factor : float
        On all loads.
    """

    model: str
    factor: float = 1.0

    def equilibria(self, problem: Problem, numbers: Mapping[str, float], largest: float) -> Equilibria:
        """Return those of a problem up to a load in N; a search for those of the FSCM may pass through its limits."""
        of_model = by_jkr if self._is_limit(problem, largest) else by_fscm
        displacement, load = of_model(problem, largest)
        return Equilibria(displacement, load * self.factor)

    def _is_limit(self, problem: Problem, largest: float) -> bool:
        return self.model == "jkr" or is_without_adhesion(problem, largest) or is_limit(problem)

    def expanded(self, problem: Problem, largest: float) -> Curves:
        """Return those near a problem: by its series and the derivative of this, or the same where it has none."""
        if self._is_limit(problem, largest) or not has_series(problem, largest):
            return self
        posed = problem.posed
        curve = series_of(posed)
        slopes = curve.derivative("mu")
        path = np.array([curve.displacement, curve.load])
        slope = np.array([slopes.displacement, slopes.load])
        return ExpandedCurves(self.model, self.factor, center=(posed.n, posed.k, posed.mu), path=path, slope=slope)


@dataclass(frozen=True, eq=False)
class ExpandedCurves(Curves):
    """The equilibria near a problem whose path is a series: linear in the Tabor number.

    Attributes
    ----------
    center : tuple of float
        n, k and mu.
    path, slope : ndarray, shape (2, m)
        Displacement and load there, and their exact derivatives by the Tabor number.
    """

    center: tuple[float, float, float] = field(kw_only=True)
    path: Array = field(kw_only=True)
    slope: Array = field(kw_only=True)

    def equilibria(self, problem: Problem, numbers: Mapping[str, float], largest: float) -> Equilibria:
        """Return those of a neighbour; of one with other exponents by its own series."""
        posed, units = problem.posed, problem.units
        if (posed.n, posed.k) != self.center[:2]:
            return super().equilibria(problem, numbers, largest)
        displacement, load = self.path + (posed.mu - self.center[2]) * self.slope
        return Equilibria(displacement * units["displacement"], load * units["load"] * self.factor)


@dataclass(frozen=True, eq=False)
class NearbyCurves(Curves):
    """The equilibria by the FSCM near given numbers: a dimensionless path of their own, and its derivatives.

    Attributes
    ----------
    center : mapping of str to float
        The numbers of the path.
    path : ndarray, shape (2, m)
        Displacement and load.
    expanded_at : mapping of str to float
        The numbers of the derivatives.
    slopes : mapping of str to ndarray, shape (2, m)
        The derivatives.
    """

    center: Mapping[str, float] = field(default_factory=dict)
    path: Array = field(default_factory=lambda: np.empty((2, 0)))
    expanded_at: Mapping[str, float] = field(default_factory=dict)
    slopes: Mapping[str, Array] = field(default_factory=dict)

    def moved(
        self, problem: Problem, keys: Sequence[Key], numbers: Mapping[str, float], largest: float
    ) -> NearbyCurves:
        """Return the equilibria near other numbers, up to a load in N; the derivatives stay if these are near.

        Raises
        ------
        comparisons.model.ComputationFailed
            If there is no such path.
        """
        center = {key.name: numbers.get(key.name, 0.0) for key in keys}
        here = changed(problem, keys, center)
        end = max(largest / here.units["load"], 1.0)
        if self.slopes and all(abs(center[name] - self.expanded_at[name]) < _SAME for name in center):
            (path,) = paths_alike([here.posed], end)
            if path.shape == self.path.shape:
                return NearbyCurves("fscm", self.factor, center, path, self.expanded_at, self.slopes)
        steps = {key.name: _STEP if key.value(center[key.name] + _STEP) < key.limits[1] else -_STEP for key in keys}
        beside = [changed(problem, keys, center | {name: center[name] + step}) for name, step in steps.items()]
        path, *paths = paths_alike([here.posed, *(each.posed for each in beside)], end)
        slopes = {name: (other - path) / step for (name, step), other in zip(steps.items(), paths, strict=True)}
        return NearbyCurves("fscm", self.factor, center, path, center, slopes)

    def expanded(self, problem: Problem, largest: float) -> Curves:
        """Return the same: they are linear already."""
        return self

    def equilibria(self, problem: Problem, numbers: Mapping[str, float], largest: float) -> Equilibria:
        """Return those of a problem of nearby numbers."""
        displacement, load = self.path + sum(
            slope * (numbers[name] - self.center[name]) for name, slope in self.slopes.items()
        )
        return Equilibria(displacement * problem.units["displacement"], load * problem.units["load"] * self.factor)
