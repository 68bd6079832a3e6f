"""Errors of a paraboloid, of vertical gaps and of small strains in the pull-off force of a ball: a table, interpolated.

`fscm` gives the force of the linear solid, whose surface force is that of the vertical gap, for the paraboloid and for
the exact sphere; `fem_reference.solve_large_strain` that of a neo-Hookean solid with vertical gaps, and that with the
potential of the ball.  All are without friction.  They depend on w/(E* R), mu and nu, and are interpolated in

* s / x with x = (w/(E* R))^(1/3), for the relative change s by finite strain, which grows as the contact radius;
* g = (A - r) / ((1 + r) L), for the relative change A by the exact sphere, or by the potential of the ball.  r is that
  of a rigid solid, by z0/R, and L that of mu -> infinity, by `jkr-sphere-projected` against JKR, or by `jkr-sphere`
  against `jkr-sphere-projected`.  g rises from 0 at mu = 0 to 1.

`python -m tests.comparisons.problem.strain_table` computes the table.  Beyond its largest Tabor number g is
interpolated towards 1, and so is s/x of its smallest w/(E* R) towards its limit, `third_order.strain_limit`; for larger
w/(E* R) the difference from that is interpolated towards a limit as uncertain as it is large.  The surface of a
compressible solid becomes unstable at large Tabor numbers, where the table has no force.  What is interpolated is an
estimate.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from functools import lru_cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np
import scipy

from comparisons.description.changes import Change, Nodes, at_tabor_number, between, relative, towards
from comparisons.description.third_order import strain_limit
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

#: What g of another Poisson's ratio may differ by from that of an incompressible solid, over x (measured: up to 0.38,
#: at nu = 0 and w/(E* R) = 0.05).
OTHER_RATIOS = 0.4

#: Contact radius of JKR at pull-off in R x.
_CONTACT = (9.0 * math.pi / 8.0) ** (1.0 / 3.0)

#: Fall of s/x over x in the limit of mu -> infinity, with its uncertainty, for an incompressible solid and another one
#: (measured: for an incompressible solid at w/(E* R) = 1e-3, 0.056, 0.083, 0.097 and 0.044 at mu = 3, 5, 10 and 30, and
#: 0.054 and 0.064 at mu = 30 and 1e-4 and 1e-5; for others 0.02 to 0.15 at Tabor numbers from 2 to 5, most where the
#: surface is nearly unstable).
OF_INCOMPRESSIBLE, OF_COMPRESSIBLE = Change(0.07, 0.07), Change(0.1, 0.1)

#: Heights of the apex, in z0, between which the load of a rigid ball has its minimum.
_HEIGHTS = (-0.4, 2.0)

#: Pieces of the load of a rigid ball, in the logarithm of the radius, and the nodes of each.
_PIECES, _GAUSS = 48, np.polynomial.legendre.leggauss(16)


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
    change = _interpolated(softness, nu, lambda x, ratio: _strain_at(x, mu, ratio))
    root = float(np.cbrt(softness))
    return change and Change(change.value * root, change.uncertainty * root)


def _strain_at(softness: float, mu: float, nu: float) -> Change:
    """s/x of a row of the table, at any Tabor number."""
    nodes, last = _strains(softness, nu), max(_strains(softness, nu))
    if mu <= last:
        return at_tabor_number(nodes, mu, nodes[last])
    least = float(np.cbrt(SOFTNESS[0]))
    base, limit = _strains(SOFTNESS[0], nu), _limit(least, nu, strain_limit(nu) * _CONTACT)
    value, there = (at_tabor_number(base, number, limit) for number in (mu, last))
    if softness == SOFTNESS[0]:
        return value
    distance = Change(nodes[last].value - there.value, nodes[last].uncertainty + there.uncertainty)
    further = towards(_limit(float(np.cbrt(softness)) - least, nu), distance, last / mu)
    return Change(value.value + further.value, value.uncertainty + further.uncertainty)


def _limit(x: float, nu: float, first: float = 0.0) -> Change:
    """A limit of s/x: that of first order, and its term of higher order."""
    fall = OF_INCOMPRESSIBLE if nu == POISSON_RATIOS[-1] else OF_COMPRESSIBLE
    return Change(first - fall.value * x, fall.uncertainty * x)


def shape_change(softness: float, mu: float) -> Change | None:
    """Return the relative change of the pull-off force by the exact sphere in place of a paraboloid.

    Parameters
    ----------
    softness, mu
        As for `strain_change`.

    Returns
    -------
    Change or None
        As of `strain_change`.

    Examples
    --------
    >>> change = shape_change(5e-3, 365.5)
    >>> round(change.value, 3), change.uncertainty < 1e-3  # by a solution -0.0263
    (-0.026, True)
    """
    return _of_mechanism(shape_limit, 0, softness, mu)


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
    return _of_mechanism(area_limit, 1, softness, mu, OTHER_RATIOS if nu < POISSON_RATIOS[-1] else 0.0)


def _of_mechanism(
    of_limit: Callable[[float], float], mechanism: int, softness: float, mu: float, others: float = 0.0
) -> Change | None:
    """Interpolate g of a mechanism, with an uncertainty of `others` x besides."""
    change = _interpolated(
        softness, POISSON_RATIOS[-1], lambda x, _: at_tabor_number(_shares(x, mechanism), mu, Change(1.0, 0.0))
    )
    if change is None:
        return None
    root = float(np.cbrt(softness))
    rigid = rigid_changes(root**2 / mu)[mechanism]
    unit = (1.0 + rigid) * of_limit(softness)
    return Change(rigid + unit * change.value, abs(unit) * (change.uncertainty + others * root))


@lru_cache(maxsize=256)
def shape_limit(softness: float) -> float:
    """Relative change of the pull-off force of JKR by the exact sphere.

    Examples
    --------
    >>> round(shape_limit(5e-3), 6)
    -0.026301
    """
    return JKRSphereProjected().evaluate(ball_on(softness, 1.0, 0.5), "pull_off_force").value / 1.5 - 1.0


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
def rigid_changes(range_over_radius: float) -> tuple[float, float]:
    """Relative changes of the pull-off force from a rigid solid by the exact sphere, and by the potential of the ball.

    Where the ball is a sphere, the loads of vertical gaps and of the potential are the same integral; they differ by
    what the shape is beyond 0.95 R.

    Parameters
    ----------
    range_over_radius : float
        z0/R.

    Examples
    --------
    >>> shape, body = rigid_changes(1e-3)
    >>> -2e-3 < shape < 0.0, -2e-6 < body < 0.0
    (True, True)
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

        forces.append(
            -scipy.optimize.minimize_scalar(load, bounds=_HEIGHTS, method="bounded", options={"xatol": 1e-9}).fun
        )
    # That of the paraboloid is 2 pi w R (Bradley).
    return float(forces[0] - 1.0), float(forces[1] / forces[0] - 1.0)


