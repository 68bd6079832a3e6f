"""Functions that the figures of the paper call: results of models, and what only `fscm` has, as JSON.

A refusal or failure of a model is a result here: a figure leaves the point out or writes its status, and the other
points are not lost.  Bounds on numerical errors are named ``u_...``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from itertools import product
from operator import attrgetter
from typing import Any, cast

import numpy as np
from scipy.optimize import brentq

import fscm
from comparisons.model import FARTHEST_GAP, Array, ComputationFailed, HasCurve, HasProfile, NotApplicable, translated
from comparisons.models.cohesive_models import MaugisDugdaleImproved, MaugisDugdaleOriginal
from comparisons.models.gibson_limit import gibson_profile
from comparisons.problem import Problem
from comparisons.registry import create
from comparisons.runs.tasks import Task, evaluate_task
from fscm import Analysis, solve
from fscm import Problem as FscmProblem
from fscm.laws import LennardJones
from fscm.solution import FLOOR, SAFETY, State

Json = dict[str, Any]
#: Displacement, radii, and columns over them with their bounds.
_Surface = tuple[float, Array, dict[str, Array], dict[str, Array]]

#: Shape indices of the paper.
SHAPES = (1.0, 1.5, 2.0, 5.0)
#: Gradient exponents of the paper.
GRADIENTS = (0.0, 0.2, 0.4, 0.6)
#: The Maugis-Dugdale models, by name.
COHESIVE = {model.name: model for model in (MaugisDugdaleOriginal(), MaugisDugdaleImproved())}
#: The 9-3 law, dimensionless.
TRACTION = LennardJones().traction
_PEAK = float(LennardJones().peak_gap)
#: Quantities at both jumps.
JUMPS = ("jump_in_displacement", "jump_in_gap", "jump_out_displacement", "jump_out_gap")
#: Excesses over the critical Tabor number: the gaps of the two jumps part like their square root.
EXCESSES = (1e-4, 1e-3, 4e-3, 1e-2, 2e-2, 4e-2, 7e-2, 0.12)
#: Radii of a surface: everywhere, and around the cohesive edge, whose width is a small part of its radius.
_FARTHEST, _STEPS = 6.0, 240
_AROUND_EDGE = np.concatenate([-np.geomspace(0.3, 1e-3, 40), [0.0], np.geomspace(1e-3, 0.3, 40)])


def _with_status(function: Callable[..., Json]) -> Callable[..., Json]:
    """Add ``status`` and ``reason`` to what a function returns; without a result they stand alone."""

    @wraps(function)
    def result(*arguments: Any) -> Json:
        try:
            returned = function(*arguments)
            # The names that it returns come first.
            return returned | {"status": "ok", "reason": ""} | returned
        except NotApplicable as refusal:
            return {"status": "not-applicable", "reason": str(refusal)}
        except (ComputationFailed, ValueError) as failure:
            return {"status": "failed", "reason": str(failure)}

    return result


@_with_status
def quantity(model: str, quantity: str, n: float, k: float, mu: float) -> Json:
    """Evaluate a quantity by a model.

    Parameters
    ----------
    model, quantity : str
        As in `comparisons.registry.MODELS` and `comparisons.quantities.QUANTITIES`.
    n, k, mu : float
        The case, dimensionless.

    Returns
    -------
    dict
        ``value`` and ``u_num`` (float, or None without a result), ``status`` ("ok", "not-applicable" or "failed")
        and ``reason`` (a sentence, empty if ok).

    Examples
    --------
    >>> quantity("bradley", "pull_off_force", 2, 0.4, 1)["value"]
    2.0
    >>> quantity("bradley", "jump_in_gap", 2, 0.4, 1)["status"]
    'not-applicable'
    """
    row = evaluate_task(Task(model, quantity, Problem.dimensionless(n, k, mu)))
    return {name: getattr(row, name) for name in ("value", "u_num", "status", "reason")}


@_with_status
def curve(model: str, n: float, k: float, mu: float) -> Json:
    """Trace the force-displacement curve of a model, from far away into contact.

    Returns
    -------
    dict
        ``status`` and ``reason`` as of `quantity`; if ok also ``displacement`` and ``load`` (lists of floats),
        ``u_displacement`` and ``u_load`` (bounds on the numerical error of each), and what else the model has at each
        point, as ``central_gap`` (lists, None where it is not defined).

    Examples
    --------
    >>> path = curve("jkr", 2, 0.4, 1)
    >>> path["status"], path["displacement"][0], len(path["contact_radius"]) == len(path["load"])
    ('ok', 0.0, True)
    """
    path = cast(HasCurve, create(model)).curve(Problem.dimensionless(n, k, mu))
    return {
        "displacement": _numbers(path.displacement),
        "load": _numbers(path.load),
        "u_displacement": path.u_distance * float(np.ptp(path.displacement)),
        "u_load": path.u_distance * float(np.ptp(path.load)),
        **{name: _numbers(values) for name, values in path.columns.items()},
    }


@_with_status
def profile(model: str, n: float, k: float, mu: float) -> Json:
    """Return the surface of a model where P is smallest, out to the gap `FARTHEST_GAP`.

    Returns
    -------
    dict
        ``status`` and ``reason`` as of `quantity`; if ok also ``radius``, ``pressure`` and ``gap`` (lists of floats,
        radii increasing) and ``u_distance``, a bound on the distance of the pressure curve from the exact one as a
        fraction of its ranges.

    Examples
    --------
    >>> profile("bradley", 2, 0.4, 1)["reason"]
    'bradley has no profile at pull-off'
    """
    tracing = create(model)
    if not isinstance(tracing, HasProfile):
        raise NotApplicable(f"{model} has no profile at pull-off")
    shape = tracing.pull_off_profile(Problem.dimensionless(n, k, mu))
    inside = shape.gap <= FARTHEST_GAP
    columns = {name: _numbers(getattr(shape, name)[inside]) for name in ("radius", "pressure", "gap")}
    return columns | {"u_distance": float(shape.u_distance)}


def _numbers(values: Array) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]


def cohesive_surface(model: str, n: float, k: float, mu: float) -> Json:
    """Return the surface of a Maugis-Dugdale model at pull-off.

    Returns
    -------
    dict
        ``contact_radius`` and ``cohesive_radius`` (a and c), ``displacement``; ``radius``, ``pressure``, ``gap`` as
        lists, in barred variables.

    Raises
    ------
    NotApplicable
        Where the cohesive zone has no width.

    Examples
    --------
    >>> zone = cohesive_surface("md-improved", 2, 0.4, 1)
    >>> round(zone["contact_radius"], 3), round(zone["cohesive_radius"], 3)
    (1.264, 2.054)
    """
    zone = COHESIVE[model].pull_off_profile(Problem.dimensionless(n, k, mu), points=200)
    numbers = {name: getattr(zone, name) for name in ("contact_radius", "cohesive_radius", "displacement")}
    return numbers | {name: getattr(zone, name).tolist() for name in ("radius", "pressure", "gap")}


@contextmanager
def analysed(n: float, k: float, mu: float) -> Iterator[Analysis]:
    """Analyse a problem; the solver's exceptions become `NotApplicable` and `ComputationFailed`."""
    with translated(fscm):
        yield Analysis(FscmProblem(n, k, mu))


