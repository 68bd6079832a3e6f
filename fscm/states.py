"""Equilibrium states at an event, or at a prescribed central gap, displacement or load."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

from fscm._bound.parts import EventErrors
from fscm._path import events
from fscm._path.arc_length import Point, parameter_of, rates_of
from fscm._path.continuation import beyond_wells
from fscm._path.whole_path import path_by_any_mesh, path_end
from fscm._presentation import Columns
from fscm._surface.state import State
from fscm._threads import one_thread
from fscm._typing import Array
from fscm._units import DIMENSIONLESS
from fscm.accuracy import Accuracy, Meshes
from fscm.analysis import Analysis
from fscm.folds import edge_radius
from fscm.problem import Problem, checked_problem
from fscm.punch import check_reach
from fscm.solution import Parts
from fscm.stability import Stability, stability_of

__all__ = ["EquilibriumState", "RadialField", "equilibria", "profile", "radial_field"]

_FUNCTIONALS: dict[str, Callable[[State], float]] = {
    "central_gap": lambda state: state.central_gap,
    "displacement": lambda state: state.displacement,
    "load": lambda state: state.load,
}
_KINDS = {"central_gap": "gap", "displacement": "displacement", "load": "load"}
#: Conditions that are zero where the control is extreme along the path.
_FOLDS: dict[str, events.Condition] = {
    "central_gap": lambda state, rates: rates.central_gap,
    "displacement": events.displacement_fold,
    "load": events.load_fold,
}
#: An extreme this close to the value, relative to 1 + |value|, is first solved on the value mesh.
_NEAR = 1e-2
#: Step of the continuation parameter for the curvature at an extreme.
_SPACING = 1e-4


@dataclass(frozen=True, repr=False)
class RadialField(Columns):
    """Gap, pressure and deformation over the radius at one state; arrays of shape (m,), in the units of the problem.

    Examples
    --------
    Eq. 4, H = -delta + f + w, at the nodes:

    >>> import numpy as np
    >>> at_zero_load = profile(Problem(n=2, k=0.4, mu=1.0), "zero_load")
    >>> undeformed = at_zero_load.radius**2 / 2 - at_zero_load.displacement
    >>> bool(np.allclose(at_zero_load.gap, undeformed + at_zero_load.deformation))
    True
    """

    _over, _drawn, _least_share = "radius", "pressure", 1e-3

    radius: Array
    gap: Array
    pressure: Array
    deformation: Array
    displacement: float
    load: float
    is_physical: bool = False

    def in_units(self, units: Mapping[str, float]) -> RadialField:
        """The surface of a dimensionless problem in the units of a physical one."""
        return RadialField(
            self.radius * units["radius"],
            self.gap * units["gap"],
            self.pressure * units["traction"],
            self.deformation * units["displacement"],
            self.displacement * units["displacement"],
            self.load * units["load"],
            units is not DIMENSIONLESS,
        )


@dataclass(frozen=True)
class EquilibriumState:
    """One equilibrium state, in the units of the problem.

    Attributes
    ----------
    central_gap, displacement, load : float
    u_num : float
        Bound on the error of each of the three numbers, dimensionless: in z0, and in the unit of loads.
    profile : RadialField
    parts : mapping
        Bounds on the error of each of the three, by name and cause: ``parts["load"]["mesh"]``.  The bound of the
        control is the error of its prescribed value.

    Only stable states are observed in an experiment.

    Examples
    --------
    >>> (state,) = equilibria(Problem(n=2, k=0.4, mu=1.0), "central_gap", 0.5)
    >>> abs(state.central_gap - 0.5) <= state.u_num < 1e-9
    True
    >>> (in_contact,) = equilibria(Problem(n=2, k=0.4, mu=1.0), "load", 1.0)
    >>> round(in_contact.edge_radius, 4)
    2.7164
    >>> state.stable_under_displacement, state.stable_under_load      # after the jump-in, before pull-off
    (False, False)
    """

    central_gap: float
    displacement: float
    load: float
    u_num: float
    profile: RadialField
    parts: Mapping[str, Parts]
    _state: State = field(repr=False, compare=False)
    _units: Mapping[str, float] = field(repr=False, compare=False)

    @property
    def edge_radius(self) -> float:
        """Radius of the largest tension, in contact that of its edge; nan before contact."""
        return float(edge_radius(self._state)) * self._units["radius"]

    @cached_property
    @one_thread()
    def stability(self) -> Stability:
        """Stability, computed on demand."""
        stability = stability_of(self._state)
        return replace(stability, stiffness=stability.stiffness * self._units["stiffness"])

    @property
    def stable_under_displacement(self) -> bool:
        """Whether the state is stable at prescribed displacement; the punch cannot tilt or shift."""
        return self.stability.under_displacement

    @property
    def stable_under_load(self) -> bool:
        """Whether the state is stable at prescribed load; the punch can move along its axis only."""
        return self.stability.under_load


@one_thread()
def equilibria(problem: Problem, control: str, value: float, accuracy: Accuracy = "default") -> list[EquilibriumState]:
    """All states of the equilibrium path at a value of one control, from separation into contact.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    control : str
        "central_gap" (one state), "displacement" or "load" (up to three, more at contact initiation).
    value : float
        In the units of the problem.
    accuracy : float or str
        Requested relative error, or its name (see `solve`).

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
    problem = checked_problem(problem)
    if control not in _FUNCTIONALS:
        raise ValueError(f"control {control!r} is unknown; it is one of {', '.join(_FUNCTIONALS)}")
    if not math.isfinite(value):
        raise ValueError(f"value = {value} of the {control} is not finite")
    if control == "central_gap" and value <= problem.law.singular_gap:
        raise ValueError(f"central gap = {value} is not above {problem.law.singular_gap}, where the law is singular")
    units, problem = problem.units, problem.dimensionless
    value = value / units[_KINDS[control]]
    functional = _FUNCTIONALS[control]

    def condition(state: State, rates: object) -> float:
        return functional(state) - value

    # Rising along the path: displacement and, in contact, load; the central gap falls.
    direction = -1.0 if control == "central_gap" else 1.0
    meshes = Meshes.of(accuracy)

    def ending() -> Callable[[State], bool]:
        complete = path_end(problem, meshes.end_height)
        return lambda state: complete(state) and direction * condition(state, None) > 0.0

    start_gap = 10.0 + 5.0 * problem.mu + beyond_wells(problem) + (0.0 if control == "load" else 2.0 * abs(value))
    end = f"the {control} {value:g}"
    points = path_by_any_mesh(problem, [meshes.path], ending, end, start_gap=start_gap, end_height=meshes.end_height)
    fold = _FOLDS[control]
    states: list[EquilibriumState] = []
    for a, b in pairwise(points):
        if a.segment != b.segment:
            continue
        coarse_states = _near_extreme(a, b, condition, fold, meshes)
        if coarse_states is None:
            coarse_states = [
                events.locate(*bracket, condition) for bracket in events.crossings([a, b], condition, fold)
            ]
        states += [_solved(coarse, control, value, condition, meshes, units) for coarse in coarse_states]
    return states


