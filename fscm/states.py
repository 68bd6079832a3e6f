"""Equilibrium states at an event, or at a prescribed central gap, displacement or load."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from fscm import _events as events
from fscm._continuation import path_until
from fscm._equilibrium import State
from fscm._meshes import Accuracy, Meshes
from fscm._threads import one_thread
from fscm._typing import Array
from fscm.analysis import Analysis
from fscm.problem import Problem
from fscm.solution import FLOOR, SAFETY, EventPair

__all__ = ["EquilibriumState", "RadialField", "equilibria", "profile", "radial_field"]

_FUNCTIONALS: dict[str, Callable[[State], float]] = {
    "central_gap": lambda state: state.central_gap,
    "displacement": lambda state: state.displacement,
    "load": lambda state: state.load,
}


@dataclass(frozen=True)
class RadialField:
    """Gap, pressure and deformation over the radius at one state; arrays of shape (m,), dimensionless.

    Examples
    --------
    Eq. 4, H = -delta + f + w, at the nodes:

    >>> import numpy as np
    >>> at_zero_load = profile(Problem(n=2, k=0.4, mu=1.0), "zero_load")
    >>> undeformed = at_zero_load.radius**2 / 2 - at_zero_load.displacement
    >>> bool(np.allclose(at_zero_load.gap, undeformed + at_zero_load.deformation))
    True
    """

    radius: Array
    gap: Array
    pressure: Array
    deformation: Array
    displacement: float
    load: float


@dataclass(frozen=True)
class EquilibriumState:
    """One equilibrium state, dimensionless; `u_num` bounds the error of each of the three numbers.

    Examples
    --------
    >>> (state,) = equilibria(Problem(n=2, k=0.4, mu=1.0), "central_gap", 0.5)
    >>> abs(state.central_gap - 0.5) <= state.u_num < 1e-9
    True
    """

    central_gap: float
    displacement: float
    load: float
    u_num: float
    profile: RadialField


@one_thread()
def equilibria(problem: Problem, control: str, value: float, accuracy: Accuracy = "default") -> list[EquilibriumState]:
    """All states of the equilibrium path at a value of one control, from separation into contact.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    control : str
        "central_gap" (one state), "displacement" or "load" (up to three, more near the nucleus of contact).
    value : float
        In z0 for gap and displacement, pi Q^(2/n) dgamma z0^(2/n-1) for the load.
    accuracy : float or str
        Relative error that is requested, or its name (see `solve`).

    Returns
    -------
    list of EquilibriumState
        Empty when the path never has this value.

    Raises
    ------
    ValueError
        For an unknown control, a value that is not finite, or a central gap at or below the singular gap.
    NotConverged

    Examples
    --------
    >>> [round(state.load, 6) for state in equilibria(Problem(n=2, k=0.4, mu=1.0), "displacement", 0.0)]
    [-1.729635]
    """
    if control not in _FUNCTIONALS:
        raise ValueError(f"control {control!r} is unknown; it is one of {', '.join(_FUNCTIONALS)}")
    if not math.isfinite(value):
        raise ValueError(f"value = {value} of the {control} is not finite")
    if control == "central_gap" and value <= problem.law.singular_gap:
        raise ValueError(f"central gap = {value} is not above {problem.law.singular_gap}, where the law is singular")
    functional = _FUNCTIONALS[control]

    def condition(state: State, rates: object) -> float:
        return functional(state) - value

    # Rising along the path: displacement and, in contact, load; the central gap falls.
    direction = -1.0 if control == "central_gap" else 1.0

    def ended(state: State) -> bool:
        return state.follows_edge and state.load > 0.0 and direction * condition(state, None) > 0.0

    meshes = Meshes.of(accuracy)
    start_gap = 10.0 + 5.0 * problem.mu + (0.0 if control == "load" else 2.0 * abs(value))
    end = f"the {control} {value:g}"
    points = path_until(problem, *meshes.path, ended, end, start_gap=start_gap, end_height=meshes.end_height)
    found = [bracket for rising in (True, False) for bracket in events.brackets(points, condition, rising)]
    found.sort(key=lambda bracket: next(i for i, p in enumerate(points) if p is bracket[0]))
    return [_solved(bracket, condition, meshes) for bracket in found]


def _solved(bracket: events.Bracket, condition: events.Condition, meshes: Meshes) -> EquilibriumState:
    coarse = events.locate(*bracket, condition)
    pair = EventPair(*(events.sharpen(coarse, condition, *mesh) for mesh in (meshes.check, meshes.value)))
    state = pair.value
    difference = pair.difference(*_FUNCTIONALS.values())
    scale = 1.0 + max(abs(f(state)) for f in _FUNCTIONALS.values())
    return EquilibriumState(
        float(state.central_gap),
        float(state.displacement),
        float(state.load),
        float(SAFETY * difference + FLOOR * scale + state.tail_uncertainty),
        radial_field(state),
    )


def radial_field(state: State) -> RadialField:
    """The surface at a state, at the nodes of its mesh."""
    return RadialField(state.radius, state.gap, state.pressure, state.deformation, state.displacement, state.load)


@one_thread()
def profile(problem: Problem, event: str = "pull_off", accuracy: Accuracy = "default") -> RadialField:
    """The surface at one of `EVENTS`.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    event : str
    accuracy : float or str
        Relative error that is requested, or its name (see `solve`).

    Raises
    ------
    NoSuchEvent, NotConverged, ValueError

    Examples
    --------
    >>> at_pull_off = profile(Problem(n=2, k=0.4, mu=1.0))
    >>> bool(abs(at_pull_off.pressure.min() + 1.0264) < 1e-3)      # the theoretical strength, at the edge
    True
    """
    return radial_field(Analysis(problem, accuracy).event(event).value)