def bound(difference: Any, value: Any) -> Any:
    """Bound on the error of a value from its difference between two meshes."""
    return SAFETY * np.abs(difference) + FLOOR * (1.0 + np.abs(value))


def named_points(n: float, k: float, mu: float) -> dict[str, dict[str, float]]:
    """Return central gap, displacement and load of B', A, B, A', C and D (Fig. 3b), each with its uncertainty.

    A and B are the jump-in and the jump-out, A' and B' where these land under displacement control, C is the
    pull-off and D the zero of the load.

    Raises
    ------
    comparisons.model.NotApplicable
        Below the critical Tabor number, where nothing jumps.
    comparisons.model.ComputationFailed
        If a point was not reached.

    Examples
    --------
    >>> points = named_points(2, 0.4, 1)
    >>> fall = points["A"]["displacement"] - points["A'"]["displacement"]
    >>> abs(fall) < 1e-9, round(points["C"]["load"], 8)
    (True, -1.78848171)
    """
    with analysed(n, k, mu) as analysis:
        pairs = {
            "B'": analysis.landing("jump_out"),
            "A": analysis.event("jump_in"),
            "B": analysis.event("jump_out"),
            "A'": analysis.landing("jump_in"),
            "C": analysis.event("pull_off"),
            "D": analysis.event("zero_load"),
        }
    points: dict[str, dict[str, float]] = {name: {} for name in pairs}
    for (name, pair), coordinate in product(pairs.items(), ("central_gap", "displacement", "load")):
        of = attrgetter(coordinate)
        value = float(of(pair.value))
        points[name] |= {coordinate: value, f"u_{coordinate}": float(bound(pair.difference(of), value))}
    return points


def jumps(n: float, k: float, mu: float) -> dict[str, float]:
    """Return the displacement and the central gap at both jumps, by quantity, each with its ``u_``.

    Raises
    ------
    comparisons.model.NotApplicable
        Below the critical Tabor number.
    comparisons.model.ComputationFailed
        If a fold was not reached.

    Examples
    --------
    >>> at_jumps = jumps(2, 0.4, 1)
    >>> at_jumps["jump_out_displacement"] < at_jumps["jump_in_displacement"] < 0
    True
    """
    with analysed(n, k, mu) as analysis:
        solutions = {name: analysis.solution(name) for name in JUMPS}
    return {
        f"{u}{name}": float(getattr(solution, of))
        for name, solution in solutions.items()
        for u, of in (("", "value"), ("u_", "u_num"))
    }


