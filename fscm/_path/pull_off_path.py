r"""Short section of the path of a power-law punch that contains the least load, for a pull-off force alone.

It begins at a central gap above which no state carries as much tension, and ends on the contact branch beyond the
minimum of the load.  Before contact the tension decreases outwards and lifts the surface most at the center, so that
H(r) >= f(r) + H_0.  With the largest tension t(H) at any gap of at least H,

    -P <= int_0^oo t(f + H_0) 2 r dr,

the load of the rigid solid, which decreases with H_0.  As for any path, states before contact are assumed to be
determined by their central gap, and the load to have one minimum once the center is compressed (see `fscm._path.ends`).
"""

from __future__ import annotations

import numpy as np

from fscm._path.arc_length import Point, rates_of
from fscm._path.completeness import completed, least_loads
from fscm._path.continuation import usual_start
from fscm._path.events import Bracket, brackets, load_fold, locate, root_near, with_minima
from fscm._path.punch_rules import Tracking
from fscm._path.whole_path import path_until
from fscm._surface.discretisation import STEEP
from fscm._surface.state import State
from fscm._typing import Array
from fscm.accuracy import Meshes
from fscm.errors import Failure, NoSuchEvent, NotConverged
from fscm.laws import LennardJones, Mie
from fscm.problem import Problem
from fscm.punch import PowerPunch

__all__ = ["deepest_minimum", "pull_off_path", "rigid_tension", "without_tension"]

#: Heights of the punch at which the tension is evaluated: least, largest, number.
_LOWEST, _HIGHEST, _HEIGHTS = 1e-4, 1e6, 500
#: Share of the tension of the rigid solid in contact above which the pull-off is expected: up to n = 2 it is at least
#: the (3 + k)/4 of JKR, for flatter punches on soft solids less.  If it is below, the whole path is followed.
_SHARE, _SHARE_OF_FLAT = 0.6, 0.3
#: Minima of the load that differ by less than this, relative to 1 + |P|, are compared on the value mesh.
_CLOSE = 1e-2
#: Newton's method starts from the rigid solid where the deformation is at most this multiple of the gap's distance to
#: the singular gap.  Measured over 440 states: it never fails below 1, and in 8 of 35 between 2 and 5.
_NEAR = 1.0
#: Ratio of successive central gaps in the search.
_RATIO = 1.2
#: Height at which the mesh ends: the error of the closed tail beyond, 1e-6 of the tail, does not affect a bracket.
_END = 1e3
#: A step is rejected only if the tangent turns by more than 60 degrees, because `completed` finds folds between points.
#: The last step of Newton's method is below 1e-3 of the gaps, the remaining error about its square.
_TRACKING = Tracking(newton=1e-3, largest_turn=0.5, prescribed=True)


def _rises(state: State) -> bool:
    """Whether the center is compressed and the load rises along the path, beyond its minimum."""
    if not state.anchor.in_contact or float(state.disc.problem.law.traction(np.array(state.central_gap))) <= 0.0:
        return False
    return state.orientation * rates_of(state).load > 0.0


class _RigidSolid:
    """Load and deformation by the tension on a rigid solid."""

    def __init__(self, problem: Problem) -> None:
        n, law = problem.n, problem.law
        self._law, self._compliance = law, problem.compliance
        self._heights = np.concatenate([[0.0], np.geomspace(_LOWEST, _HIGHEST, _HEIGHTS)])
        r = (n * self._heights) ** (1.0 / n)
        self._areas, self._lengths = np.diff(r * r), np.diff(r ** (1.0 - problem.k))
        C, m = law.decay
        self._behind = 2.0 * C * _HIGHEST**-m * float(r[-1]) ** 2 / (m * n - 2.0)

    def _tension(self, central_gap: float) -> Array:
        """The largest tension beyond each radius but the last."""
        gap = np.maximum(self._heights[:-1] + central_gap, self._law.peak_gap)
        return -self._law.traction(gap)

    def load(self, central_gap: float) -> float:
        """Upper bound of -P of all states before contact with at least this central gap."""
        return float(self._tension(central_gap) @ self._areas) + self._behind

    def lift(self, central_gap: float) -> float:
        """Approximate deformation at the center by the tension."""
        return self._compliance * float(self._tension(central_gap) @ self._lengths)


