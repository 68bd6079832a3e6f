r"""Change of a value at an event with the parameters of the problem, by the adjoint of the equilibrium.

The discrete equilibrium with a control is F(y, p) = 0, and J(y, p) is a value at its solution.  With B = dF/dy and
B^T a = dJ/dy,

    dJ/dp = J_p - a . F_p,

where J_p and F_p are taken at the fixed state y: one more linear solution serves every parameter, and F_p needs no
equilibrium.  At its own extreme a value does not change along the path, so that any control will do.  Another value
also changes with the location s of the extreme, by J_s ds = -J_s d(L_s)/L_ss with the extremal functional L.
"""

from __future__ import annotations

import math

import numpy as np

from fscm._path.arc_length import parameter_of, rates_of
from fscm._path.continuation import moved
from fscm._surface.discretisation import Discretisation
from fscm._surface.linearisation import Linearisation, linearised
from fscm._surface.state import Control, State
from fscm._typing import Array
from fscm.errors import Failure, NotConverged
from fscm.problem import Problem
from fscm.punch import kinks_of

__all__ = ["WITH_GRADIENT", "Adjoint", "AtExtreme", "parameter"]

#: Functionals whose derivatives by the unknowns are known.
WITH_GRADIENT = ("load", "displacement", "central_gap")

#: Step of the continuation parameter for the rate of a change, relative to its unit; both states are exact to 1e-13.
_PATH_STEP = 1e-4


class Adjoint:
    """Change of a functional at a fixed value of a control, to first order, when the problem changes.

    Parameters
    ----------
    state : State
        In equilibrium.
    functional, control : str
        Of `WITH_GRADIENT`; the control may also be "log_scale".
    """

    def __init__(self, state: State, functional: str, control: str) -> None:
        self._state, self._functional, self._control = state, functional, control
        system = linearised(state)
        matrix = system.bordered(system.row(_unit(control))).matrix()
        try:
            self._adjoint = np.asarray(np.linalg.solve(matrix.T, system.row(_unit(functional))), float)
        except np.linalg.LinAlgError as error:
            singular = "the tangent at the event is singular: its adjoint is not known"
            raise NotConverged(singular, Failure.EVENT) from error
        self._value, self._left = getattr(state, functional), self._left_sides(state, system)

    def _left_sides(self, state: State, system: Linearisation) -> Array:
        control = math.log(state.scale) if self._control == "log_scale" else getattr(state, self._control)
        return np.concatenate([system.residual, [system.anchor, control]])

    def change(self, problem: Problem) -> float:
        """The change from the problem of the state to another one, on the same mesh."""
        disc = self._state.disc
        state = _at_fixed_unknowns(self._state, Discretisation(problem, disc.mesh, disc))
        left = self._left_sides(state, linearised(state))
        return float(getattr(state, self._functional) - self._value - self._adjoint @ (left - self._left))


def _unit(name: str) -> Control:
    return Control(0.0, **{"gap" if name == "central_gap" else name: 1.0})


def _at_fixed_unknowns(state: State, disc: Discretisation) -> State:
    """The state with the same unknowns; with kinks the scale changes, because the breaks of the mesh follow them.

    To first order a change does not depend on the unknowns at which the equations of the other problem are evaluated.
    """
    old_kinks, new_kinks = kinks_of(state.disc.problem.punch), kinks_of(disc.problem.punch)
    scale = state.scale * new_kinks[0] / old_kinks[0] if old_kinks and len(new_kinks) == len(old_kinks) else state.scale
    return state.of_problem(disc, scale)


class AtExtreme:
    """Change of a functional at the extreme of another one, to first order, with the shift of the extreme.

    Parameters
    ----------
    state : State
        At the extreme.
    functional, extremal : str
        As for `Adjoint`; the functional is another one.
    """

    def __init__(self, state: State, functional: str, extremal: str) -> None:
        control, unit = parameter(state)
        rates, step = rates_of(state), _PATH_STEP * unit
        neighbours = [moved(state, rates, parameter_of(state) + side * step) for side in (-1.0, 1.0)]
        before, after = (getattr(rates_of(neighbour), extremal) for neighbour in neighbours)
        # s shifts by -d(L_s)/L_ss; both derivatives by s are differences over the same steps.
        self._factor = -getattr(rates, functional) / (after - before)
        self._adjoint = Adjoint(state, functional, control)
        self._adjoints_beside = [Adjoint(neighbour, extremal, control) for neighbour in neighbours]

    def change(self, problem: Problem) -> float:
        """The change from the problem of the state to another one."""
        before, after = (adjoint.change(problem) for adjoint in self._adjoints_beside)
        return self._adjoint.change(problem) + self._factor * (after - before)


def parameter(state: State) -> tuple[str, float]:
    """Functional that is the continuation parameter of a state, and its unit."""
    if state.parameter == "gap":
        return "central_gap", state.central_gap - state.disc.problem.law.singular_gap
    return state.parameter, 1.0 if state.parameter == "log_scale" else 1.0 + abs(parameter_of(state))
