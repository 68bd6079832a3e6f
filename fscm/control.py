"""Equilibrium states at a prescribed central gap, displacement or load: the controls a caller may want."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from fscm import events
from fscm._threads import one_thread
from fscm.analysis import (
    CHECK_MESH,
    COARSE_ORDER,
    COARSE_TOLERANCE,
    FLOOR,
    MAX_POINTS,
    SAFETY,
    VALUE_MESH,
    EventPair,
)
from fscm.continuation import Point, equilibrium_path
from fscm.equilibrium import State
from fscm.errors import NotConverged
from fscm.path import SurfaceProfiles, profiles_of
from fscm.problem import Problem

__all__ = ["EquilibriumState", "equilibria"]

_FUNCTIONALS: dict[str, Callable[[State], float]] = {
    "central_gap": lambda state: state.central_gap,
    "displacement": lambda state: state.displacement,
    "load": lambda state: state.load,
}


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
    profiles: SurfaceProfiles


@one_thread()
def equilibria(problem: Problem, control: str, value: float) -> list[EquilibriumState]:
    """All states of the equilibrium path at a value of one control, from separation into contact.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    control : str
        "central_gap" (one state), "displacement" or "load" (up to three, more near the nucleus of contact).
    value : float
        In z0 for gap and displacement, pi Q^(2/n) dgamma z0^(2/n-1) for the load.

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
    start_gap = 10.0 + 5.0 * problem.mu + (0.0 if control == "load" else 2.0 * abs(value))
    points: list[Point] = []
    for point in equilibrium_path(problem, COARSE_ORDER, COARSE_TOLERANCE, start_gap=start_gap):
        points.append(point)
        state = point.state
        past = condition(state, None) * (-1.0 if control == "central_gap" else 1.0) > 0.0
        if state.follows_edge and state.load > 0.0 and past:
            break
        if len(points) > MAX_POINTS:
            raise NotConverged(f"{control} = {value} was not reached in {MAX_POINTS} steps along the path")
    found = [bracket for rising in (True, False) for bracket in events.brackets(points, condition, rising)]
    found.sort(key=lambda bracket: next(i for i, p in enumerate(points) if p is bracket[0]))
    return [_solved(bracket, condition) for bracket in found]


def _solved(bracket: events.Bracket, condition: events.Condition) -> EquilibriumState:
    coarse = events.locate(*bracket, condition)
    pair = EventPair(*(events.sharpen(coarse, condition, *mesh) for mesh in (CHECK_MESH, VALUE_MESH)))
    state = pair.value
    spread = pair.spread(*_FUNCTIONALS.values())
    scale = 1.0 + max(abs(f(state)) for f in _FUNCTIONALS.values())
    return EquilibriumState(
        float(state.central_gap),
        float(state.displacement),
        float(state.load),
        float(SAFETY * spread + FLOOR * scale + state.tail_uncertainty),
        profiles_of(state),
    )
