"""Events on the path of the Stieltjes scheme."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fscm._roots import bracketed_root
from fscm._threads import one_thread
from fscm._typing import Array
from fscm.errors import Failure, NoSuchEvent, NotConverged
from fscm.stieltjes.scheme import CentralGapRates, StieltjesScheme, StieltjesState

__all__ = ["find_event"]

#: Tolerance of the central gap of an event; load and displacement are stationary there, or exact to 100 times this at
#: zero load.
_EVENT_TOLERANCE = 1e-11
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
        When the path or the search fails, or the displacement does not have 0 or 2 folds: then the cohesive edge is
        narrower than the segments and pins to them, or the path ends before contact.
    ValueError
        For an unknown name.

    Examples
    --------
    >>> from fscm.problem import Problem
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
            f"mu = {scheme.problem.mu:g}: the edge pins to the segments, or the path ends before contact",
            Failure.SCHEME,
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
    states = {s.central_gap: s for s in (a, b)}

    def at(gap: float) -> StieltjesState:
        if gap not in states:
            nearest = min(states, key=lambda central_gap: abs(central_gap - gap))
            states[gap] = scheme.solve(gap, states[nearest].gap)
        return states[gap]

    low, high = sorted(states)
    if measure(a) * measure(b) > 0.0:
        raise NotConverged(
            f"between the central gaps {low:g} and {high:g} the path turns more than once",
            Failure.SCHEME,
        )
    return at(bracketed_root(lambda gap: measure(at(gap)), low, high, _EVENT_TOLERANCE))


@dataclass(frozen=True)
class _Event:
    """How an event is identified along the path.

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


_EVENTS = {
    "pull_off": _Event(_load, True, lambda r: r.load, lambda turns, P: int(turns[np.argmin(P[turns + 1])])),
    "jump_in": _Event(_displacement, False, lambda r: r.displacement, lambda turns, _: int(turns[0])),
    "jump_out": _Event(_displacement, True, lambda r: r.displacement, lambda turns, _: int(turns[-1])),
    "zero_load": _Event(_load, True, None, lambda turns, _: int(turns[-1])),
}