def _interpolated(softness: float, nu: float, node: Callable[[float, float], Change]) -> Change | None:
    """Interpolate in w/(E* R) and in nu what a function of both returns; None above the largest w/(E* R)."""
    root, roots = float(np.cbrt(softness)), np.cbrt(SOFTNESS)
    if root > roots[-1] * (1.0 + 1e-12):
        return None
    inside = max(root, roots[0])
    of_ratios = [between(roots, [node(x, ratio) for x in SOFTNESS], inside) for ratio in POISSON_RATIOS]
    change = between(np.array(POISSON_RATIOS), of_ratios, nu)
    below = abs(change.value) * (1.0 - root / float(roots[0])) if root < roots[0] else 0.0
    return Change(change.value, change.uncertainty + below)


class _Row(NamedTuple):
    """A row of the table: pull-off forces with their bounds, in pi R w, and what `rigid_changes` gives."""

    body: Change | None
    vertical: Change | None
    linear: Change
    paraboloid: Change
    rigid: tuple[float, float]


@lru_cache(maxsize=1)
def _table() -> dict[tuple[float, float], dict[float, _Row]]:
    """Rows by w/(E* R) and nu, and by the Tabor number."""
    table: dict[tuple[float, float], dict[float, _Row]] = {}
    lines = files("comparisons.data").joinpath(FILE).read_text(encoding="utf-8").splitlines()
    for row in csv.DictReader(lines):
        numbers = {name: float(value) for name, value in row.items() if value}
        forces = {
            name: Change(numbers[f"{name}_force"], numbers[f"{name}_u_num"]) if f"{name}_force" in numbers else None
            for name in ("body", "vertical", "linear", "paraboloid")
        }
        rows = table.setdefault((numbers["elasto_adhesion_number"], numbers["nu"]), {})
        rows[numbers["mu"]] = _Row(**forces, rigid=(numbers["rigid_shape"], numbers["rigid_body"]))  # type: ignore[arg-type]  # the last two are never missing
    return table


@lru_cache(maxsize=64)
def _strains(softness: float, nu: float) -> Nodes:
    """Tabor number -> s/x."""
    root = float(np.cbrt(softness))
    nodes = {}
    for mu, row in _table()[softness, nu].items():
        if row.vertical is not None:
            change = relative(row.vertical, row.linear)
            nodes[mu] = Change(change.value / root, change.uncertainty / root)
    return nodes


@lru_cache(maxsize=64)
def _shares(softness: float, mechanism: int, nu: float = POISSON_RATIOS[-1]) -> Nodes:
    """Tabor number -> g by the exact sphere (0) or by its potential (1), the latter of an incompressible solid."""
    limit, nodes = (shape_limit, area_limit)[mechanism](softness), {}
    for mu, row in _table()[softness, nu].items():
        changed, force = (row.linear, row.paraboloid) if mechanism == 0 else (row.body, row.vertical)
        if changed is not None and force is not None:
            change, unit = relative(changed, force), (1.0 + row.rigid[mechanism]) * limit
            nodes[mu] = Change((change.value - row.rigid[mechanism]) / unit, change.uncertainty / abs(unit))
    return nodes


def ball_on(softness: float, mu: float, nu: float) -> Problem:
    """Return the problem of a ball on a homogeneous solid, in units of its radius and the work of adhesion.

    Parameters
    ----------
    softness, mu, nu
        As for `strain_change`.
    """
    law = Section("lennard-jones-9-3", {"work_of_adhesion": 1.0, "z0": float(np.cbrt(softness)) ** 2 / mu})
    return Problem(Section("homogeneous", {"E": (1.0 - nu**2) / softness, "nu": nu}), Section("ball", {"R": 1.0}), law)
