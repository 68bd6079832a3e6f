"""What a record itself shows of its motion: where the solid is, where the punch turns back, and where it rests.

The base of the cantilever, or the punch, moves towards the solid, perhaps rests, and moves away.  Near the solid the
load changes with the position; farther away it does not.  In contact the load rises with a motion towards the
solid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.model import Array

__all__ = ["Phases", "Senses", "phases", "senses"]

#: Shares of the range of the position in which the load may show which end is the contact, the narrowest first: a wider
#: one may contain the jump.
_ENDS = (0.01, 0.02, 0.05, 0.1)
#: Fewest points of such an end, and how much steeper than the other one it is.
_FEWEST, _STEEPER = 8, 3.0
#: A slope has a sign where it is so many standard errors, as a correlation of the points of an end shows it.
_CERTAIN = 8.0
#: The punch rests where the position changes by less than this share of its range for more than _RESTING times as
#: many points as it takes for the next such share, and for more than _LEAST points.
_REST, _RESTING, _LEAST = 0.01, 3.0, 8
#: A record has two cycles where the punch comes back by this share of its range.
_BACK = 0.25
#: Positions are equal where they differ by less than this share of their range, as sums of rounded numbers do.
_EQUAL = 1e-9


class Senses(NamedTuple):
    """Signs by which a position has to be multiplied to grow towards the solid, and a load to be positive if pressed.

    None where the record does not show them.
    """

    position: int | None
    load: int | None


class _End(NamedTuple):
    slope: float
    certainty: float


def _end(position: Array, load: Array, mask: NDArray[np.bool_]) -> _End:
    x, y = position[mask] - position[mask].mean(), load[mask] - load[mask].mean()
    size = float((x @ x) * (y @ y))
    if size == 0.0:
        return _End(0.0, 0.0)
    share = min(float(x @ y) ** 2 / size, 1.0 - np.finfo(float).eps)
    return _End(float(x @ y / (x @ x)), math.sqrt((len(x) - 2) * share / (1.0 - share)))


def senses(position: Array, load: Array) -> Senses:
    """Which end of the positions is the contact, and the sign of the load there.

    Parameters
    ----------
    position, load : ndarray, shape (m,)
        In any units, of any senses.

    Examples
    --------
    A height that grows away from the solid, and a load whose pressure is negative:

    >>> height = np.linspace(0.0, 1.0, 100)
    >>> senses(height, np.where(height < 0.2, height - 0.2, 0.0))
    Senses(position=-1, load=-1)
    """
    low, high = float(position.min()), float(position.max())
    for share in _ENDS if high > low else ():
        reach = share * (high - low)
        masks = {-1: position <= low + reach, 1: position >= high - reach}
        if min(int(mask.sum()) for mask in masks.values()) < _FEWEST:
            continue
        ends = {side: _end(position, load, mask) for side, mask in masks.items()}
        side = max(ends, key=lambda side: abs(ends[side].slope))
        nearer, farther = ends[side], ends[-side]
        if abs(nearer.slope) > _STEEPER * abs(farther.slope) and nearer.certainty > _CERTAIN:
            return Senses(side, side if nearer.slope > 0.0 else -side)
    return Senses(None, None)


@dataclass(frozen=True, eq=False)
class Phases:
    """Points of a record by their motion.

    Attributes
    ----------
    approach, retreat : ndarray of bool, shape (m,)
    rests : dict of str to int
        Points where the punch rests, which are of neither, by a word for when.
    """

    approach: NDArray[np.bool_]
    retreat: NDArray[np.bool_]
    rests: dict[str, int]


def phases(position: Array) -> Phases:
    """Split a record at its turning point; leave out where the punch rests.

    Parameters
    ----------
    position : ndarray, shape (m,)
        In the order of time, growing towards the solid.

    Raises
    ------
    ValueError
        If the punch comes back a second time; the message is the end of a sentence.

    Examples
    --------
    >>> up = np.linspace(0.0, 1.0, 100)
    >>> found = phases(np.concatenate([np.zeros(30), up, np.ones(20), up[::-1]]))
    >>> found.rests, int(found.approach.sum()), int(found.retreat.sum())
    ({'before the approach': 31, 'at the turning point': 22}, 98, 99)
    """
    count, span = len(position), float(np.ptp(position))
    numbers = np.arange(count)
    turning = int(np.argmax(position >= position.max() - _EQUAL * span)) if count else 0
    resting = {
        "before the approach": _rest(position, 0, span),
        "at the turning point": _rest(position, turning, span),
        "after the retreat": _rest(position, count - 1, span),
    }
    moving, rests = np.ones(count, bool), {}
    for when, (first, last) in resting.items():
        if last > first and (moving[first:last]).all():
            rests[when] = last - first
            moving[first:last] = False
    approach, retreat = moving & (numbers <= turning), moving & (numbers > turning)
    for branch, sense in ((approach, 1.0), (retreat, -1.0)):
        along = sense * position[branch]
        if along.size and float((np.maximum.accumulate(along) - along).max()) > _BACK * span:
            raise ValueError("has more than one approach and retreat; give one cycle in a file")
    return Phases(approach, retreat, rests)


def _rest(position: Array, at: int, span: float) -> tuple[int, int]:
    """The points around one where the punch rests, as a half-open interval, empty if it moves."""
    nowhere = (0, 0)
    if not len(position) or span == 0.0:
        return nowhere
    first, last = _near(position, at, _REST * span)
    # The points that the next such share takes, on the side or the sides where there is one.
    wider = _near(position, at, 2.0 * _REST * span)
    moving = (first - wider[0]) + (wider[1] - last)
    resting = last - first
    return (first, last) if resting > max(_RESTING * moving, _LEAST) and moving else nowhere


def _near(position: Array, at: int, reach: float) -> tuple[int, int]:
    """The interval of neighbours of a point within a distance of it."""
    outside = np.flatnonzero(np.abs(position - position[at]) > reach)
    after = int(np.searchsorted(outside, at))
    first = int(outside[after - 1]) + 1 if after else 0
    last = int(outside[after]) if after < len(outside) else len(position)
    return first, last
