"""Force-displacement curve of the equilibrium path as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fscm import _events as events
from fscm._arc_length import Point, parameter_of
from fscm._continuation import path_until
from fscm._equilibrium import State
from fscm._events import refined
from fscm._meshes import Accuracy, Meshes
from fscm._threads import one_thread
from fscm._typing import Array
from fscm.problem import Problem
from fscm.solution import SAFETY

__all__ = ["EquilibriumPath", "trace"]

# Curves are drawn and integrated: their points are closer than those of the path that brackets events.
_LONGEST_STEP = 0.15
# Every so many points the state is solved again on a finer mesh, for the uncertainty.
_CHECK_EVERY = 12
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


@one_thread()
def trace(
    problem: Problem,
    accuracy: Accuracy = "default",
    *,
    max_load: float | None = None,
    start_gap: float | None = None,
    longest_step: float = _LONGEST_STEP,
) -> EquilibriumPath:
    """Follow the whole equilibrium path.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    accuracy : float or str
        Relative error that is requested, or its name (see `solve`); `u_displacement` and `u_load` bound the error
        that was reached.
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
    meshes = Meshes.of(accuracy)
    start = 10.0 + 5.0 * problem.mu if start_gap is None else start_gap
    lowest = 0.0

    def ended(state: State) -> bool:
        nonlocal lowest
        lowest = min(lowest, state.load)
        return state.follows_edge and state.load > (-lowest if max_load is None else max_load)

    points = path_until(problem, *meshes.curve, ended, "its end", _MAX_POINTS, longest_step, start, meshes.end_height)
    states = _with_events(points)
    checks = [(state, refined(state, *meshes.curve_check)) for state in states[::_CHECK_EVERY]]
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
        states += sorted(between, key=lambda state: direction * parameter_of(state))
        states.append(b.state)
    return states
