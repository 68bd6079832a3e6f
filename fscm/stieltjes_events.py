"""What is asked of the published scheme: events, quantities with their uncertainty, order of convergence."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

from fscm._threads import one_thread
from fscm.analysis import Solution
from fscm.errors import NoSuchEvent, NotConverged
from fscm.problem import Problem
from fscm.stieltjes import CentralGapRates, StieltjesScheme, StieltjesState

__all__ = ["STIELTJES_QUANTITIES", "ConvergenceRow", "convergence", "find_event", "stieltjes_solution"]

Array = NDArray[np.float64]

# Central gap of an event; load and displacement are stationary in it, or known to 100 times this at zero
# load.
_EVENT_TOLERANCE = 1e-11
# From N/2 to N segments the error falls fourfold, so the difference is three times the error at N where the
# edge is resolved, and the tail is known to first order; the factor covers coarser meshes.  Measured worst
# error / u_num is 0.65 over n = 1 to 5, k = 0, 0.3, 0.6, mu = 0.2, 0.8, 1.4 on 160 segments, wherever it
# converges.
_SAFETY = 2.0
_SIMPLE_FOLDS = (0, 2)


@one_thread()
def find_event(scheme: StieltjesScheme, name: str) -> StieltjesState:
    """State of an event, refined from the samples of the path to a root of the exact derivative.

    Parameters
    ----------
    scheme : StieltjesScheme
    name : str
        pull_off (least load), jump_in (first extreme of the displacement), jump_out (last), or zero_load
        (last).

    Raises
    ------
    NoSuchEvent
        When the path, which ends at `scheme.last_gap` or `scheme.last_load`, does not contain it.
    NotConverged
        When the path or the search fails, or the displacement has neither no fold nor two: then the cohesive
        edge is narrower than the segments and pins to them, or the path ends before contact.
    ValueError
        For an unknown name.

    Examples
    --------
    >>> scheme = StieltjesScheme(Problem(n=2, k=0.4, mu=0.5), segments=100, gap_step=0.2)
    >>> -1.9 < find_event(scheme, "pull_off").load < -1.8  # converged: -1.8663
    True
    """
    if name not in _EVENTS:
        raise ValueError(f"unknown event {name!r}; known are {', '.join(_EVENTS)}")
    folds = _turns(np.diff([s.displacement for s in scheme.path]))
    if len(folds) not in _SIMPLE_FOLDS:
        raise NotConverged(
            f"the displacement has {len(folds)} folds, not 0 or 2, on {scheme.segments} segments at "
            f"mu = {scheme.problem.mu:g}: the edge pins to the segments, or the path ends before contact"
        )
    event = _EVENTS[name]
    along = np.array([event.followed(s) for s in scheme.path])
    changes = np.diff(along) if event.rate else along
    turns = _turns(changes, rising=event.rising)
    if not turns.size:
        raise NoSuchEvent(
            f"there is no {name.replace('_', ' ')} at mu = {scheme.problem.mu:g} between the central gaps "
            f"{scheme.first_gap:g} and {scheme.last_gap:g}"
        )
    at = int(event.pick(turns, along))
    # Two steps bracket an extreme, one step a zero.
    a, b = scheme.path[at], scheme.path[at + (2 if event.rate else 1)]
    rate = event.rate
    return _between(scheme, a, b, (lambda s: rate(scheme.rates(s))) if rate else event.followed)


def _turns(values: Array, rising: bool | None = None) -> NDArray[np.intp]:
    """Indices i with a change of sign between i and i + 1, to positive if `rising`, to negative if not."""
    positive = np.asarray(values) >= 0.0
    turned = positive[1:] != positive[:-1]
    return np.flatnonzero(turned if rising is None else turned & (positive[1:] == rising))


def _between(
    scheme: StieltjesScheme, a: StieltjesState, b: StieltjesState, measure: Callable[[StieltjesState], float]
) -> StieltjesState:
    """State between two others at which a measure vanishes."""
    known = {s.central_gap: s for s in (a, b)}

    def at(gap: float) -> StieltjesState:
        if gap not in known:
            nearest = min(known, key=lambda other: abs(other - gap))
            known[gap] = scheme.solve(gap, known[nearest].gap)
        return known[gap]

    low, high = sorted(known)
    if measure(a) * measure(b) > 0.0:
        raise NotConverged(
            f"between the central gaps {low:g} and {high:g} the path turns more than once: use a smaller gap_step"
        )
    return at(float(brentq(lambda gap: measure(at(gap)), low, high, xtol=_EVENT_TOLERANCE, rtol=1e-15)))


@dataclass(frozen=True)
class _Event:
    """How an event is told along the path.

    Attributes
    ----------
    followed : what is sampled along the path.
    rising : whether it (or its change) passes from negative to positive.
    rate : the derivative that vanishes; None when the sampled quantity itself does.
    pick : which of several turns.
    """

    followed: Callable[[StieltjesState], float]
    rising: bool
    rate: Callable[[CentralGapRates], float] | None
    pick: Callable[[NDArray[np.intp], Array], int]


def _load(state: StieltjesState) -> float:
    return state.load


def _displacement(state: StieltjesState) -> float:
    return state.displacement


def _central_gap(state: StieltjesState) -> float:
    return state.central_gap


_EVENTS = {
    "pull_off": _Event(_load, True, lambda r: r.load, lambda turns, P: int(turns[np.argmin(P[turns + 1])])),
    "jump_in": _Event(_displacement, False, lambda r: r.displacement, lambda turns, _: int(turns[0])),
    "jump_out": _Event(_displacement, True, lambda r: r.displacement, lambda turns, _: int(turns[-1])),
    "zero_load": _Event(_load, True, None, lambda turns, _: int(turns[-1])),
}

# Quantities that the scheme answers: event and functional of its state.
STIELTJES_QUANTITIES: dict[str, tuple[str, Callable[[StieltjesState], float]]] = {
    "pull_off_force": ("pull_off", lambda s: -s.load),
    "pull_off_displacement": ("pull_off", _displacement),
    "jump_in_displacement": ("jump_in", _displacement),
    "jump_in_gap": ("jump_in", _central_gap),
    "jump_out_displacement": ("jump_out", _displacement),
    "jump_out_gap": ("jump_out", _central_gap),
    "zero_load_displacement": ("zero_load", _displacement),
}


def _quantity(quantity: str) -> tuple[str, Callable[[StieltjesState], float]]:
    if quantity not in STIELTJES_QUANTITIES:
        raise ValueError(f"unknown quantity {quantity!r}; known are {', '.join(STIELTJES_QUANTITIES)}")
    return STIELTJES_QUANTITIES[quantity]


@one_thread()
def stieltjes_solution(problem: Problem, quantity: str, segments: int = 2500, **settings: float) -> Solution:
    """One quantity from the published scheme, with its numerical uncertainty.

    The uncertainty is the difference to half as many segments with a safety factor, and what the traction
    beyond f(r_max) would have added to load and displacement.

    Parameters
    ----------
    problem : Problem
    quantity : str
        One of `STIELTJES_QUANTITIES`.
    segments : int
        N, at least 20.
    **settings
        farthest_height, gap_step, first_gap, last_gap and last_load of `StieltjesScheme`.

    Raises
    ------
    NoSuchEvent, NotConverged, ValueError
        As `find_event` and `StieltjesScheme`.

    Examples
    --------
    >>> found = stieltjes_solution(Problem(2, 0.4, 0.5), "pull_off_force", 200, gap_step=0.2)
    >>> bool(abs(found.value - 1.86628026) < found.u_num < 0.01)
    True
    """
    start = time.perf_counter()
    event, functional = _quantity(quantity)
    scheme = StieltjesScheme(problem, segments, **settings)
    state = find_event(scheme, event)
    value = functional(state)
    coarse = functional(find_event(StieltjesScheme(problem, segments // 2, **settings), event))
    u_num = _SAFETY * (abs(value - coarse) + _beyond(scheme, state, quantity))
    iterations = sum(s.iterations for s in scheme.path)
    return Solution(value, u_num, segments, iterations, state.change, time.perf_counter() - start)


def _beyond(scheme: StieltjesScheme, state: StieltjesState, quantity: str) -> float:
    """Size of what the traction beyond the last segment would change."""
    load, displacement = (_tail(scheme, state, x) for x in (2.0, 1.0 - scheme.problem.k))
    if quantity == "pull_off_force":
        return load
    if quantity == "zero_load_displacement":
        rates = scheme.rates(state)
        return displacement * scheme.problem.compliance + load * abs(rates.displacement / rates.load)
    return displacement * scheme.problem.compliance


def _tail(scheme: StieltjesScheme, state: StieltjesState, exponent: float) -> float:
    """Size of the integral of p d(r^exponent) beyond the last segment, where w hardly changes."""
    problem, radius = scheme.problem, float(scheme.radius[-1])
    shift = float(state.gap[-1]) - scheme.farthest_height

    def density(log_ratio: float) -> float:
        r = np.array([radius * math.exp(log_ratio)])
        gap = problem.profile.height(r) + shift
        return float((problem.law.traction(gap) * exponent * r**exponent)[0])

    # In log r the integrand decays exponentially; where f has grown by e^60 nothing is left of it.
    return abs(float(quad(density, 0.0, 60.0 / problem.profile.growth, limit=200)[0]))


@dataclass(frozen=True)
class ConvergenceRow:
    """One size of a convergence study; `order` compares two refinements, NaN in the first two rows."""

    segments: int
    value: float
    error: float
    order: float
    seconds: float


@one_thread()
def convergence(
    problem: Problem, quantity: str, exact: float, sizes: Sequence[int], **settings: float
) -> list[ConvergenceRow]:
    """Values of the scheme on meshes that double in number, with error and measured order.

    Parameters
    ----------
    problem, quantity, settings
        As for `stieltjes_solution`.
    exact : float
        What the error is measured against.
    sizes : sequence of int
        Numbers of segments, each twice the one before.

    Returns
    -------
    list of ConvergenceRow
        The order log2 |(v_2 - v_1) / (v_3 - v_2)| tells how fast the scheme approaches its own limit, which
        differs from `exact` by the missing tail.

    Raises
    ------
    NoSuchEvent, NotConverged, ValueError

    Examples
    --------
    >>> rows = convergence(Problem(2, 0.0, 0.5), "pull_off_force", 1.78748293, [50, 100, 200], gap_step=0.25)
    >>> 1.5 < rows[-1].order < 2.5
    True
    """
    event, functional = _quantity(quantity)
    if any(b != 2 * a for a, b in pairwise(sizes)):
        raise ValueError(f"sizes = {list(sizes)} do not double: the order is that of halving the segments")
    rows: list[ConvergenceRow] = []
    for segments in sizes:
        start = time.perf_counter()
        value = functional(find_event(StieltjesScheme(problem, segments, **settings), event))
        order = math.nan
        if len(rows) >= 2:
            order = math.log2(abs((rows[-1].value - rows[-2].value) / (value - rows[-1].value)))
        rows.append(ConvergenceRow(segments, value, value - exact, order, time.perf_counter() - start))
    return rows
