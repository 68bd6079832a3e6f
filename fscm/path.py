"""The force-displacement curve as arrays, and surface profiles at a state: what a user looks at."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fscm import events
from fscm._threads import one_thread
from fscm.analysis import SAFETY, Analysis
from fscm.continuation import Point, equilibrium_path, lead_of
from fscm.equilibrium import State
from fscm.errors import NotConverged
from fscm.events import refined
from fscm.panels import Array
from fscm.problem import Problem

__all__ = ["EquilibriumPath", "SurfaceProfiles", "profiles", "profiles_of", "trace"]

# Mesh and longest step of the curves: they are drawn and integrated, so they carry more digits than the
# coarse path that brackets events.
_ORDER, _TOLERANCE, _LONGEST_STEP = 10, 1e-6, 0.15
# Every so many points the state is solved again on this finer mesh, for the uncertainty.
_CHECK_EVERY, _CHECK_MESH = 12, (14, 1e-8)
_MAX_POINTS = 5000


@dataclass(frozen=True)
class EquilibriumPath:
    """The equilibrium path from far separation into contact; all arrays have shape (m,), dimensionless.

    Folds of load and displacement and the zero of the load are among the points.

    Attributes
    ----------
    central_gap, displacement, load, energy : ndarray
        H_0, delta, P, and elastic plus surface energy (unit pi Q^(2/n) dgamma z0^(2/n)).
    edge_radius : ndarray
        Radius where the tension is largest; nan while the central gap is above the gap of largest tension.
    u_displacement, u_load : float
        Numerical uncertainty of every delta and P.

    Examples
    --------
    The work of the load along the path is the change of energy:

    >>> path = trace(Problem(n=2, k=0, mu=0.5))
    >>> work = np.trapezoid(path.load, path.displacement)
    >>> bool(abs(work - (path.energy[-1] - path.energy[0])) < 1e-2)
    True
    """

    central_gap: Array
    displacement: Array
    load: Array
    energy: Array
    edge_radius: Array
    u_displacement: float
    u_load: float


@dataclass(frozen=True)
class SurfaceProfiles:
    """Gap, pressure and deformation over the radius at one state; arrays of shape (m,), dimensionless.

    Examples
    --------
    Eq. 4, H = -delta + f + w, at the nodes:

    >>> at_zero_load = profiles(Problem(n=2, k=0.4, mu=1.0), "zero_load")
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


@one_thread()
def trace(
    problem: Problem,
    max_load: float | None = None,
    start_gap: float | None = None,
    longest_step: float = _LONGEST_STEP,
) -> EquilibriumPath:
    """Follow the whole equilibrium path.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    max_load : float, optional
        The path ends in contact at this load; by default where the compression equals the largest tension.
    start_gap : float, optional
        Central gap at the far end; by default 10 + 5 mu.
    longest_step : float
        Bound on the step from point to point; 0.05 gives three times the points of the default, for
        interpolation.

    Raises
    ------
    NotConverged
        When the path cannot be followed to the end.

    Examples
    --------
    >>> path = trace(Problem(n=2, k=0.4, mu=1.0))
    >>> bool(abs(path.load.min() + 1.788) < 1e-2)
    True
    """
    points: list[Point] = []
    deepest = 0.0
    start = 10.0 + 5.0 * problem.mu if start_gap is None else start_gap
    for point in equilibrium_path(problem, _ORDER, _TOLERANCE, longest_step, start):
        points.append(point)
        deepest = min(deepest, point.state.load)
        if point.state.follows_edge and point.state.load > (-deepest if max_load is None else max_load):
            break
        if len(points) > _MAX_POINTS:
            raise NotConverged(f"the path of {problem} has not reached its end in {_MAX_POINTS} steps")
    states = _with_events(points)
    checks = [(state, refined(state, *_CHECK_MESH)) for state in states[::_CHECK_EVERY]]
    return EquilibriumPath(
        np.array([s.central_gap for s in states]),
        np.array([s.displacement for s in states]),
        np.array([s.load for s in states]),
        np.array([s.energy for s in states]),
        np.array([s.scale if s.follows_edge else np.nan for s in states]),
        float(SAFETY * max(abs(fine.displacement - s.displacement) for s, fine in checks)),
        float(SAFETY * max(abs(fine.load - s.load) for s, fine in checks)),
    )


def _with_events(points: list[Point]) -> list[State]:
    """States of the path with the folds and the zero of the load put in, each state once."""
    states = [points[0].state]
    for a, b in pairwise(points):
        if a.state.follows_edge != b.state.follows_edge:
            states[-1] = b.state  # the same state on the mesh that follows the edge
            continue
        between = [
            events.locate(a, b, condition)
            for condition in (events.load_fold, events.displacement_fold, events.zero_load)
            if condition(a.state, a.rates) * condition(b.state, b.rates) < 0.0
        ]
        direction = 1.0 if a.state.follows_edge else -1.0
        states += sorted(between, key=lambda state: direction * lead_of(state))
        states.append(b.state)
    return states


def profiles_of(state: State) -> SurfaceProfiles:
    """The surface at a state, at the nodes of its mesh.

    Examples
    --------
    >>> state = Analysis(Problem(n=2, k=0.4, mu=1.0)).event("zero_load").value
    >>> abs(profiles_of(state).load) < 1e-9
    True
    """
    return SurfaceProfiles(state.radius, state.gap, state.pressure, state.deformation, state.displacement, state.load)


@one_thread()
def profiles(problem: Problem, event: str = "pull_off") -> SurfaceProfiles:
    """The surface at an event: "pull_off", "jump_in", "jump_out" or "zero_load".

    Raises
    ------
    NoSuchEvent, NotConverged, ValueError

    Examples
    --------
    >>> at_pull_off = profiles(Problem(n=2, k=0.4, mu=1.0))
    >>> bool(abs(at_pull_off.pressure.min() + 1.0264) < 1e-3)      # the theoretical strength, at the edge
    True
    """
    return profiles_of(Analysis(problem).event(event).value)
