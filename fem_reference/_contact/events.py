"""Points of the equilibrium path that an experiment sees, as roots of exact sensitivities.

The path is walked once; a sign change of dP, d(delta) or P between two neighbouring points brackets an event,
and Brent's method on the derivative from the bordered solve finds it to rounding.  Nothing is read off
samples.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from scipy.optimize import brentq

from fem_reference._contact.contact import Contact
from fem_reference._contact.path import Point, march, path
from fem_reference.errors import NoSuchEvent

__all__ = ["LOSSES", "QUANTITIES", "locate", "walk"]

ROOT_TOLERANCE = 1e-11
"""Relative tolerance of the parameter at an event; P is stationary there and delta moves by as little."""

QUANTITIES = (
    "pull_off_force",
    "pull_off_displacement",
    "jump_in_displacement",
    "jump_in_gap",
    "jump_out_displacement",
    "jump_out_gap",
    "zero_load_displacement",
    "hysteresis_energy",
)
"""What can be asked, in physical units; pull_off_force is the positive number -min P."""

LOSSES = ("jump_in_energy", "jump_out_energy")
"""What can be asked besides: the energies lost by the two jumps, which add up to that of the cycle.  Each needs
one contact edge only, so that a mesh that is fine at one radius gives it."""

Pair = tuple[Point, Point]


def walk(contact: Contact) -> list[Point]:
    """Walk the path until the load is compressive again and every fold lies behind.

    Parameters
    ----------
    contact : Contact
        The problem.
    """
    points: list[Point] = []
    summit = -float("inf")
    for point in path(contact):
        points.append(point)
        if point.leg.touching:
            settled = point.state.load > 0 and point.displacement_rate > 0 and point.load_rate > 0
            # After a jump-in, the contact branch at the displacement of the jump belongs to the cycle.
            if settled and point.state.displacement >= summit:
                break
        elif point.displacement_rate > 0:
            summit = max(summit, point.state.displacement)
    return points


def locate(points: Sequence[Point], quantity: str) -> tuple[float, Point]:
    """Find one quantity on a path.

    Parameters
    ----------
    points : sequence of Point
        As `walk` returns them.
    quantity : str
        One of `QUANTITIES` or `LOSSES`.

    Returns
    -------
    value : float
        In the units of the problem.
    point : Point
        Where it was read.

    Raises
    ------
    ValueError
        For an unknown quantity.
    NoSuchEvent
        If the path has no such point.
    """
    if quantity not in QUANTITIES + LOSSES:
        raise ValueError(f"quantity {quantity!r} is unknown; choose one of {', '.join(QUANTITIES + LOSSES)}")
    if quantity in ("pull_off_force", "pull_off_displacement"):
        point = pull_off(points)
        return (-point.state.load if quantity == "pull_off_force" else point.state.displacement), point
    if quantity == "zero_load_displacement":
        point = zero_load(points)
        return point.state.displacement, point
    if quantity == "hysteresis_energy":
        return hysteresis(points)
    if quantity == "jump_in_energy":
        return jump_in_loss(points)
    if quantity == "jump_out_energy":
        return jump_out_loss(points)
    jump_in, jump_out = folds(points)
    point = jump_in if quantity.startswith("jump_in") else jump_out
    return (point.state.central_gap if quantity.endswith("gap") else point.state.displacement), point


def _pairs(points: Sequence[Point], sign: Callable[[Point], float], rising: bool) -> list[Pair]:
    """Neighbours on one leg between which `sign` changes from negative to positive (or back)."""
    pairs = []
    for a, b in pairwise(points):
        if a.leg is not b.leg:
            continue
        before, after = (sign(a), sign(b)) if rising else (-sign(a), -sign(b))
        if before < 0 <= after:
            pairs.append((a, b))
    return pairs


def _root(pair: Pair, function: Callable[[Point], float]) -> Point:
    """Find the point between two neighbours where the function vanishes."""
    known = {pair[0].parameter: pair[0], pair[1].parameter: pair[1]}

    def value(parameter: float) -> float:
        if parameter not in known:
            nearest = min(known.values(), key=lambda p: abs(p.parameter - parameter))
            step = parameter - nearest.parameter
            *_, known[parameter] = march(nearest, step, parameter)
        return function(known[parameter])

    scale = max(abs(pair[0].parameter), abs(pair[1].parameter))
    root = float(
        brentq(value, pair[0].parameter, pair[1].parameter, xtol=ROOT_TOLERANCE * scale, rtol=4 * ROOT_TOLERANCE)
    )
    value(root)
    return known[root]


def pull_off(points: Sequence[Point]) -> Point:
    """Return the deepest minimum of the load along the path.

    Raises
    ------
    NoSuchEvent
        If the load has no minimum on the path.
    """
    minima = [_root(pair, lambda p: p.load_rate) for pair in _pairs(points, lambda p: p.load_rate, True)]
    if not minima:
        raise NoSuchEvent("the load has no minimum along the path")
    return min(minima, key=lambda p: p.state.load)


def folds(points: Sequence[Point]) -> Pair:
    """Return the folds of displacement control: jump into contact and jump out of it.

    Raises
    ------
    NoSuchEvent
        If the displacement never turns back.

    Examples
    --------
    >>> folds([])
    Traceback (most recent call last):
    fem_reference.errors.NoSuchEvent: the displacement rises all along the path: this solid is too stiff for jumps
    """
    maxima = _pairs(points, lambda p: p.displacement_rate, False)
    minima = _pairs(points, lambda p: p.displacement_rate, True)
    if not maxima or not minima:
        raise NoSuchEvent("the displacement rises all along the path: this solid is too stiff for jumps")
    tops = [_root(pair, lambda p: p.displacement_rate) for pair in maxima]
    bottoms = [_root(pair, lambda p: p.displacement_rate) for pair in minima]
    return tops[0], min(bottoms, key=lambda p: p.state.displacement)


def zero_load(points: Sequence[Point]) -> Point:
    """Return the point in contact where the load changes from tension to compression."""
    pairs = _pairs(points, lambda p: p.state.load, True)
    if not pairs:
        raise NoSuchEvent("the load does not become compressive on the path")
    return _root(pairs[-1], lambda p: p.state.load)


def hysteresis(points: Sequence[Point]) -> tuple[float, Point]:
    """Return the energy lost by the jumps of one cycle of displacement control, and the jump-out."""
    jump_out, point = jump_out_loss(points)
    return jump_in_loss(points)[0] + jump_out, point


def jump_in_loss(points: Sequence[Point]) -> tuple[float, Point]:
    """Return the energy lost by the jump into contact, and the point in contact where it lands."""
    start = folds(points)[0]
    end = _at_displacement(points, start.state.displacement, last=True)
    return _energy(start) - _energy(end), end


def jump_out_loss(points: Sequence[Point]) -> tuple[float, Point]:
    """Return the energy lost by the jump out of contact, and the point where it begins."""
    start = folds(points)[1]
    end = _at_displacement(points, start.state.displacement, last=False)
    return _energy(start) - _energy(end), start


def _energy(point: Point) -> float:
    return point.leg.contact.energy(point.state.y)


def _at_displacement(points: Sequence[Point], delta: float, last: bool) -> Point:
    """Return the first or the last point of the path at a displacement."""
    pairs = _pairs(points, lambda p: p.state.displacement - delta, True)
    if not pairs:
        raise NoSuchEvent(f"the path does not reach the displacement {delta:.6g} on both branches")
    return _root(pairs[-1 if last else 0], lambda p: p.state.displacement - delta)
