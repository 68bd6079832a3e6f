"""Sensitivity of a value at an event to the problem."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fscm._bound.adjoint import WITH_GRADIENT, Adjoint, AtExtreme, parameter
from fscm._threads import one_thread
from fscm._typing import Array
from fscm.accuracy import Accuracy, Meshes
from fscm.analysis import Analysis
from fscm.gibson import GibsonSolid
from fscm.problem import Problem
from fscm.punch import PowerPunch
from fscm.quantities import EXTREMAL, TABLE, AtEvent, quantity_named
from fscm.solution import Solution

__all__ = ["SENSITIVE", "ValueSensitivity", "sensitivity"]

#: Quantities that have a sensitivity: those that are functionals of the state at one event.
SENSITIVE = tuple(name for name, row in TABLE.items() if isinstance(row, AtEvent) and row.functional in WITH_GRADIENT)

#: Step of a parameter, relative to its unit, and points of the differences in steps.  The rule _MANY is of fourth
#: order. A new solid needs a new kernel, for which there are two points only: their error is 1e-7 of the third
#: derivative, and that of the fit of the kernel, 1e-10, contributes 1e-7.
_STEP, _MANY, _FEW = 1e-3, (-2.0, -1.0, 1.0, 2.0), (-1.0, 1.0)
_MANY_ONE_SIDED, _FEW_ONE_SIDED = (1.0, 2.0, 3.0, 4.0), (1.0, 2.0)


def difference_rule(positions: tuple[float, ...]) -> Array:
    """Weights for the derivative at 0 of the values at these positions, in steps, and at 0.

    Examples
    --------
    >>> difference_rule((-1.0, 1.0)).round(12) + 0.0
    array([-0.5,  0.5,  0. ])
    """
    x = np.append(positions, 0.0)
    derivative = np.zeros(len(x))
    derivative[1] = 1.0
    return np.asarray(np.linalg.solve(np.vander(x, increasing=True).T, derivative), float)


class ValueSensitivity:
    """A value at an event, and its change with the problem to first order.

    Parameters
    ----------
    problem : Problem
    quantity : str
        One of `SENSITIVE`.
    accuracy : float or str
        As for `solve`.

    Attributes
    ----------
    solution : Solution
        The value, in the units of the problem.
    """

    solution: Solution

    def __init__(self, problem: Problem, quantity: str, accuracy: Accuracy = "default") -> None:
        row = quantity_named(quantity)
        if not isinstance(row, AtEvent) or quantity not in SENSITIVE:
            raise ValueError(
                f"the quantity {quantity} is none of those with a sensitivity, {', '.join(SENSITIVE)}: "
                "they are values at one event"
            )
        self.problem, self._quantity, self._kind = problem, quantity, row.kind
        core, unit = problem.dimensionless, problem.units[row.kind]
        if core.k == 1.0:
            self._core = GibsonSolid(core).solution(quantity)
            self.solution = self._core.times(unit, problem.unit_name(row.kind))
            return
        analysis = Analysis(core, Meshes.of(accuracy))
        self._core = analysis.solution(quantity)
        self.solution = self._core.times(unit, problem.unit_name(row.kind))
        state, extremal = analysis.event(row.event).value, EXTREMAL[row.event]
        self._sign = row.sign
        self._rule: Adjoint | AtExtreme
        if extremal is None:
            self._rule = Adjoint(state, row.functional, "load")
        elif extremal == row.functional:
            self._rule = Adjoint(state, row.functional, parameter(state)[0])
        else:
            self._rule = AtExtreme(state, row.functional, extremal)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._quantity}, {self.solution!r}, {self.problem!r})"

    @one_thread()
    def change(self, problem: Problem) -> float:
        """Change of the value when its problem becomes another one nearby, to first order; no equilibrium is solved.

        Parameters
        ----------
        problem : Problem
            With its own units, if it is a physical one; the value itself may then be proportional to one of them.

        Examples
        --------
        >>> found = sensitivity(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
        >>> round(found.change(Problem(n=2, k=0.4, mu=1.01)) / 0.01, 3)
        -0.1
        """
        unit = problem.units[self._kind]
        change = self._dimensionless_change(problem.dimensionless)
        return self._core.value * (unit - self.problem.units[self._kind]) + change * unit

    def _dimensionless_change(self, problem: Problem) -> float:
        if (problem.k == 1.0) != (self.problem.k == 1.0):
            raise ValueError("a solid of k < 1 and that of k = 1 are no neighbours: their equations differ")
        if problem.k == 1.0:
            # Its equations are local: a value exact to rounding takes no time.
            return GibsonSolid(problem).solution(self._quantity).value - self._core.value
        return self._sign * self._rule.change(problem)

    def _new_solid(self, problem: Problem) -> bool:
        """Whether a problem needs another kernel, which costs time."""
        return problem.dimensionless.graded != self.problem.dimensionless.graded

    def derivative(
        self,
        vary: Callable[[float], Problem],
        at: float,
        unit: float,
        low: float = -math.inf,
        high: float = math.inf,
    ) -> float:
        """Derivative of the value by a parameter.

        Parameters
        ----------
        vary : callable
            Parameter -> the problem.
        at : float
            The parameter of the present problem.
        unit : float
            Change of the parameter that changes the problem by its own size; differences use a thousandth of it.
        low, high : float
            Range of the parameter; at its end the differences are one-sided.

        Examples
        --------
        Of the pull-off force P = pi R dgamma P_c(mu) by the radius of a sphere:

        >>> from fscm import Homogeneous, LennardJones, PowerPunch
        >>> def sphere(R):
        ...     law = LennardJones(work_of_adhesion=0.05, z0=3e-10)
        ...     return Problem(Homogeneous(E=70e9, nu=0.2), PowerPunch(n=2, Q=R), law)
        >>> found = sensitivity(sphere(1e-6), "pull_off_force")
        >>> slope = found.derivative(sphere, 1e-6, 1e-6)
        >>> round(slope * 1e-6 / found.solution.value, 4)     # d ln P / d ln R
        0.9772
        """
        step = _STEP * unit
        few = self._new_solid(vary(at + step if at + step < high else at - step))
        positions: tuple[float, ...] = _FEW if few else _MANY
        if not low < at + positions[0] * step or not at + positions[-1] * step < high:
            positions = _FEW_ONE_SIDED if few else _MANY_ONE_SIDED
            if not at + positions[-1] * step < high:
                positions = tuple(-position for position in positions)
        weights = difference_rule(positions)
        total = weights[-1] * self._core.value * vary(at).units[self._kind]
        for position, weight in zip(positions, weights[:-1], strict=True):
            problem = vary(at + position * step)
            change = self._dimensionless_change(problem.dimensionless)
            total += weight * (self._core.value + change) * problem.units[self._kind]
        return float(total / step)

    @property
    def gradient(self) -> dict[str, float]:
        """Derivatives of the dimensionless value: by "mu", of a power law by "k", of a power-law punch by "n".

        Examples
        --------
        >>> found = sensitivity(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
        >>> {name: round(slope, 4) for name, slope in found.gradient.items()}
        {'mu': -0.0996, 'k': 0.3184, 'n': -0.8187}
        """
        p = self.problem.dimensionless
        gradient = {"mu": self.derivative(lambda mu: replace(p, mu=mu), p.mu, p.mu)}
        if p.graded is None and p.k < 1.0:
            gradient["k"] = self.derivative(lambda k: replace(p, k=k), p.k, 1.0, low=0.0, high=1.0)
        if isinstance(p.punch, PowerPunch):
            gradient["n"] = self.derivative(
                lambda n: replace(p, n=n, punch=PowerPunch(n)), p.n, p.n, low=0.5 * (1.0 - p.k), high=300.0
            )
        return gradient


@one_thread()
def sensitivity(problem: Problem, quantity: str, accuracy: Accuracy = "default") -> ValueSensitivity:
    """Compute a value at an event and prepare its derivatives, by one more linear solution.

    Parameters
    ----------
    problem, accuracy
        As for `solve`.
    quantity : str
        One of `SENSITIVE`.

    Returns
    -------
    ValueSensitivity
        The value with its bound (`solution`), its derivatives by n, k and mu (`gradient`), by a parameter of the user
        (`derivative`), and its first-order change to any problem nearby (`change`).

    Raises
    ------
    ValueError, NoSuchEvent, NotConverged
        As for `solve`.

    Examples
    --------
    >>> found = sensitivity(Problem(n=2, k=0, mu=1.0), "zero_load_displacement")
    >>> round(found.solution.value, 6), round(found.gradient["mu"], 6)
    (2.075069, 1.932362)
    """
    return ValueSensitivity(problem, quantity, accuracy)
