"""What small strains and vertical gaps change of the pull-off force of a ball: interpolation in a table.

`fscm` gives the force of the linear solid, whose surface force is that of the vertical gap;
`fem_reference.solve_large_strain` that of a neo-Hookean one with vertical gaps, and that with the potential of the
ball.  All are for the exact sphere without friction.  They depend on w/(E* R), mu and nu, and are interpolated in

* s / x with x = (w/(E* R))^(1/3), for the relative change s by finite strain, which grows as the contact radius;
* g = (A - r) / ((1 + r) L), for the relative change A by the potential of the ball.  r is that of a rigid solid, by
  z0/R, and L = jkr-sphere / jkr-sphere-projected - 1 that of mu -> infinity, where the true area of contact counts in
  place of the projected one.  g rises from 0 at mu = 0 to 1.

`python -m tests.comparisons.problem.strain_table` computes the table.  Beyond its largest Tabor number both are
interpolated towards mu -> infinity, where g = 1, and s/x has the limit `STRAIN_LIMIT` for an incompressible solid.  The
surface of a compressible solid becomes unstable at large Tabor numbers, where there is no force: s lies about where a
straight line in 1/mu through the last two points is half way to 1/mu = 0, with a whole way as its uncertainty.  What is
interpolated is an estimate.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import minimize_scalar

from comparisons.model import Array
from comparisons.models.jkr_sphere import JKRSphere, JKRSphereProjected
from comparisons.problem import Problem, Section
from fem_reference import Ball, LennardJones
from fem_reference.interaction import interaction_of

#: Name of the table in `comparisons.data`.
FILE = "strain_errors.csv"

#: w/(E* R) and Poisson's ratios of the table.
SOFTNESS = (1e-5, 1e-4, 1e-3, 5e-3, 2e-2, 5e-2, 1e-1)
POISSON_RATIOS = (0.0, 0.2, 0.35, 0.5)

#: Share of the change that the uncertainty has in the middle between two rows (measured: a row from its neighbours,
#: twice as far apart, misses by up to 1 % beside the difference from a straight line).
BETWEEN = 0.01

#: What g of another Poisson's ratio may differ by from that of an incompressible solid, over x (measured: up to 0.38,
#: at nu = 0 and w/(E* R) = 0.05).
OTHER_RATIOS = 0.4

#: Share of the largest change at smaller Tabor numbers that the uncertainty has beyond the last one (measured: forces
#: of the table from those at smaller Tabor numbers, three at least, miss by up to 0.6 of it).
FURTHER = 0.5

#: s/x of an incompressible solid for mu -> infinity and w/(E* R) -> 0: 0.0294 a/R with a/R = (9 pi/8)^(1/3) x at the
#: pull-off of JKR, from the energy of third order of its field.  The table tends to it: 0.0385, 0.0407 at mu = 3 and 5.
STRAIN_LIMIT = 0.0294 * (9.0 * math.pi / 8.0) ** (1.0 / 3.0)

#: Fall of s/x over x in that limit (measured at mu = 3 and 5, w/(E* R) from 1e-4 to 5e-3: by 0.044 to 0.065).
STRAIN_CURVATURE = 0.06

#: Powers of 1/mu between which a change is taken to approach its limit (measured between Tabor numbers of 2 and 5: g
#: with 0.50 to 0.63, rising with mu, s with 0.8 to 1.1).
_SLOWEST, _FASTEST = 0.4, 1.2

#: Heights of the apex, in z0, between which the load of a rigid ball has its minimum.
_HEIGHTS = (-0.4, 2.0)

#: Pieces of the load of a rigid ball, in the logarithm of the radius, and the nodes of each.
_PIECES, _GAUSS = 48, np.polynomial.legendre.leggauss(16)


class Change(NamedTuple):
    """A relative change and its uncertainty."""

    value: float
    uncertainty: float


_Nodes = Mapping[float, Change]


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
        None above the largest w/(E* R) of the table.  Below its smallest one the change is that of the limit.

    Examples
    --------
    >>> change = strain_change(5e-3, 2.0, 0.5)
    >>> round(change.value, 5), change.uncertainty < 1e-5
    (0.00521, True)
    >>> strain_change(0.2, 1.0, 0.3) is None
    True
    """
    change = _interpolated(softness, nu, lambda x, ratio: _at_tabor_number(_strains(x, ratio), mu, _limit(x, ratio)))
    root = float(np.cbrt(softness))
    return change and Change(change.value * root, change.uncertainty * root)


