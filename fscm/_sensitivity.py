r"""Sensitivity of a value at an event to the problem, by the adjoint of the equilibrium.

The discrete equilibrium with a control is F(y, p) = 0, and J(y, p) is a value at its solution.  With B = dF/dy and
B^T a = dJ/dy,

    dJ/dp = J_p - a . F_p,

where J_p and F_p are taken at the fixed state y: one more linear solution serves every parameter, and F_p needs no
equilibrium.  At its own extreme a value does not change along the path, so that any control will do.  Another value
also moves with the place s of the extreme, by J_s ds = -J_s d(L_s)/L_ss with the functional L that is extreme.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import scipy

from fscm._arc_length import parameter_of, rates_of
from fscm._continuation import moved
from fscm._equilibrium import Control, Discretisation, Linearisation, State
from fscm._meshes import Accuracy, Meshes
from fscm._threads import one_thread
from fscm._typing import Array
from fscm.analysis import EXTREMAL, Analysis
from fscm.errors import NotConverged
from fscm.gibson import GibsonSolid
from fscm.problem import Problem
from fscm.punch import PowerPunch, kinks_of
from fscm.quantities import TABLE, AtEvent, quantity_named
from fscm.solution import Solution

__all__ = ["SENSITIVE", "ValueSensitivity", "sensitivity"]

#: Quantities that have a sensitivity: those that are functionals of the state at one event.
SENSITIVE = tuple(name for name, row in TABLE.items() if isinstance(row, AtEvent))

# Steps of a parameter, relative to its unit, and places of the differences in steps.  The error of the first rule is of
# the fourth order; a new solid costs a new kernel, so that two places have to do: their error is 1e-7 of the third
# derivative, and that of the fit of the kernel, 1e-10, counts 1e-7.
_STEP, _MANY, _FEW = 1e-3, (-2.0, -1.0, 1.0, 2.0), (-1.0, 1.0)
_MANY_ONE_SIDED, _FEW_ONE_SIDED = (1.0, 2.0, 3.0, 4.0), (1.0, 2.0)
# Step of the continuation parameter for the rate of a change, relative to its unit: between two states whose rounding
# is 1e-13.
_PATH_STEP = 1e-4


def difference_rule(places: tuple[float, ...]) -> Array:
    """Weights of the values at some places, in units of the step, for the derivative at 0; the value there is the last.

    Examples
    --------
    >>> difference_rule((-1.0, 1.0)).round(12) + 0.0
    array([-0.5,  0.5,  0. ])
    """
    x = np.append(places, 0.0)
    derivative = np.zeros(len(x))
    derivative[1] = 1.0
    return np.asarray(np.linalg.solve(np.vander(x, increasing=True).T, derivative), float)


class _Adjoint:
    """Change of a functional at a fixed value of a control, to first order, when the problem changes.

    Parameters
    ----------
    state : State
        In equilibrium.
    functional, control : str
        Of "load", "displacement", "central_gap"; the control may also be "log_scale".
    """

    def __init__(self, state: State, functional: str, control: str) -> None:
        self._state, self._functional, self._control = state, functional, control
        system = Linearisation(state)
        matrix = system.bordered()
        matrix[-1] = system.row(_unit(control))
        lu, pivots, info = scipy.linalg.lapack.dgetrf(matrix, overwrite_a=1)
        if info != 0:
            raise NotConverged("the tangent at the event is singular: its adjoint is not known")
        self._adjoint: Array = scipy.linalg.lapack.dgetrs(lu, pivots, system.row(_unit(functional)), trans=1)[0]
        self._value, self._left = getattr(state, functional), self._left_sides(state, system)

    def _left_sides(self, state: State, system: Linearisation) -> Array:
        control = math.log(state.scale) if self._control == "log_scale" else getattr(state, self._control)
        return np.concatenate([system.residual, [system.anchor, control]])

    def change(self, problem: Problem) -> float:
        """The change from the problem of the state to another one, on the same mesh."""
        known = self._state.disc
        state = _at_fixed_unknowns(self._state, Discretisation(problem, known.mesh, known))
        left = self._left_sides(state, Linearisation(state))
        return float(getattr(state, self._functional) - self._value - self._adjoint @ (left - self._left))


def _unit(name: str) -> Control:
    return Control(0.0, **{"gap" if name == "central_gap" else name: 1.0})


def _at_fixed_unknowns(state: State, disc: Discretisation) -> State:
    """The state with the same unknowns, but for a punch with kinks: the mesh has breaks there and follows them.

    To first order a change does not depend on the unknowns at which the equations of the other problem are evaluated.
    """
    known, new = kinks_of(state.disc.problem.punch), kinks_of(disc.problem.punch)
    scale = state.scale * new[0] / known[0] if known and len(new) == len(known) else state.scale
    if state.lift is not None:
        return State.lifted(
            disc, scale, state.lift, state.displacement, state.follows_edge, state.edge_gap, state.turned
        )
    if scale == state.scale:
        return replace(state, disc=disc)
    gap = state.gap + (disc.height(scale * disc.mesh.nodes) - state.disc.height(state.radius))
    return replace(state, disc=disc, scale=scale, gap=gap)


class _AtExtreme:
    """Change of a functional at the extreme of another one, to first order: it moves with the place of the extreme.

    Parameters
    ----------
    state : State
        At the extreme.
    functional, extremal : str
        As for `_Adjoint`; the functional is another one.
    """

    def __init__(self, state: State, functional: str, extremal: str) -> None:
        parameter, unit = _parameter(state)
        rates, step = rates_of(state), _PATH_STEP * unit
        near = [moved(state, rates, parameter_of(state) + side * step) for side in (-1.0, 1.0)]
        before, after = (getattr(rates_of(one), extremal) for one in near)
        # s moves by -d(L_s)/L_ss; both derivatives by s are differences over the same steps.
        self._factor = -getattr(rates, functional) / (after - before)
        self._here = _Adjoint(state, functional, parameter)
        self._beside = [_Adjoint(one, extremal, parameter) for one in near]

    def change(self, problem: Problem) -> float:
        """The change from the problem of the state to another one."""
        before, after = (one.change(problem) for one in self._beside)
        return self._here.change(problem) + self._factor * (after - before)


def _parameter(state: State) -> tuple[str, float]:
    """Functional that is the continuation parameter of a state, and its unit."""
    if state.parameter == "gap":
        return "central_gap", state.central_gap - state.disc.problem.law.singular_gap
    return state.parameter, 1.0 if state.parameter == "log_scale" else 1.0 + abs(parameter_of(state))


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
        The value.
    """

    solution: Solution

    def __init__(self, problem: Problem, quantity: str, accuracy: Accuracy = "default") -> None:
        row = quantity_named(quantity)
        if not isinstance(row, AtEvent):
            raise ValueError(
                f"the quantity {quantity} is none of those with a sensitivity, {', '.join(SENSITIVE)}: "
                "they are values at one event"
            )
        self.problem, self._quantity = problem, quantity
        meshes = Meshes.of(accuracy)
        if problem.k == 1.0:
            self.solution = GibsonSolid(problem).solution(quantity)
            return
        analysis = Analysis(problem, meshes)
        self.solution = analysis.solution(quantity)
        state, extremal = analysis.event(row.event).value, EXTREMAL[row.event]
        self._sign = row.sign
        self._rule: _Adjoint | _AtExtreme
        if extremal is None:
            self._rule = _Adjoint(state, row.attribute, "load")
        elif extremal == row.attribute:
            self._rule = _Adjoint(state, row.attribute, _parameter(state)[0])
        else:
            self._rule = _AtExtreme(state, row.attribute, extremal)

    @one_thread()
    def change(self, problem: Problem) -> float:
        """Change of the value when its problem becomes another one nearby, to first order; no equilibrium is solved.

        Parameters
        ----------
        problem : Problem
            With the same units of its radii and heights.

        Examples
        --------
        >>> found = sensitivity(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
        >>> round(found.change(Problem(n=2, k=0.4, mu=1.01)) / 0.01, 3)
        -0.1
        """
        if (problem.k == 1.0) != (self.problem.k == 1.0):
            raise ValueError("a solid of k < 1 and that of k = 1 are no neighbours: their equations differ")
        if problem.k == 1.0:
            # Its equations are local: a value is solved to rounding in no time.
            return GibsonSolid(problem).solution(self._quantity).value - self.solution.value
        return self._sign * self._rule.change(problem)

    def _new_solid(self, problem: Problem) -> bool:
        """Whether a problem needs another kernel that costs time."""
        return getattr(problem, "solid", None) != getattr(self.problem, "solid", None)

    def derivative(
        self,
        vary: Callable[[float], tuple[Problem, float]],
        at: float,
        unit: float,
        low: float = -math.inf,
        high: float = math.inf,
    ) -> float:
        """Derivative of the value, in the user's unit, by a parameter.

        Parameters
        ----------
        vary : callable
            Parameter -> the problem, and the unit of the value.
        at : float
            The parameter of the present problem.
        unit : float
            Over which the problem changes by its own size; differences are taken over a thousandth of it.
        low, high : float
            Range of the parameter; at its end the differences are one-sided.

        Examples
        --------
        Of the pull-off force P = pi R dgamma P_c(mu) by the radius of a sphere:

        >>> from fscm import PhysicalProblem
        >>> def sphere(R):
        ...     found = PhysicalProblem(70e9, 1.0, 0, 0.2, Q=R, n=2, work_of_adhesion=0.05, z0=3e-10)
        ...     return found.problem(), found.scales["load"]
        >>> posed, newtons = sphere(1e-6)
        >>> found = sensitivity(posed, "pull_off_force")
        >>> slope = found.derivative(sphere, 1e-6, 1e-6)
        >>> round(slope * 1e-6 / (found.solution.value * newtons), 4)     # d ln P / d ln R
        0.9772
        """
        step = _STEP * unit
        few = self._new_solid(vary(at + step if at + step < high else at - step)[0])
        places: tuple[float, ...] = _FEW if few else _MANY
        if not low < at + places[0] * step or not at + places[-1] * step < high:
            places = _FEW_ONE_SIDED if few else _MANY_ONE_SIDED
            if not at + places[-1] * step < high:
                places = tuple(-place for place in places)
        weights = difference_rule(places)
        total = weights[-1] * self.solution.value * vary(at)[1]
        for place, weight in zip(places, weights[:-1], strict=True):
            problem, scale = vary(at + place * step)
            total += weight * (self.solution.value + self.change(problem)) * scale
        return float(total / step)

    @property
    def gradient(self) -> dict[str, float]:
        """Derivatives by the numbers of the problem: "mu", of a power law "k", and of a power-law punch "n".

        Examples
        --------
        >>> found = sensitivity(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
        >>> {name: round(slope, 4) for name, slope in found.gradient.items()}
        {'mu': -0.0996, 'k': 0.3184, 'n': -0.8187}
        """
        p = self.problem
        found = {"mu": self.derivative(lambda mu: (replace(p, mu=mu), 1.0), p.mu, p.mu)}
        if p.response is None and p.k < 1.0:
            found["k"] = self.derivative(lambda k: (replace(p, k=k), 1.0), p.k, 1.0, low=0.0, high=1.0)
        if isinstance(p.punch, PowerPunch):
            found["n"] = self.derivative(
                lambda n: (replace(p, n=n, punch=PowerPunch(n)), 1.0), p.n, p.n, low=0.5 * (1.0 - p.k), high=300.0
            )
        return found


@one_thread()
def sensitivity(problem: Problem, quantity: str, accuracy: Accuracy = "default") -> ValueSensitivity:
    """Compute a value at an event and prepare its derivatives: one more linear solution, with the adjoint.

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
