"""What small strains leave out of the pull-off force of a ball: interpolation in a table of the finite elements.

`fem_reference.solve_large_strain` gives the force of a neo-Hookean solid, `fscm` that of the linear one, both for the
exact sphere without friction.  Their relative difference s depends on w/(E* R), mu and nu.  It grows as the contact
radius: s / (w/(E* R))^(1/3) is smooth, and is what is interpolated.  `python -m tests.comparisons.problem.strain_table`
computes the table.

At large Tabor numbers the tension makes the surface unstable, and the table has no force.  There s lies about where a
straight line in 1/mu through the last two points is half way to 1/mu = 0; its uncertainty is the whole way, and
`FURTHER` of the largest value before.  Between the rows the uncertainty contains the bounds of the forces and a
measured error of the interpolation.  Outside the table nothing has been solved: value and uncertainty are estimates.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from functools import lru_cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from comparisons.model import Array
from comparisons.problem import Problem, Section

#: Name of the table in `comparisons.data`.
FILE = "strain_errors.csv"

#: w/(E* R) and Poisson's ratios of the table.
SOFTNESS = (1e-5, 1e-4, 1e-3, 5e-3, 2e-2, 5e-2, 1e-1)
POISSON_RATIOS = (0.0, 0.2, 0.35, 0.5)

#: Share of the change that the uncertainty has in the middle between two rows (measured: a row from its neighbours,
#: twice as far apart, misses by up to 1 % beside the difference from a straight line).
BETWEEN = 0.01

#: Share of the largest change at smaller Tabor numbers that the uncertainty has beyond the last one (measured: forces
#: of the table from those at smaller Tabor numbers, three at least, miss by up to 0.6 of the uncertainty).
FURTHER = 0.5


class Change(NamedTuple):
    """A relative change, its uncertainty, and whether both are estimates from outside the table."""

    value: float
    uncertainty: float
    is_extrapolated: bool = False


def strain_change(softness: float, mu: float, nu: float) -> Change | None:
    """Return the relative change of the pull-off force of a ball by finite strain.

    Parameters
    ----------
    softness : float
        w/(E* R), dimensionless.
    mu : float
        Tabor number.
    nu : float
        Poisson's ratio, 0 to 0.5.

    Returns
    -------
    Change or None
        None above the largest w/(E* R) of the table.  Below its smallest one the change is that of the limit, and
        extrapolated as outside its Tabor numbers.

    Examples
    --------
    >>> change = strain_change(5e-3, 2.0, 0.5)
    >>> round(change.value, 5), change.uncertainty < 1e-5, change.is_extrapolated
    (0.00521, True, False)
    >>> strain_change(5e-3, 365.0, 0.5).is_extrapolated
    True
    >>> strain_change(0.2, 1.0, 0.3) is None
    True
    """
    root = float(np.cbrt(softness))
    roots = np.cbrt(SOFTNESS)
    if root > roots[-1] * (1.0 + 1e-12):
        return None
    of_ratios = []
    for ratio in POISSON_RATIOS:
        nodes = [_between_tabor_numbers(x, ratio, mu) for x in SOFTNESS]
        of_ratios.append(_between(roots, nodes, max(root, roots[0])))
    change = _between(np.array(POISSON_RATIOS), of_ratios, nu)
    is_below = bool(root < roots[0])
    below = abs(change.value) * (1.0 - root / roots[0]) if is_below else 0.0
    return Change(change.value * root, float((change.uncertainty + below) * root), change.is_extrapolated or is_below)


def _between_tabor_numbers(softness: float, nu: float, mu: float) -> Change:
    """Interpolate s / (w/(E* R))^(1/3) in the Tabor number."""
    known = _table()[softness, nu]
    numbers = np.array(sorted(known))
    nodes = [known[number] for number in numbers]
    if mu < numbers[0]:
        # It vanishes with mu.
        half = 0.5 * nodes[0].value
        return Change(half, abs(half) + nodes[0].uncertainty, is_extrapolated=True)
    if mu <= numbers[-1]:
        return _between(np.log(numbers), nodes, math.log(mu))
    return beyond(numbers, nodes)


def beyond(numbers: Array, nodes: Sequence[Change]) -> Change:
    """Return what s / (w/(E* R))^(1/3) is above the largest Tabor number.

    Parameters
    ----------
    numbers : ndarray, shape (m,)
        Tabor numbers, rising, two at least.
    nodes : sequence of Change
        The value at each.
    """
    last, previous = nodes[-1], nodes[-2]
    further = (last.value - previous.value) * numbers[-2] / (numbers[-1] - numbers[-2])
    largest = max(abs(node.value) for node in nodes)
    uncertainty = abs(further) + FURTHER * largest + last.uncertainty
    return Change(last.value + 0.5 * further, uncertainty, is_extrapolated=True)


def _between(points: Array, nodes: Sequence[Change], point: float) -> Change:
    """Interpolate; the uncertainty is that of the nodes, and what a curve of another form between them differs by."""
    values, uncertainties = np.array([node.value for node in nodes]), np.array([node.uncertainty for node in nodes])
    value = float(PchipInterpolator(points, values)(point))
    right = int(np.clip(np.searchsorted(points, point), 1, points.size - 1))
    share = (point - points[right - 1]) / (points[right] - points[right - 1])
    form = BETWEEN * 4.0 * share * (1.0 - share) * float(np.abs(values[right - 1 : right + 1]).max())
    straight = abs(value - float(np.interp(point, points, values)))
    uncertainty = float(np.interp(point, points, uncertainties) + straight + form)
    weights = zip(nodes[right - 1 : right + 1], (1.0 - share, share), strict=True)
    return Change(value, uncertainty, any(node.is_extrapolated for node, weight in weights if weight > 0.0))


@lru_cache(maxsize=1)
def _table() -> dict[tuple[float, float], dict[float, Change]]:
    """Rows by w/(E* R) and nu: Tabor number -> s / (w/(E* R))^(1/3)."""
    table: dict[tuple[float, float], dict[float, Change]] = {}
    lines = files("comparisons.data").joinpath(FILE).read_text(encoding="utf-8").splitlines()
    for row in csv.DictReader(lines):
        if row["pull_off_force"]:
            softness, mu, nu, finite, u_finite, linear, u_linear = (float(value) for value in row.values())
            root = float(np.cbrt(softness))
            bound = (u_finite + u_linear) / linear
            table.setdefault((softness, nu), {})[mu] = Change((finite / linear - 1.0) / root, bound / root)
    return table


def ball_on(softness: float, mu: float, nu: float) -> Problem:
    """Return the problem of a ball on a homogeneous solid, in units of its radius and the work of adhesion.

    Parameters
    ----------
    softness, mu, nu
        As for `strain_change`.
    """
    law = Section("lennard-jones-9-3", {"work_of_adhesion": 1.0, "z0": float(np.cbrt(softness)) ** 2 / mu})
    return Problem(Section("homogeneous", {"E": (1.0 - nu**2) / softness, "nu": nu}), Section("ball", {"R": 1.0}), law)