def body_change(softness: float, mu: float, nu: float) -> Change | None:
    """Return the relative change of the pull-off force of a ball by its potential in place of vertical gaps.

    Parameters
    ----------
    softness, mu, nu
        As for `strain_change`.

    Returns
    -------
    Change or None
        As of `strain_change`.

    Examples
    --------
    >>> change = body_change(5e-3, 300.0, 0.5)
    >>> round(change.value, 2), change.uncertainty < 2e-3
    (0.03, True)
    """
    change = _interpolated(softness, nu, lambda x, _: _at_tabor_number(_areas(x), mu, Change(1.0, 0.0)))
    if change is None:
        return None
    root = float(np.cbrt(softness))
    bound = change.uncertainty + (OTHER_RATIOS * root if nu < POISSON_RATIOS[-1] else 0.0)
    rigid, limit = rigid_change(root**2 / mu), area_limit(softness)
    return Change(rigid + (1.0 + rigid) * limit * change.value, (1.0 + rigid) * limit * bound)


@lru_cache(maxsize=256)
def area_limit(softness: float) -> float:
    """Relative change of the pull-off force for mu -> infinity by the true area of contact.

    Examples
    --------
    >>> round(area_limit(5e-3), 6)  # 1.007085 / 0.973699
    0.034288
    """
    ball = ball_on(softness, 1.0, 0.5)
    models = JKRSphere(), JKRSphereProjected()
    true, projected = (model.evaluate(ball, "pull_off_force").value for model in models)
    return true / projected - 1.0


@lru_cache(maxsize=256)
def rigid_change(range_over_radius: float) -> float:
    """Relative change of the pull-off force from a rigid solid by the potential of the ball.

    Where the ball is a sphere, both loads are the same integral; they differ by what the shape is beyond 0.95 R.

    Parameters
    ----------
    range_over_radius : float
        z0/R.

    Examples
    --------
    >>> -2e-6 < rigid_change(1e-3) < 0.0
    True
    """
    ball, law = Ball(1.0), LennardJones(1.0, range_over_radius)
    ends = np.linspace(math.log(1e-4 * math.sqrt(range_over_radius)), math.log(ball.reach), _PIECES)
    ends = np.append(ends, np.linspace(ends[-1], ends[-1] + 10.0, _PIECES)[1:])
    half = 0.5 * np.diff(ends)
    x, weights = _GAUSS
    rho = np.exp((ends[:-1] + half)[:, None] + half[:, None] * x)
    measure = half[:, None] * weights * rho**2
    forces = []
    for name in ("derjaguin", "body"):
        traction = interaction_of(ball, law, name).traction

        def load(height: float, traction: Callable[[Array, Array], Array] = traction) -> float:
            return float(np.sum(measure * traction(rho, ball.height(rho) + height * range_over_radius)))

        forces.append(-minimize_scalar(load, bounds=_HEIGHTS, method="bounded", options={"xatol": 1e-9}).fun)
    return float(forces[1] / forces[0] - 1.0)


def _interpolated(softness: float, nu: float, node: Callable[[float, float], Change]) -> Change | None:
    """Interpolate in w/(E* R) and in nu what a function of both returns; None above the largest w/(E* R)."""
    root, roots = float(np.cbrt(softness)), np.cbrt(SOFTNESS)
    if root > roots[-1] * (1.0 + 1e-12):
        return None
    inside = max(root, roots[0])
    of_ratios = [_between(roots, [node(x, ratio) for x in SOFTNESS], inside) for ratio in POISSON_RATIOS]
    change = _between(np.array(POISSON_RATIOS), of_ratios, nu)
    below = abs(change.value) * (1.0 - root / float(roots[0])) if root < roots[0] else 0.0
    return Change(change.value, change.uncertainty + below)


def _at_tabor_number(nodes: _Nodes, mu: float, limit: Change | None) -> Change:
    """Interpolate in the Tabor number; the limit is that of mu -> infinity."""
    numbers = np.array(sorted(nodes))
    values = [nodes[number] for number in numbers]
    if mu < numbers[0]:
        # It vanishes with mu.
        return Change(0.5 * values[0].value, 0.5 * abs(values[0].value) + values[0].uncertainty)
    if mu <= numbers[-1]:
        return _between(np.log(numbers), values, math.log(mu))
    return beyond(numbers, values) if limit is None else _towards(limit, values[-1], numbers[-1] / mu)


