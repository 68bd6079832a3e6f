"""Force-displacement curve of the equilibrium path as arrays."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from fscm._bound.parts import EventErrors
from fscm._path import events
from fscm._path.arc_length import Point, parameter_of
from fscm._path.continuation import beyond_wells
from fscm._path.curve_density import turning_slowly
from fscm._path.whole_path import path_by_any_mesh, path_end
from fscm._presentation import Columns
from fscm._surface.response import largest_mu
from fscm._surface.state import State
from fscm._threads import one_thread
from fscm._typing import Array
from fscm._units import DIMENSIONLESS
from fscm._validation import real_number
from fscm.accuracy import Accuracy, Meshes
from fscm.folds import Fold, edge_radius, fold_at, folds_between
from fscm.problem import Problem, checked_problem
from fscm.punch import check_reach
from fscm.stability import stable_sections

__all__ = ["EquilibriumPath", "trace"]

Mask: TypeAlias = NDArray[np.bool_]

#: Curves are drawn and integrated: shorter steps than on the path that brackets events.
_LONGEST_STEP = 0.15
#: The errors are computed at every _CHECK_EVERY-th point; the largest bounds hold for all, since meshes change little.
_CHECK_EVERY = 12
_MAX_POINTS = 5000
#: Degrees by which a polygon may turn at each point to look like a curve.
_LARGEST_TURN = 5.0


@dataclass(frozen=True, repr=False)
class EquilibriumPath(Columns):
    """The equilibrium path from far separation into contact; all arrays have shape (m,).

    In the units of the problem.  Folds of load and displacement and the zero of the load are among the points.

    Attributes
    ----------
    central_gap, displacement, load, energy : ndarray
        H_0, delta, P, and elastic plus surface energy.
    edge_radius : ndarray
        Radius where the tension is largest; nan while the central gap is above the gap of largest tension.
    u_displacement, u_load : float
        Numerical uncertainty of every delta and P: the largest bound at every twelfth point, as for events; nan if it
        was not computed.
    folds : tuple of Fold
        All turning points of load and displacement, in the order of the path.
    stable_under_displacement, stable_under_load : ndarray of bool
        Whether the state is stable at prescribed displacement, or load; False at the folds where stability ends.  See
        `fscm.stability`.
    is_physical : bool
        Whether it is in the units of a physical problem.

    Examples
    --------
    The work of the load along the path is the change of energy:

    >>> path = trace(Problem(n=2, k=0, mu=0.5))
    >>> work = np.trapezoid(path.load, path.displacement)
    >>> bool(abs(work - (path.energy[-1] - path.energy[0])) < 1e-2)
    True
    """

    _over, _drawn = "displacement", "load"

    central_gap: Array
    displacement: Array
    load: Array
    energy: Array
    edge_radius: Array
    u_displacement: float
    u_load: float
    folds: tuple[Fold, ...] = ()
    stable_under_displacement: Mask = field(default_factory=lambda: np.empty(0, np.bool_))
    stable_under_load: Mask = field(default_factory=lambda: np.empty(0, np.bool_))
    is_physical: bool = False

    def in_units(self, units: Mapping[str, float]) -> EquilibriumPath:
        """The path of a dimensionless problem in the units of a physical one."""
        return replace(
            self,
            central_gap=self.central_gap * units["gap"],
            displacement=self.displacement * units["displacement"],
            load=self.load * units["load"],
            energy=self.energy * units["energy"],
            edge_radius=self.edge_radius * units["radius"],
            u_displacement=self.u_displacement * units["displacement"],
            u_load=self.u_load * units["load"],
            folds=tuple(fold.in_units(units) for fold in self.folds),
            is_physical=units is not DIMENSIONLESS,
        )


@one_thread()
def trace(
    problem: Problem,
    accuracy: Accuracy = "default",
    *,
    max_load: float | None = None,
    start_gap: float | None = None,
    longest_step: float = _LONGEST_STEP,
    largest_turn: float = _LARGEST_TURN,
    with_bounds: bool = True,
    interaction: str | None = None,
) -> EquilibriumPath:
    """Follow the whole equilibrium path.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    accuracy : float or str
        Requested relative error, or its name (see `solve`); `u_displacement` and `u_load` bound the actual error.
    max_load : float, optional
        The path ends in contact at this load, after the deepest pull-off; by default where the compression equals
        the largest tension.  For a punch that is not a power law it goes on until no later state carries tension.
    start_gap : float, optional
        Central gap at the far end; by default (10 + 5 mu) z0, with mu where the solid is softest, and farther out where
        a law has a barrier.
    longest_step : float
        Bound on the step from point to point; 0.05 gives three times the points of the default, for
        interpolation.  In compression beyond the largest tension steps are longer, up to eight times.
    largest_turn : float
        Degrees, above 0: equilibrium states are added until the tangent of load over displacement turns by less from
        point to point, in a square plot of the part with tension; 180 adds none.
    interaction : str, optional
        In place of that of the problem (see `solve`).

    Raises
    ------
    ValueError
        When `max_load` is below the load at pull-off, or `largest_turn` is outside (0, 180].
    NotConverged
        When the path cannot be followed to the end.

    Examples
    --------
    >>> path = trace(Problem(n=2, k=0.4, mu=1.0))
    >>> bool(abs(path.load.min() + 1.788) < 1e-2)
    True
    """
    meshes, problem = Meshes.of(accuracy), checked_problem(problem).under(interaction)
    units, problem = problem.units, problem.dimensionless
    max_load = None if max_load is None else max_load / units["load"]
    start_gap = None if start_gap is None else start_gap / units["gap"]
    largest_turn = real_number(
        "largest_turn", largest_turn, low=0.0, high=180.0, closed_high=True, reason="it is an angle"
    )
    start = 10.0 + 5.0 * largest_mu(problem) + beyond_wells(problem) if start_gap is None else start_gap

    def ending() -> Callable[[State], bool]:
        end, lowest = path_end(problem, meshes.end_height), 0.0

        def ended(state: State) -> bool:
            nonlocal lowest
            lowest = min(lowest, state.load)
            end.load = -lowest if max_load is None else max(max_load, 0.0)
            return end(state)

        return ended

    points = path_by_any_mesh(
        problem, [meshes.curve], ending, "its end", _MAX_POINTS, longest_step, start, meshes.end_height
    )
    states, folds = _with_events(turning_slowly(points, largest_turn))
    shown = folds
    if max_load is not None and max_load <= 0.0:
        states = _up_to(states, max_load)
        shown = [fold for fold in folds if any(fold[0] is state for state in states)]
    check_reach(problem.punch, edge_radius(states[-1]))
    u_displacement, u_load = _largest_errors(states[::_CHECK_EVERY]) if with_bounds else (math.nan, math.nan)
    return EquilibriumPath(
        np.array([s.central_gap for s in states]),
        np.array([s.displacement for s in states]),
        np.array([s.load for s in states]),
        np.array([s.energy for s in states]),
        np.array([edge_radius(s) for s in states]),
        u_displacement,
        u_load,
        tuple(fold_at(*fold) for fold in shown),
        *_stable(points, states, folds),
    ).in_units(units)


def _largest_errors(states: list[State]) -> tuple[float, float]:
    """Largest bounds on the error of displacement and load at a value of the continuation parameter."""
    largest = np.zeros(2)
    for state in states:
        errors = EventErrors(state)
        totals = [errors.on_path(functional).total for functional in ("displacement", "load")]
        largest = np.maximum(largest, totals)
    return float(largest[0]), float(largest[1])


def _stable(points: list[Point], states: list[State], folds: list[tuple[State, str, bool]]) -> tuple[Mask, Mask]:
    """Whether each state is stable under displacement and under load; a fold is so if both of its sections are."""
    sections = stable_sections(points[0], points[-1], [(name, state.displacement) for state, name, _ in folds])
    marks = np.empty((2, len(states)), np.bool_)
    number = 0
    for i, state in enumerate(states):
        before = number
        while number < len(folds) and folds[number][0] is state:
            number += 1
        marks[:, i] = np.logical_and.reduce(sections[before : number + 1])
    return marks[0], marks[1]


def _up_to(states: list[State], load: float) -> list[State]:
    """States up to the first one beyond the deepest pull-off whose load is above a tensile load."""
    lowest = min(range(len(states)), key=lambda i: states[i].load)
    if load < states[lowest].load:
        raise ValueError(
            f"max_load = {load:g} is outside [{states[lowest].load:g}, inf): "
            "the path has no smaller load than the one at pull-off"
        )
    return states[: next(i for i in range(lowest, len(states)) if states[i].load > load) + 1]


def _with_events(points: list[Point]) -> tuple[list[State], list[tuple[State, str, bool]]]:
    """States of the path, each once, with the folds and the zero of the load inserted; and the folds alone."""
    states, folds = [points[0].state], []
    for a, b in pairwise(points):
        if a.segment != b.segment:
            states[-1] = b.state  # the same state on the mesh that follows the edge
            folds += folds_between(a, b)
            continue
        between = folds_between(a, b)
        folds += between
        zeros = events.crossings([a, b], events.zero_load, events.load_fold)
        added = [fold[0] for fold in between] + [events.locate(*bracket, events.zero_load) for bracket in zeros]
        direction = a.state.orientation
        states += sorted(added, key=lambda state: direction * parameter_of(state))
        states.append(b.state)
    return states, folds
