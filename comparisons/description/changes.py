"""Relative changes with their uncertainties, and their interpolation between nodes and towards a limit."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from comparisons.model import Array
from comparisons.numerics.monotone_cubic import monotone_cubic

#: Share of the change that the uncertainty has in the middle between two nodes (measured: a node from its neighbours,
#: twice as far apart, misses by up to 1 % beside the difference from a straight line).
BETWEEN = 0.01

#: Powers of 1/mu between which a change is taken to approach its limit (measured between Tabor numbers of 2 and 10:
#: the area with 0.50 to 0.76, the shape with 0.59 to 0.79, both rising with mu, strain with 0.6 to 1.1).
_SLOWEST, _FASTEST = 0.4, 1.2


class Change(NamedTuple):
    """A relative change and its uncertainty."""

    value: float
    uncertainty: float


#: Changes by the Tabor number.
Nodes = Mapping[float, Change]


def relative(a: Change, b: Change) -> Change:
    """Return the relative difference of two values.

    Examples
    --------
    >>> relative(Change(3.0, 0.1), Change(2.0, 0.1))
    Change(value=0.5, uncertainty=0.1)
    """
    return Change(a.value / b.value - 1.0, (a.uncertainty + b.uncertainty) / b.value)


def between(points: Array, nodes: Sequence[Change], point: float) -> Change:
    """Interpolate; the uncertainty is that of the nodes, and what a curve of another form between them differs by.

    Examples
    --------
    >>> nodes = [Change(0.0, 0.0), Change(1.0, 0.1), Change(2.0, 0.1)]
    >>> value, uncertainty = between(np.array([0.0, 1.0, 2.0]), nodes, 1.5)
    >>> round(value, 12), round(uncertainty, 12)
    (1.5, 0.12)
    """
    values, bounds = np.array([node.value for node in nodes]), np.array([node.uncertainty for node in nodes])
    value = monotone_cubic(points.tolist(), values.tolist(), point)
    right = int(np.clip(np.searchsorted(points, point), 1, points.size - 1))
    share = (point - points[right - 1]) / (points[right] - points[right - 1])
    form = BETWEEN * 4.0 * share * (1.0 - share) * float(np.abs(values[right - 1 : right + 1]).max())
    straight = abs(value - float(np.interp(point, points, values)))
    return Change(value, float(np.interp(point, points, bounds) + straight + form))


def at_tabor_number(nodes: Nodes, mu: float, limit: Change) -> Change:
    """Interpolate in the Tabor number; the limit is that of mu -> infinity."""
    numbers = np.array(sorted(nodes))
    values = [nodes[number] for number in numbers]
    if mu < numbers[0]:
        # It vanishes with mu.
        return Change(0.5 * values[0].value, 0.5 * abs(values[0].value) + values[0].uncertainty)
    if mu <= numbers[-1]:
        return between(np.log(numbers), values, math.log(mu))
    return towards(limit, values[-1], numbers[-1] / mu)


def towards(limit: Change, last: Change, share: float) -> Change:
    """Interpolate between the limit of mu -> infinity and the last value; `share` is the last Tabor number over mu."""
    distance = last.value - limit.value
    slow, fast = share**_SLOWEST, share**_FASTEST
    middle, half = 0.5 * (slow + fast), 0.5 * (slow - fast)
    return Change(
        limit.value + middle * distance,
        half * abs(distance) + (1.0 - fast) * limit.uncertainty + slow * last.uncertainty,
    )