def _near_extreme(
    a: Point, b: Point, condition: events.Condition, fold: events.Condition, meshes: Meshes
) -> list[State] | None:
    """States next to an extreme that is too close to the value for the coarse path to decide; else None."""
    before, after = fold(a.state, a.rates), fold(b.state, b.rates)
    ends = condition(a.state, a.rates), condition(b.state, b.rates)
    if before * after >= 0.0 or ends[0] * ends[1] < 0.0 or before * ends[0] > 0.0:
        return None
    coarse = events.locate(a, b, fold)
    missing = condition(coarse, rates_of(coarse))
    if abs(missing) > _NEAR * (1.0 + max(abs(x) for x in ends)):
        return None
    extreme = events.root_near(coarse, fold, *meshes.value)
    rates = rates_of(extreme)
    missing = condition(extreme, rates)
    if (missing < 0.0) == (ends[0] < 0.0) and missing != 0.0:
        return []
    # A parabola: the condition is `missing` at its vertex and 0 at the distance of the two states.
    x = parameter_of(extreme)
    beside = events.moved(extreme, rates, x + _SPACING)
    curvature = fold(beside, rates_of(beside)) / _SPACING
    distance = math.sqrt(2.0 * abs(missing / curvature))
    if distance < _SPACING**2:
        return [extreme]
    along = extreme.orientation
    return [events.moved(extreme, rates, x + side * along * distance) for side in (-1.0, 1.0)]


def _solved(
    coarse: State, control: str, value: float, condition: events.Condition, meshes: Meshes, units: Mapping[str, float]
) -> EquilibriumState:
    state = events.root_near(coarse, condition, *meshes.value)
    check_reach(state.disc.problem.punch, edge_radius(state))
    errors = EventErrors(state)
    parts = {name: errors.prescribed(name, control, value) for name in _FUNCTIONALS}
    values = {name: float(of_state(state)) * units[_KINDS[name]] for name, of_state in _FUNCTIONALS.items()}
    return EquilibriumState(
        **values,
        u_num=max(bounds.total for bounds in parts.values()),
        profile=radial_field(state).in_units(units),
        parts={name: bounds.times(units[_KINDS[name]]) for name, bounds in parts.items()},
        _state=state,
        _units=units,
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
        Requested relative error, or its name (see `solve`).

    Raises
    ------
    NoSuchEvent, NotConverged, ValueError

    Examples
    --------
    >>> at_pull_off = profile(Problem(n=2, k=0.4, mu=1.0))
    >>> bool(abs(at_pull_off.pressure.min() + 1.0264) < 1e-3)      # the theoretical strength, at the edge
    True
    """
    problem = checked_problem(problem)
    return radial_field(Analysis(problem.dimensionless, accuracy).event(event).value).in_units(problem.units)