def _towards(limit: Change, last: Change, share: float) -> Change:
    """Interpolate between the limit of mu -> infinity and the last value; `share` is the last Tabor number over mu."""
    distance = last.value - limit.value
    slow, fast = share**_SLOWEST, share**_FASTEST
    middle, half = 0.5 * (slow + fast), 0.5 * (slow - fast)
    return Change(
        limit.value + middle * distance,
        half * abs(distance) + (1.0 - fast) * limit.uncertainty + slow * last.uncertainty,
    )


def beyond(numbers: Array, nodes: Sequence[Change]) -> Change:
    """Return what s/x is above the largest Tabor number where its limit is unknown.

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
    return Change(last.value + 0.5 * further, abs(further) + FURTHER * largest + last.uncertainty)


def _between(points: Array, nodes: Sequence[Change], point: float) -> Change:
    """Interpolate; the uncertainty is that of the nodes, and what a curve of another form between them differs by."""
    values, bounds = np.array([node.value for node in nodes]), np.array([node.uncertainty for node in nodes])
    value = float(PchipInterpolator(points, values)(point))
    right = int(np.clip(np.searchsorted(points, point), 1, points.size - 1))
    share = (point - points[right - 1]) / (points[right] - points[right - 1])
    form = BETWEEN * 4.0 * share * (1.0 - share) * float(np.abs(values[right - 1 : right + 1]).max())
    straight = abs(value - float(np.interp(point, points, values)))
    return Change(value, float(np.interp(point, points, bounds) + straight + form))


class _Row(NamedTuple):
    """Pull-off forces of a row of the table with their bounds, in pi R w: of the body, vertical gaps, small strains."""

    body: Change | None
    vertical: Change
    linear: Change


@lru_cache(maxsize=1)
def _table() -> dict[tuple[float, float], dict[float, _Row]]:
    """Rows by w/(E* R) and nu, and by the Tabor number; those without a force are left out."""
    table: dict[tuple[float, float], dict[float, _Row]] = {}
    lines = files("comparisons.data").joinpath(FILE).read_text(encoding="utf-8").splitlines()
    for row in csv.DictReader(lines):
        if row["vertical_force"]:
            softness, mu, nu, *forces = (float(value) if value else math.nan for value in row.values())
            body, vertical, linear = (Change(*pair) for pair in zip(forces[::2], forces[1::2], strict=True))
            table.setdefault((softness, nu), {})[mu] = _Row(body if row["body_force"] else None, vertical, linear)
    return table


def _relative(a: Change, b: Change) -> Change:
    return Change(a.value / b.value - 1.0, (a.uncertainty + b.uncertainty) / b.value)


def _strains(softness: float, nu: float) -> _Nodes:
    """Tabor number -> s/x."""
    root = float(np.cbrt(softness))
    changes = {mu: _relative(row.vertical, row.linear) for mu, row in _table()[softness, nu].items()}
    return {mu: Change(change.value / root, change.uncertainty / root) for mu, change in changes.items()}


def _areas(softness: float, nu: float = POISSON_RATIOS[-1]) -> _Nodes:
    """Tabor number -> g, of an incompressible solid by default."""
    limit, nodes = area_limit(softness), {}
    for mu, row in _table()[softness, nu].items():
        if row.body is None:
            continue
        change, rigid = _relative(row.body, row.vertical), rigid_change(float(np.cbrt(softness)) ** 2 / mu)
        unit = (1.0 + rigid) * limit
        nodes[mu] = Change((change.value - rigid) / unit, change.uncertainty / unit)
    return nodes


def _limit(softness: float, nu: float) -> Change | None:
    """Limit of s/x for mu -> infinity, if it is known; its term of higher order is as uncertain as it is large."""
    if nu != POISSON_RATIOS[-1]:
        return None
    higher = STRAIN_CURVATURE * float(np.cbrt(softness))
    return Change(STRAIN_LIMIT - higher, higher)


def ball_on(softness: float, mu: float, nu: float) -> Problem:
    """Return the problem of a ball on a homogeneous solid, in units of its radius and the work of adhesion.

    Parameters
    ----------
    softness, mu, nu
        As for `strain_change`.
    """
    law = Section("lennard-jones-9-3", {"work_of_adhesion": 1.0, "z0": float(np.cbrt(softness)) ** 2 / mu})
    return Problem(Section("homogeneous", {"E": (1.0 - nu**2) / softness, "nu": nu}), Section("ball", {"R": 1.0}), law)