def near_critical(n: float, k: float) -> Json:
    """Return the critical Tabor number, ``mu`` and ``u_mu``, and ``jumps`` just above it, each with its ``mu``.

    Raises
    ------
    comparisons.model.NotApplicable, comparisons.model.ComputationFailed
        As `jumps`.
    """
    with translated(fscm):
        critical = solve(FscmProblem(n, k, 1.0), "critical_tabor_number")
    above = [float(critical.value) * (1.0 + excess) for excess in EXCESSES]
    at_jumps = [{"mu": mu} | jumps(n, k, mu) for mu in above]
    return {"mu": float(critical.value), "u_mu": float(critical.u_num), "jumps": at_jumps}


def surface(n: float, k: float, mu: float) -> Json:
    """Return the surface where P is smallest, for radii up to 6.

    Returns
    -------
    dict
        ``displacement``; lists over the ``radius``: ``gap``, ``pressure`` (tension negative), ``deformation`` w (Eq. 4;
        positive where the surface is pressed down), each with ``u_``, the bound on its numerical error.

    Raises
    ------
    comparisons.model.ComputationFailed
        If the pull-off was not found.

    Examples
    --------
    >>> round(min(surface(2, 0.4, 1)["pressure"]), 3)          # the strength of the surface law
    -1.026
    """
    displacement, radius, value, bounds = (_gibson_surface if k == 1.0 else _graded_surface)(n, k, mu)
    columns: Json = {"displacement": float(displacement), "radius": radius.tolist()}
    for name, array in value.items():
        columns |= {name: array.tolist(), f"u_{name}": bounds[name].tolist()}
    return columns


def _graded_surface(n: float, k: float, mu: float) -> _Surface:
    with analysed(n, k, mu) as analysis:
        event = analysis.event("pull_off")
    edge = event.value.scale if event.value.anchor.in_contact else 1.0
    radius = np.unique(np.concatenate([np.linspace(0.0, _FARTHEST, _STEPS + 1), edge * (1.0 + _AROUND_EDGE)]))
    check, value = _sampled(event.check, radius), _sampled(event.value, radius)
    bounds = {name: bound(values - check[name], values) for name, values in value.items()}
    return event.value.displacement, radius, value, bounds


def _sampled(state: State, radius: Array) -> dict[str, Array]:
    gap, deformation = (
        state.disc.mesh.evaluate(values, radius / state.scale) for values in (state.gap, state.deformation)
    )
    return {"gap": gap, "pressure": state.disc.problem.law.traction(gap), "deformation": deformation}


def _gibson_surface(n: float, k: float, mu: float) -> _Surface:
    """The surface at k = 1, algebra at every point: its error is that of the displacement."""
    problem = FscmProblem(n, k, mu)
    profile, pull_off = gibson_profile(problem), solve(problem, "pull_off_displacement")
    inside = profile.radius <= _FARTHEST
    pressure = profile.pressure[inside]
    value = {"gap": profile.gap[inside], "pressure": pressure, "deformation": problem.compliance * pressure}
    # Along the surface gap and pressure are exact functions of each other; only the radius carries an error.
    u = (1.0 + problem.compliance) * pull_off.u_num
    bounds = {name: u + bound(0.0, values) for name, values in value.items()}
    return pull_off.value, profile.radius[inside], value, bounds


def half_strength_gaps() -> tuple[float, float]:
    """Return the two gaps where the tension of the 9-3 law is half of its strength.

    Examples
    --------
    >>> [round(gap, 4) for gap in half_strength_gaps()]
    [0.0417, 0.7085]
    """

    def excess(gap: float) -> float:
        return float(TRACTION(np.array(gap)) - 0.5 * TRACTION(np.array(_PEAK)))

    return float(brentq(excess, 0.0, _PEAK, xtol=1e-15)), float(brentq(excess, _PEAK, 5.0, xtol=1e-15))


def band_width(n: float, k: float, mu: float) -> dict[str, float]:
    """Return the width of the band at pull-off where the tension is above half of the strength, over its radius.

    Returns
    -------
    dict
        ``width`` and its bound ``u``, a fraction of the radius where the tension is largest.

    Raises
    ------
    comparisons.model.ComputationFailed
        If the pull-off was not found.

    Examples
    --------
    >>> band = band_width(2, 0.4, 1)
    >>> 0.2 < band["width"] < 0.3, band["u"] < 1e-6
    (True, True)
    """
    with analysed(n, k, mu) as analysis:
        event = analysis.event("pull_off")
    check, value = _width(event.check), _width(event.value)
    return {"width": value, "u": SAFETY * abs(value - check) + FLOOR}


def _width(state: State) -> float:
    """Width in the plane of radius and gap, between roots of the interpolated gap."""

    def radius_of(gap: float) -> float:
        def excess(radius: float) -> float:
            return float(state.disc.mesh.evaluate(state.gap, np.array([radius / state.scale]))[0]) - gap

        return float(brentq(excess, 0.0, float(state.radius[-1]), xtol=1e-14))

    inner, far = (radius_of(gap) for gap in half_strength_gaps())
    return (far - inner) / radius_of(_PEAK)