def rigid_tension(problem: Problem, central_gap: float) -> float:
    """Upper bound of -P of all states before contact with at least this central gap.

    Examples
    --------
    >>> problem = Problem(n=2, k=0.4, mu=1.0)
    >>> 0.6 < rigid_tension(problem, 1.0) < 0.7  # 2 (1/3) (4 / 2^2 - 1 / 2^8) = 0.664
    True
    """
    return _RigidSolid(problem).load(central_gap)


def _start(problem: Problem) -> float | None:
    """Central gap of the initial state; None if the whole path begins at a smaller one."""
    gap, singular, rigid = problem.law.peak_gap, problem.law.singular_gap, _RigidSolid(problem)
    stiff = rigid.lift(gap) < _NEAR * (gap - singular)
    enough = (_SHARE if problem.n <= 2.0 or stiff else _SHARE_OF_FLAT) * rigid.load(0.0)
    while rigid.load(gap) > enough or rigid.lift(gap) > _NEAR * (gap - singular):
        gap *= _RATIO
        if gap > usual_start(problem):  # near n = 2/3 the tail alone carries more
            return None
    return gap


def pull_off_path(problem: Problem, meshes: Meshes) -> list[Point] | None:
    """Points of the short path with the minimum of the load; turning points may be missed between them.

    Returns
    -------
    list of Point, or None
        None if the whole path is needed: for any other punch, a layered solid or a tabulated law, for which the load
        may have several minima, and if the tension does not exceed that of the rigid solid farther out.
    """
    if not isinstance(problem.punch, PowerPunch) or problem.graded is not None:
        return None
    if problem.interaction != "derjaguin":  # the load of the rigid solid bounds that of vertical gaps
        return None
    if not isinstance(problem.law, LennardJones | Mie) or problem.law.decay[1] * problem.n <= 2.0:
        return None
    start = _start(problem)
    if start is None:
        return None
    try:
        points = path_until(
            problem,
            *meshes.path,
            _rises,
            "a load minimum",
            start_gap=start,
            end_height=meshes.end_height if problem.punch.growth > STEEP else min(_END, meshes.end_height),
            tracking=_TRACKING,
        )
    except NotConverged:
        return None
    points = with_minima(points)
    least = min(point.state.load for point in points)
    minima = brackets(points, load_fold, rising=True)
    return points if minima and -least > rigid_tension(problem, start) else None


def without_tension(problem: Problem) -> str:
    """Sentence for a law whose barrier presses the surfaces apart along the whole path."""
    return f"no state on the path of {problem} carries tension, so that no force pulls the surfaces apart"


def deepest_minimum(points: list[Point], meshes: Meshes) -> Bracket:
    """Neighbouring points of a path between which the load has its deepest minimum.

    Raises
    ------
    NoSuchEvent
        When the load has no minimum on a path without tension.
    NotConverged
        When it has none on another path.
    """
    # A minimum above the load of some point is not of interest.
    below = min(point.state.load for point in points)
    below += _CLOSE * (1.0 + abs(below))
    points = completed(points, meshes.path.tolerance, below, ("load",))
    minima = [pair for pair in brackets(points, load_fold, rising=True) if least_loads(*pair) < below]
    if not minima:
        if min(point.state.load for point in points) >= 0.0:
            raise NoSuchEvent(without_tension(points[0].state.disc.problem))
        raise NotConverged(
            f"no minimum of the load was found on the path of {points[0].state.disc.problem}", Failure.FOLDS
        )
    if len(minima) == 1:
        return minima[0]
    located = [(locate(*pair, load_fold), pair) for pair in minima]
    least = min(state.load for state, _ in located)
    close = [(state, pair) for state, pair in located if state.load - least < _CLOSE * (1.0 + abs(least))]
    if len(close) > 1:  # the coarse path does not decide which of them is the deepest
        value = *meshes.value, meshes.end_height
        close = [(root_near(state, load_fold, *value), pair) for state, pair in close]
    return min(close, key=lambda candidate: candidate[0].load)[1]
