"""Nodes of the force curves: paths of the model, sampled at the positions of each piece."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BarycentricInterpolator, CubicSpline
from scipy.optimize import brentq

from fscm._path.arc_length import Point, rates_of
from fscm._path.continuation import moved
from fscm._path.whole_path import path_by_any_mesh
from fscm._surface.state import Rates, State
from fscm._threads import one_thread
from fscm._typing import Array
from fscm.accuracy import Meshes
from fscm.errors import Failure, NotConverged
from fscm.interpolation.builder.design import Node, rounded, sobol
from fscm.interpolation.coordinates import BOX
from fscm.interpolation.curve.pieces import CONTACT_GAP, LARGEST_LOAD, States, forms_of, gap_at, load_unit, rigid_load
from fscm.interpolation.curve.series import SPHERE

__all__ = ["POINTS", "NodePath", "curve_nodes", "solve_nodes", "solved_nodes", "traced", "values_at_positions"]

#: Number of spheres; shape indices and numbers of punches on homogeneous solids; seeds of the Sobol sequences.
_SPHERES, _HOMOGENEOUS, _SPHERE_SEED, _OTHER_SEED = 256, ((2.0, 64), (1.0, 40)), 20261128, 20261129
#: Nodes are dense in ln mu about this Tabor number, over this distance.
_CENTRE, _WIDTH = 0.9, 0.8
#: Accuracy of the nodes, longest step of their paths, largest number of points.
_ACCURACY, _STEP, _MOST = 1e-6, 0.2, 5000
#: Positions of each piece at which a path is sampled.
POINTS = {"approach": 36, "contact": 80, "compression": 16}
#: States between the gap of the largest tension and the first one whose mesh follows the edge.
_BEGIN = 6
#: Points of the curve between two states of the path, and of its beginning.
_BETWEEN, _BEGINNING = 12, 40
#: Neighbours of a local polynomial, whose derivatives are known: degree 7.
_NEIGHBOURS = 4
#: A state that lies farther from its neighbours on the path belongs to another solution of a mesh that is too coarse:
#: in shares of their differences, and in 1 + mu.
_STRAY, _ROUGH = 0.1, 1e-3


class NodePath(NamedTuple):
    """States of a path.

    Attributes
    ----------
    approach : ndarray, shape (36, 3)
        Central gap, displacement and load at the positions of the approach.
    beginning : ndarray, shape (6, 4)
        The same and the contact radius at Chebyshev points of the gap, from `CONTACT_GAP`.
    contact : ndarray, shape (m, 7)
        Central gap, displacement, load, contact radius, and derivatives of the first three over the logarithm of the
        last.
    """

    approach: Array
    beginning: Array
    contact: Array


def chebyshev_positions(count: int) -> Array:
    """Chebyshev points from -1 to 1."""
    return np.asarray(-np.cos((np.arange(count) + 0.5) * np.pi / count))


def curve_nodes(others: int) -> list[Node]:
    """Parameters of nodes with the density of Chebyshev nodes: spheres, homogeneous spheres and cones, and others.

    Examples
    --------
    >>> len(curve_nodes(0)), curve_nodes(1)[-1][0] == 2.0
    (360, False)
    """
    plane, cube = sobol(2, _SPHERES, _SPHERE_SEED), sobol(3, max(others, 1), _OTHER_SEED)[:others]
    nodes = [(SPHERE, u * BOX["k"][1], v) for u, v in np.column_stack([_arc(plane[:, 0]), plane[:, 1]]).tolist()]
    nodes += [(n, 0.0, (i + 0.5) / count) for n, count in _HOMOGENEOUS for i in range(count)]
    (least_n, most_n), (_, most_k) = BOX["n"], BOX["k"]
    of_n, of_k = 1.0 / (1.0 / most_n + (1.0 / least_n - 1.0 / most_n) * _arc(cube[:, 0])), most_k * _arc(cube[:, 1])
    nodes += zip(of_n.tolist(), of_k.tolist(), cube[:, 2].tolist(), strict=True)
    n, k, share = np.array(nodes).T
    low, high = (math.asinh(math.log(end / _CENTRE) / _WIDTH) for end in BOX["mu"])
    mu = _CENTRE * np.exp(_WIDTH * np.sinh(low + (high - low) * _arc(share)))
    return list(zip(*(rounded(*each).tolist() for each in (("n", n), ("k", k), ("mu", mu))), strict=True))


def _arc(share: Array) -> Array:
    """Shares of a range with the density of Chebyshev nodes."""
    return 0.5 * (1.0 - np.cos(np.pi * share))


def solve_nodes(nodes: list[Node], path: Path) -> None:
    """Trace the nodes that a file does not have, and append them one by one."""
    known = {node for node, _ in solved_nodes(path)} if path.exists() else set()
    for node in nodes:
        if node not in known:
            try:
                traced_path = traced(*node)
            except NotConverged as error:
                print(f"no path at n, k, mu = {node}: {error}")
                continue
            with path.open("ab") as file:
                pickle.dump((node, tuple(traced_path)), file)


def solved_nodes(path: Path) -> Iterator[tuple[Node, NodePath]]:
    """Nodes and paths of a file that `solve_nodes` wrote."""
    with path.open("rb") as file:
        while True:
            try:
                node, parts = pickle.load(file)
            except EOFError:
                return
            yield node, NodePath(*parts)


@one_thread()
def traced(n: float, k: float, mu: float) -> NodePath:
    """The path of a problem.

    Raises
    ------
    NotConverged
        Also if a state between those of the path is not the one of the path.
    """
    from fscm.problem import Problem

    problem, meshes = Problem(n=n, k=k, mu=mu).dimensionless, Meshes.of(_ACCURACY)

    def ending() -> Callable[[State], bool]:
        return lambda state: state.anchor.in_contact and state.load > LARGEST_LOAD

    points = path_by_any_mesh(
        problem, [meshes.curve], ending, "its end", _MOST, _STEP, 10.0 + 5.0 * mu, meshes.end_height, complete=list
    )
    before = _Before([point for point in points if not point.state.anchor.in_contact], mu)
    gaps = gap_at(np.array(mu), chebyshev_positions(POINTS["approach"]))
    approach = [(gap, state.displacement, state.load) for gap in gaps for state in [before.at(float(gap))]]
    last = before.points[-1].state
    shares = 0.5 * (1.0 - np.cos(np.pi * np.linspace(0.0, 1.0, _BEGIN)))
    beginning: list[tuple[float, ...]] = []
    for gap in CONTACT_GAP + (last.central_gap - CONTACT_GAP) * shares:
        state = last if gap == last.central_gap else before.at(float(gap))
        beginning.append((gap, state.displacement, state.load, _edge(state) if beginning else 0.0))
    contact = [_in_contact(point) for point in points if point.state.anchor.in_contact]
    return NodePath(np.array(approach), np.array(beginning), np.array(contact))


class _Before:
    """States of a path before the mesh follows the edge."""

    def __init__(self, points: list[Point], mu: float) -> None:
        self.points, self._mu = points, mu
        self._gaps = np.array([point.state.central_gap for point in points])

    def at(self, gap: float) -> State:
        """The state at a central gap."""
        nearest = np.argsort(np.abs(self._gaps - gap))[:4]
        for depth in (0, 2, 4):
            for number in nearest:
                point = self.points[number]
                try:
                    state = _by_halves(point.state, point.rates, gap, depth)
                except NotConverged:
                    continue
                if self._is_of_the_path(gap, state):
                    return state
        raise NotConverged(f"no state of the path at the central gap {gap:g}", Failure.STEP)

    def _is_of_the_path(self, gap: float, state: State) -> bool:
        number = min(max(int(np.searchsorted(-self._gaps, -gap)), 1), len(self._gaps) - 1)
        a, b = self.points[number - 1], self.points[number]
        width = b.state.central_gap - a.state.central_gap
        h = (gap - a.state.central_gap) / width
        for name in ("displacement", "load"):
            start, end = getattr(a.state, name), getattr(b.state, name)
            rises = [width * getattr(p.rates, name) / p.rates.central_gap for p in (a, b)]
            expected = start * (1.0 + 2.0 * h) * (1.0 - h) ** 2 + end * h * h * (3.0 - 2.0 * h)
            expected += h * (1.0 - h) * (rises[0] * (1.0 - h) - rises[1] * h)
            room = _STRAY * (abs(end - start) + abs(rises[0]) + abs(rises[1])) + _ROUGH * (1.0 + self._mu)
            if abs(getattr(state, name) - expected) > room:
                return False
        return True


def _by_halves(state: State, rates: Rates, gap: float, depth: int) -> State:
    """The state at a central gap, perhaps by steps of half the way."""
    try:
        return moved(state, rates, gap)
    except NotConverged:
        if depth == 0:
            raise
    middle = _by_halves(state, rates, 0.5 * (state.central_gap + gap), depth - 1)
    return _by_halves(middle, rates_of(middle), gap, depth - 1)


def _edge(state: State) -> float:
    """Radius at which the gap is the one of the largest tension; nan if the mesh does not resolve it."""
    mesh = state.disc.mesh
    inside = np.flatnonzero(state.gap < CONTACT_GAP)
    if not inside.size:
        return math.nan

    def excess(s: float) -> float:
        return float(mesh.evaluate(state.gap, np.array([s]))[0]) - CONTACT_GAP

    return state.scale * float(brentq(excess, *mesh.nodes[inside[-1] : inside[-1] + 2]))


def _in_contact(point: Point) -> tuple[float, ...]:
    state, rates = point.state, point.rates
    slopes = (rate / rates.log_scale for rate in (rates.central_gap, rates.displacement, rates.load))
    return (state.central_gap, state.displacement, state.load, state.scale, *slopes)


def values_at_positions(n: float, mu: float, path: NodePath) -> dict[str, Array]:
    """Components of each piece at the Chebyshev points of its position, shape (components, points)."""
    gap, displacement, load = path.approach.T
    approach = np.array([(displacement + gap) / (1.0 + mu), load / np.real(rigid_load(np.array(n), gap))])
    unit = float(np.real(load_unit(np.array(n), np.array(mu))))
    gap, states = _curve_in_contact(path)
    forms = np.array(forms_of(mu, unit, states))
    loads = np.real(states.load)
    # A few points more than the piece, so that its end is inside.
    last = int(np.flatnonzero(loads < unit)[-1]) + 8
    space = np.column_stack([forms[0], forms[1], gap])[:last]
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(space, axis=0), axis=1))])
    along = CubicSpline(length, forms[:, :last].T)
    end = brentq(lambda x: float(along(x)[1]) - math.asinh(1.0), length[-16], length[-1])
    contact = along(end * 0.5 * (chebyshev_positions(POINTS["contact"]) + 1.0)).T
    first = max(int(np.argmin(loads)) + 1, int(np.flatnonzero(loads > 0.5 * unit)[0]))
    over_load = CubicSpline(np.log(loads[first:]), forms[::2, first:].T)
    ends = math.log(unit), math.log(LARGEST_LOAD)
    positions = chebyshev_positions(POINTS["compression"])
    compression = over_load(ends[0] + (ends[1] - ends[0]) * 0.5 * (positions + 1.0)).T
    return {"approach": approach, "contact": contact, "compression": compression}


def _curve_in_contact(path: NodePath) -> tuple[Array, States]:
    """Central gaps and states at many points from `CONTACT_GAP` on."""
    gap, displacement, load, radius = path.beginning[np.isfinite(path.beginning[:, 3])].T
    shares = np.linspace(0.0, 1.0, _BEGINNING + 1)[:-1]
    numbers = np.column_stack([displacement, load, radius**2])
    beginning = BarycentricInterpolator((gap - gap[0]) / (gap[-1] - gap[0]), numbers)(shares)
    # Where the path changes its mesh or its parameter, a state is there twice.
    grows = np.concatenate([[True], np.diff(path.contact[:, 3]) > 1e-9 * path.contact[1:, 3]])
    contact = path.contact[grows]
    log_radius, values, slopes = np.log(contact[:, 3]), contact[:, :3], contact[:, 4:]
    shares_between = np.arange(_BETWEEN) / _BETWEEN
    points, between = [], []
    for i in range(len(log_radius) - 1):
        low = min(max(i + 1 - _NEIGHBOURS // 2, 0), len(log_radius) - _NEIGHBOURS)
        near = slice(low, low + _NEIGHBOURS)
        at = log_radius[i] + (log_radius[i + 1] - log_radius[i]) * shares_between
        points.append(at)
        between.append(_hermite(log_radius[near], values[near], slopes[near], at))
    after = np.concatenate([*between, values[-1:]])
    radii = np.exp(np.concatenate([*points, log_radius[-1:]]))
    gaps = np.concatenate([gap[0] + (gap[-1] - gap[0]) * shares, after[:, 0]])
    squares = np.maximum(beginning[:, 2], 0.0)
    states = States(
        np.concatenate([beginning[:, 0], after[:, 1]]),
        np.concatenate([beginning[:, 1], after[:, 2]]),
        np.concatenate([np.sqrt(squares), radii]),
    )
    return gaps, states


def _hermite(x: Array, values: Array, slopes: Array, at: Array) -> Array:
    """The polynomial with these values and slopes, by divided differences."""
    nodes, count = np.repeat(x, 2), 2 * len(x)
    column = np.repeat(values, 2, axis=0)
    coefficients = [column[0]]
    for order in range(1, count):
        widths = nodes[order:] - nodes[:-order]
        same = widths == 0.0
        quotients = np.diff(column, axis=0) / np.where(same, 1.0, widths)[:, None]
        column = np.where(same[:, None], np.repeat(slopes, 2, axis=0)[: len(widths)], quotients)
        coefficients.append(column[0])
    result = np.tile(coefficients[-1], (len(at), 1))
    for order in range(count - 2, -1, -1):
        result = result * (at - nodes[order])[:, None] + coefficients[order]
    return result
