"""Displacement and load of all equilibria of a problem, fast enough for a fit.

Paths of neighbouring problems are compared point by point: at equal shares of their lengths between landmarks, which
are start, the folds of the displacement, pull-off and end.

The dimensionless path of a power law depends on n, k and mu alone.  That of a sphere is a series, `fscm.force_curve`,
in the range of Tabor numbers of the series.  Any other is computed at Tabor numbers of a fixed grid, even in ln mu, and
between them it is the cubic through four neighbours.  So such a fit needs some ten paths, and the next curve of the
same punch often none.  The path of a problem that is no power law is linear in the fitted numbers, near those at which
it and its derivatives were computed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy

import fscm
from comparisons.model import Array, ComputationFailed
from comparisons.models.bradley import rigid_load
from comparisons.models.jkr import JKR
from comparisons.numerics.bounds import relative_difference
from comparisons.problem import Problem
from comparisons.runs.tasks import evaluate
from fscm.interpolation.coordinates import BOX
from fscm.interpolation.curve.pieces import LARGEST_LOAD
from fscm.interpolation.curve.series import SPHERE

#: Ratio of neighbouring Tabor numbers of the grid.  The load between them is within 1e-3 of the pull-off force of a
#: path of its own (measured worst 8e-4, n = 2, k = 0, mu = 4.7, at the fold of the approach), or 2e-3 where the
#: neighbours have other numbers of folds (n = 2, k = 0, mu = 23, on the part of the approach that no machine shows).
_RATIO = 1.25

#: Points of a path between two of its landmarks, and between two states that were computed.
_POINTS, _BETWEEN = 240, 8

#: Points of a series.  Measured: loads between them are within 1e-5 of the pull-off force.
_OF_SERIES = 1200

#: Ratio of the loads in units of w R at which paths end: a fit has two of them.  With fewer steps each curve of a map
#: has paths of its own; with an end at 1e4 for all, loads between Tabor numbers are up to twice as far off (measured at
#: nine problems, n from 1 to 5, mu from 0.1 to 45).
_ENDS = 100.0

#: Longest step between two states, and degrees: a spline needs fewer than a polygon.  Measured: loads are within 1e-3
#: of those of a path with a third of the step (eleven problems, n from 0.8 to 5, k up to 0.8, mu from 0.05 to 15).
_STEP, _TURN = 0.2, 30.0

#: Share of the pull-off force up to which surfaces before contact are as good as rigid.
_WEAK = 0.1

#: The JKR limit stands for the FSCM where its pull-off force is so near; its distance is in the budget.
_LIMIT = 2e-4

#: Tabor numbers at which that distance is computed; beyond, it falls at least as 1/mu (measured for n from 1 to 10, k
#: from 0 to 0.8: as mu^-1.29 at the slowest, n = 5, k = 0; two numbers, because it may change its sign near one).
_KNOWN = (10.0, 20.0)

#: A smaller Tabor number makes the force differ from that of rigid surfaces by less than 1e-3.
_LEAST_MU = 1e-3
#: In a larger load, in units of w R, adhesion is no more seen: the equilibria of any Tabor number are those of JKR,
#: which are those of Hertz but for a few pull-off forces (the root of the adhesion cancels at a given displacement).
_LARGEST_LOAD = 1e4
#: They differ by so many units of w R, and more below this Tabor number, where the range of the law is not small beside
#: the displacement (measured on paths to 2e4: 155 at mu = 0.01, 19 at 0.1, 6 at 1 and k = 0.4, 2 at k = 0).
_UNSEEN, _SHIFT = 10.0, 0.2

#: Farthest gap of the JKR limit, in units of its displacement at pull-off and of the range of the law.
_FAR = 100.0


class Equilibria(NamedTuple):
    """All equilibria, from far away into contact: displacement in m and load in N, each of shape (m,)."""

    displacement: Array
    load: Array


def by_fscm(problem: Problem, largest: float, exact: bool = False) -> Equilibria:
    """Return the equilibria of the full self-consistent model.

    Parameters
    ----------
    problem : Problem
        In physical units.
    largest : float
        The load in N that the path reaches.
    exact : bool
        Whether the path is computed for this problem alone, and is neither a series nor between Tabor numbers of the
        grid.

    Raises
    ------
    comparisons.model.ComputationFailed
        If there is no such path.
    """
    posed, units = problem.posed, problem.units
    if posed.mu < _LEAST_MU:
        raise ComputationFailed("a search does not need a contact as stiff")
    if exact:
        displacement, load = paths_alike([posed], _end(problem, largest))[0]
    elif has_series(problem, largest):
        curve = series_of(posed)
        displacement, load = curve.displacement, curve.load
    else:
        displacement, load = _between(posed, _end(problem, largest))
    return Equilibria(displacement * units["displacement"], load * units["load"])


def _end(problem: Problem, largest: float) -> float:
    """The power of `_ENDS` above a load in N, so that paths are shared: one step takes a tenth of a path more."""
    return float(_ENDS ** max(math.ceil(math.log(largest / problem.units["load"], _ENDS)), 1))


def has_series(problem: Problem, largest: float) -> bool:
    """Return whether the path to a load in N is known as a series that is good enough for a fit."""
    (_, most_k), (least_mu, most_mu) = BOX["k"], BOX["mu"]
    posed = problem.posed
    is_inside = posed.k <= most_k and least_mu <= posed.mu <= most_mu
    return posed.n == SPHERE and is_inside and _end(problem, largest) <= LARGEST_LOAD


@lru_cache(maxsize=256)
def series_of(problem: fscm.Problem) -> fscm.ForceCurve:
    """Return the curve of a dimensionless problem by its series."""
    return fscm.force_curve(problem.n, problem.k, problem.mu, points=_OF_SERIES)


def by_jkr(problem: Problem, largest: float) -> Equilibria:
    """Return those of JKR-n-k, the limit of large Tabor numbers, as `by_fscm`.

    Before the surfaces touch, which is at zero displacement, they attract each other as rigid ones do (Eq. 42).
    """
    units, force = problem.units, JKR().evaluate(problem, "pull_off_force").value
    curve = JKR().curve_to(problem, max(largest / units["load"], force))
    gap = np.geomspace(_FAR * abs(float(curve.displacement.min())) + _FAR, 1.0, _POINTS)
    attraction = rigid_load(problem.n, gap)
    weak = attraction > -_WEAK * force
    displacement = np.concatenate([-gap[weak], curve.displacement])
    load = np.concatenate([attraction[weak], curve.load])
    return Equilibria(displacement * units["displacement"], load * units["load"])


def distance_of_jkr(problem: Problem) -> float:
    """Return a bound on the relative distance of the pull-off forces of JKR and the FSCM; infinite if none is known."""
    posed = problem.posed
    numbers = _KNOWN if posed.mu >= _KNOWN[-1] else (posed.mu,)
    return max(mu / posed.mu * _distance(posed.n, posed.k, mu) for mu in numbers)


@lru_cache(maxsize=64)
def _distance(n: float, k: float, mu: float) -> float:
    posed = Problem.dimensionless(n=n, k=k, mu=mu)
    limit, force = (evaluate(model, "pull_off_force", posed).value for model in ("jkr", "fscm"))
    return math.inf if limit is None or force is None else abs(float(relative_difference(limit, force)))


def is_limit(problem: Problem) -> bool:
    """Return whether JKR is as good as the FSCM, whose paths take long at large Tabor numbers."""
    return problem.posed.mu > _KNOWN[-1] and distance_of_jkr(problem) < _LIMIT


def is_without_adhesion(problem: Problem, largest: float) -> bool:
    """Return whether adhesion is not seen in a load in N."""
    return largest > _LARGEST_LOAD * problem.units["load"]


def distance_of_hertz(problem: Problem, largest: float) -> float:
    """Return the relative error of a load in which adhesion is not seen, with a free zero of the displacement."""
    return _UNSEEN * (1.0 + _SHIFT / problem.posed.mu) * problem.units["load"] / largest


def paths_alike(problems: Sequence[fscm.Problem], end: float) -> list[Array]:
    """Return displacement and load of paths to a load, of as many points each, shape (2, m).

    Parameters
    ----------
    problems : sequence of fscm.Problem
        Dimensionless neighbours.
    end : float

    Raises
    ------
    comparisons.model.ComputationFailed
        If one of them has no path.
    """
    counts = {len(_folds(_fine(problem, end))) for problem in problems}
    # Paths with other numbers of folds have only those of approach and retreat in common, if all of them fold.
    common = counts.pop() if len(counts) == 1 else min(2, *counts)
    return [_resampled(problem, end, common) for problem in problems]


@lru_cache(maxsize=64)
def pull_off_force(n: float, k: float, mu: float) -> float:
    """Return the dimensionless pull-off force, to a few percent."""
    try:
        return -float(fscm.force_curve(n, k, mu).load.min())
    except fscm.OutsideAtlas:
        return float(evaluate("fscm", "pull_off_force", Problem.dimensionless(n=n, k=k, mu=mu)))


def _between(problem: fscm.Problem, end: float) -> Array:
    """Return the path between four Tabor numbers of the grid, shape (2, m)."""
    exponent = math.log(problem.mu, _RATIO)
    indices = [math.floor(exponent) + shift for shift in (-1, 0, 1, 2)]
    paths = paths_alike([replace(problem, mu=_RATIO**index) for index in indices], end)
    weights = [
        math.prod((exponent - other) / (index - other) for other in indices if other != index) for index in indices
    ]
    return np.asarray(np.tensordot(weights, paths, axes=1))


@lru_cache(maxsize=256)
def _fine(problem: fscm.Problem, end: float) -> Array:
    """Return a path that ends at a load, with points between its states by a spline, shape (2, m)."""
    try:
        traced = fscm.trace(problem, "quick", max_load=end, longest_step=_STEP, largest_turn=_TURN, with_bounds=False)
    except (fscm.NotConverged, ValueError) as error:
        raise ComputationFailed(f"the FSCM has no path for the values that were tried ({error})") from None
    path = np.array([traced.displacement, traced.load])
    length = _length(path, problem.mu)
    rising = np.concatenate([[True], np.diff(length) > 1e-9])
    path, length = path[:, rising], length[rising]
    fine = _with_points_between(length, path)
    beyond = int(np.argmin(fine[1])) + int(np.argmax(fine[1][int(np.argmin(fine[1])) :] >= end))
    share = (end - fine[1, beyond - 1]) / (fine[1, beyond] - fine[1, beyond - 1])
    last = fine[:, beyond - 1] + share * (fine[:, beyond] - fine[:, beyond - 1])
    return np.column_stack([fine[:, :beyond], last])


def _with_points_between(length: Array, path: Array) -> Array:
    """Return a path with points of a spline between its states, shape (2, m).

    All folds of the displacement are states: between two states where the spline has another one, the points are those
    of a curve without.
    """
    steps = np.arange(_BETWEEN) / _BETWEEN
    points = length[:-1, None] + np.diff(length)[:, None] * steps
    splines, others = (
        curve(points)
        for curve in (
            scipy.interpolate.CubicSpline(length, path.T),
            scipy.interpolate.PchipInterpolator(length, path.T),
        )
    )
    ends = np.concatenate([splines[:, :, 0], path[0, 1:, None]], axis=1)
    turns = np.any(np.diff(ends, axis=1) * np.diff(path[0])[:, None] <= 0.0, axis=1)
    splines[turns] = others[turns]
    return np.concatenate([splines.reshape(-1, 2), path.T[-1:]]).T


@lru_cache(maxsize=256)
def _resampled(problem: fscm.Problem, end: float, count: int) -> Array:
    """Return a path at equal shares of its length between landmarks, with a number of folds, shape (2, m)."""
    path = _fine(problem, end)
    length = _length(path, problem.mu)
    folds = _folds(path)
    if count < len(folds):
        folds = [folds[0], folds[-1]][:count]
    marks = sorted([_vertex(length, path[1], int(np.argmin(path[1]))), *(_vertex(length, path[0], i) for i in folds)])
    shares = np.linspace(0.0, 1.0, _POINTS)
    pieces = pairwise([length[0], *marks, length[-1]])
    points = np.concatenate([(a + (b - a) * shares)[int(a > 0.0) :] for a, b in pieces])
    return np.asarray(scipy.interpolate.CubicSpline(length, path.T)(points).T)


def _length(path: Array, mu: float) -> Array:
    """Length along a path in a plot that shows all of it, from the distance without load to compression."""
    scaled = np.arcsinh([path[0] / (1.0 + mu), path[1] / -path[1].min()])
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(scaled)))])


def _folds(path: Array) -> list[int]:
    """Numbers of the points at the folds of the displacement."""
    return [int(i) + 1 for i in np.flatnonzero(np.diff(np.diff(path[0]) > 0.0))]


def _vertex(length: Array, values: Array, i: int) -> float:
    """The length at which the parabola through three points is smallest or largest."""
    if not 0 < i < len(length) - 1:
        return float(length[i])
    curvature, slope, _ = np.polyfit(length[i - 1 : i + 2] - length[i], values[i - 1 : i + 2], 2)
    shift = -slope / (2.0 * curvature) if curvature else 0.0
    return float(np.clip(length[i] + shift, length[i - 1], length[i + 1]))
