"""Everything that can be asked of one problem: its path, its events, and values with their uncertainty.

Each event is computed on two meshes, the second of higher order and refined to a smaller tolerance.  The
value comes from the second, and the uncertainty is the difference of the two with a safety factor, plus a
floor for what the two meshes share (rounding, tail).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from fscm import events
from fscm._threads import one_thread
from fscm.continuation import Point, equilibrium_path
from fscm.equilibrium import State
from fscm.errors import NoSuchEvent, NotConverged
from fscm.events import Bracket, Condition
from fscm.problem import Problem

__all__ = ["EVENT_QUANTITIES", "Analysis", "EventPair", "Solution"]

# The coarse path that brackets events: its digits are not used.
COARSE_ORDER, COARSE_TOLERANCE = 10, 1e-4
# The two meshes (order, tolerance) of a value and its check; close enough to each other that their difference
# is not much larger than the error of the better one.
CHECK_MESH = (10, 3e-7)
VALUE_MESH = (12, 1e-7)
# The difference of the two results estimates the error of the coarser; the factor covers accidental
# agreement.
SAFETY = 3.0
# Rounding and quadrature, which the two meshes share: measured worst 1.3e-13 of the pull-off force (n = 3.4,
# k = 0, mu = 0.04) against meshes of order 18 over 45 random problems.
FLOOR = 2e-13
# Measured: at most 80 points for k up to 0.8, but 790 and 1060 at n = 2, k = 0.9, mu = 1 and 2, where the nucleus
# of contact grows in small steps.  Each keeps its matrices: 2 MB on such meshes.
MAX_POINTS = 1500


@dataclass(frozen=True)
class Solution:
    """A number with its numerical uncertainty.

    Attributes
    ----------
    value, u_num : float
        Dimensionless, in the scales of `fscm.problem`.
    size : int
        Unknowns of the finest mesh.
    iterations : int
        Newton iterations on the two meshes.
    residual : float
        Largest residual relative to 1 + |H| before the last Newton step.
    seconds : float

    Examples
    --------
    >>> answer = Analysis(Problem(n=2, k=0, mu=1.0)).solution("pull_off_force")
    >>> answer.u_num < 1e-10, answer.residual < 1e-12
    (True, True)
    """

    value: float
    u_num: float
    size: int
    iterations: int
    residual: float
    seconds: float


@dataclass(frozen=True)
class EventPair:
    """An event on the check mesh and on the value mesh.

    Examples
    --------
    >>> pair = Analysis(Problem(n=2, k=0.4, mu=1.0)).event("pull_off")
    >>> pair.spread(lambda state: state.load) < 1e-9
    True
    """

    check: State
    value: State

    def spread(self, *functionals: Callable[[State], float]) -> float:
        """Largest difference between the two meshes."""
        return max(abs(f(self.value) - f(self.check)) for f in functionals)


def _load(state: State) -> float:
    return state.load


def _displacement(state: State) -> float:
    return state.displacement


def _central_gap(state: State) -> float:
    return state.central_gap


class Analysis:
    """The full self-consistent model of one problem, computed as far as it is asked.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.

    Raises
    ------
    ValueError
        For k = 1, which is `fscm.gibson`.

    Examples
    --------
    >>> model = Analysis(Problem(n=2, k=0.4, mu=1.0))
    >>> round(model.solution("pull_off_force").value, 8)
    1.78848171
    """

    def __init__(self, problem: Problem) -> None:
        if problem.k >= 1.0:
            raise ValueError("gradient exponent k = 1 is the Gibson solid, whose model is fscm.gibson")
        self.problem = problem
        self._pairs: dict[str, EventPair] = {}

    @cached_property
    @one_thread()
    def points(self) -> list[Point]:
        """The coarse path from far separation to a compressive load."""
        points = []
        for point in equilibrium_path(self.problem, COARSE_ORDER, COARSE_TOLERANCE):
            points.append(point)
            if point.state.follows_edge and point.state.load > 0.0:
                return points
            if len(points) > MAX_POINTS:
                break
        raise NotConverged(f"the path of {self.problem} has not reached a compressive load in {MAX_POINTS} steps")

    @cached_property
    def _folds(self) -> tuple[Bracket, Bracket]:
        """Brackets of the first fold met on approach and of the first met on retreat."""
        approach = events.brackets(self.points, events.displacement_fold, rising=False)
        if approach:
            return approach[0], events.brackets(self.points, events.displacement_fold, rising=True)[-1]
        # The two folds may hide between neighbouring points: look where the displacement is slowest.
        before, at, after, rate = events.slowest(self.points)
        if rate < 0.0:
            return (before, at), (at, after)
        raise NoSuchEvent(
            f"the displacement rises monotonically along the path at mu = {self.problem.mu}: there is no "
            "jump below the critical Tabor number"
        )

    def _bracket(self, name: str) -> tuple[Bracket, Condition]:
        if name == "pull_off":
            minima = events.brackets(self.points, events.load_fold, rising=True)
            if not minima:
                raise NotConverged(f"no minimum of the load was found on the path of {self.problem}")
            return min(minima, key=lambda pair: min(p.state.load for p in pair)), events.load_fold
        if name == "zero_load":
            return events.brackets(self.points, events.zero_load, rising=True)[-1], events.zero_load
        if name == "jump_in":
            return self._folds[0], events.displacement_fold
        if name == "jump_out":
            return self._folds[1], events.displacement_fold
        raise ValueError(f"unknown event {name!r}; known are pull_off, zero_load, jump_in, jump_out")

    @one_thread()
    def event(self, name: str) -> EventPair:
        """One of "pull_off", "jump_in", "jump_out", "zero_load", on two meshes.

        Parameters
        ----------
        name : str

        Returns
        -------
        EventPair

        Raises
        ------
        NoSuchEvent
            When the path has no such point.
        NotConverged
            When it has, but it was not reached.

        Examples
        --------
        >>> state = Analysis(Problem(n=2, k=0.4, mu=1.0)).event("zero_load").value
        >>> abs(state.load) < 1e-9, round(state.displacement, 6)
        (True, 2.085962)
        """
        if name not in self._pairs:
            bracket, condition = self._bracket(name)
            coarse = events.locate(*bracket, condition)
            check = events.sharpen(coarse, condition, *CHECK_MESH)
            self._pairs[name] = EventPair(check, events.sharpen(check, condition, *VALUE_MESH))
        return self._pairs[name]

    @one_thread()
    def landing(self, event: str) -> EventPair:
        """Where a jump of displacement control lands: on the other branch, at the fold's displacement."""
        fold = self.event(event)

        def at(displacement: float) -> Condition:
            return lambda state, rates: state.displacement - displacement

        condition = at(fold.value.displacement)
        crossings = events.brackets(self.points, condition, rising=True)
        coarse = events.locate(*crossings[-1 if event == "jump_in" else 0], condition)
        check = events.sharpen(coarse, at(fold.check.displacement), *CHECK_MESH)
        return EventPair(check, events.sharpen(check, at(fold.value.displacement), *VALUE_MESH))

    @one_thread()
    def solution(self, quantity: str) -> Solution:
        """A quantity at one of the events, with its uncertainty.

        Parameters
        ----------
        quantity : str
            One of `EVENT_QUANTITIES` or "hysteresis_energy".

        Raises
        ------
        NoSuchEvent, NotConverged, ValueError
        """
        start = time.perf_counter()
        if quantity == "hysteresis_energy":
            return self._hysteresis(start)
        if quantity not in EVENT_QUANTITIES:
            known = ", ".join([*EVENT_QUANTITIES, "hysteresis_energy"])
            raise ValueError(f"unknown quantity {quantity!r}; known are {known}")
        event, functional = EVENT_QUANTITIES[quantity]
        pair = self.event(event)
        # Load and displacement share their error (that of the work of adhesion), so the larger stands for
        # both.
        spread = pair.spread(functional, _load, _displacement)
        return _solution(functional(pair.value), spread, [pair], start)

    def _hysteresis(self, start: float) -> Solution:
        """Energy lost in the two jumps: what the energy drops by at constant displacement."""
        pairs = [
            self.event("jump_in"),
            self.landing("jump_in"),
            self.event("jump_out"),
            self.landing("jump_out"),
        ]

        a, a_landing, b, b_landing = (pair.value.energy for pair in pairs)
        # The four errors may cancel by accident, so their sizes are added.
        spread = sum(pair.spread(lambda state: state.energy) for pair in pairs)
        return _solution(a - a_landing + b - b_landing, spread, pairs, start)


def _solution(value: float, spread: float, pairs: list[EventPair], start: float) -> Solution:
    tail = max(pair.value.tail_uncertainty for pair in pairs)
    return Solution(
        float(value),
        float(SAFETY * spread + FLOOR * (1.0 + abs(value)) + tail),
        max(len(pair.value.gap) for pair in pairs) + 2,
        sum(pair.check.iterations + pair.value.iterations for pair in pairs),
        max(pair.value.residual for pair in pairs),
        time.perf_counter() - start,
    )


EVENT_QUANTITIES: dict[str, tuple[str, Callable[[State], float]]] = {
    "pull_off_force": ("pull_off", lambda state: -state.load),
    "pull_off_displacement": ("pull_off", _displacement),
    "jump_in_displacement": ("jump_in", _displacement),
    "jump_in_gap": ("jump_in", _central_gap),
    "jump_out_displacement": ("jump_out", _displacement),
    "jump_out_gap": ("jump_out", _central_gap),
    "zero_load_displacement": ("zero_load", _displacement),
}
