"""What all models assume: small slopes, small strains, a paraboloid for a sphere; how well it holds, and its error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.description.forces import change_of
from comparisons.description.strain_errors import strain_change
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.fscm_model import FullSelfConsistent
from comparisons.models.jkr_sphere import LARGEST_CONTACT
from comparisons.problem import Problem, Section
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

Json = dict[str, Any]

#: Largest slope and strain that count as small: their squares, which linear theory leaves out, are 1 %.
SMALL = 0.1

#: The edge of the contact is where the tension is above this share of its largest value.
_EDGE = 0.5

#: Kinds of punches that are spheres: the paraboloid of the tip, and the exact one.
_PARABOLOID, _BALL = "sphere", "ball"


def _error(change: tuple[float, float] | None, reason: str = "", *, is_estimate: bool = False) -> Json:
    """A relative change with its uncertainty, and whether both are estimates; or the reason why it is unknown."""
    error, u = change or (None, None)
    return {"error": error, "u_num": u, "reason": "" if change else reason, "is_estimate": is_estimate}


def _product(changes: Sequence[Json]) -> Json:
    """Error of several relative changes after each other; unknown where one of them is, an estimate where one is."""
    total, u = 1.0, 0.0
    for change in changes:
        if change["error"] is None:
            return _error(None, change["reason"])
        factor = 1.0 + change["error"]
        total, u = total * factor, u * abs(factor) + abs(total) * change["u_num"]
    return _error((total - 1.0, u), is_estimate=any(change.get("is_estimate", False) for change in changes))


def assumptions(problem: Problem, force: Row, by_solution: bool = False) -> Json | None:
    """Return how far the assumptions of all models hold at pull-off, and their error in the pull-off force.

    Parameters
    ----------
    problem : Problem
        In physical units.
    force : Row
        Its pull-off force.
    by_solution : bool
        Whether the problem is solved with finite strain, and not only looked up.

    Returns
    -------
    dict or None
        ``measures`` of the equilibrium at pull-off, each with ``key``, ``value``, ``limit`` and ``meaning``, and
        ``contact_radius`` in m, where the tension is largest.  ``geometry``, ``strain`` and ``total`` have ``error``,
        ``u_num``, ``reason`` and ``is_estimate``: relative errors of the force of small strains against that of a
        neo-Hookean solid and the exact shape, without friction; None where they are unknown.  ``is_estimate`` is true
        where they are extrapolated from other problems: ``u_num`` is then no bound.  ``recommendable`` is false where
        the contact is larger than the sphere, ``by_solution`` the argument.  None where there is no pull-off force.
    """
    if force.value is None:
        return None
    try:
        measures = _measures(problem)
    except (NotApplicable, ComputationFailed):
        return None
    is_sphere = problem.punch.kind in (_PARABOLOID, _BALL)
    is_too_large = is_sphere and measures["contact_radius"] > LARGEST_CONTACT * problem.punch["R"]
    if is_too_large:
        geometry = strain = _error(None, "the contact is larger than the sphere")
    else:
        geometry, strain = _error((0.0, 0.0)), _strain(problem, by_solution)
        if problem.punch.kind == _PARABOLOID:
            ball = evaluate("fscm", "pull_off_force", _exact(problem))
            geometry = _error(change_of(force, ball), ball.reason)
    return {
        **measures,
        "geometry": geometry,
        "strain": strain,
        "total": _product((geometry, strain)),
        "recommendable": not is_too_large,
        "by_solution": by_solution,
    }


def _measures(problem: Problem) -> Json:
    """Contact radius and slopes at pull-off, by the FSCM."""
    surface = FullSelfConsistent().pull_off_profile(problem)
    radius, gap, tension = surface.radius, surface.gap, -surface.pressure
    edge = int(np.argmax(tension))
    near_edge = tension > _EDGE * tension[edge]
    slope_of_gap = np.gradient(gap, radius)
    slope_of_punch = problem.posed.punch.slope(radius)
    of_surface = np.abs(slope_of_gap - slope_of_punch)[near_edge].max()
    measures = (
        ("punch_slope", slope_of_punch[edge], "slope of the punch at the contact edge"),
        ("surface_slope", of_surface, "slope of the deformed surface there (strain)"),
        ("gap_slope", np.abs(slope_of_gap)[near_edge].max(), "slope of the gap there (Derjaguin)"),
    )
    unit = problem.units["gap"] / problem.units["radius"]
    return {
        "contact_radius": float(radius[edge]) * problem.units["radius"],
        "measures": [
            {"key": key, "value": float(value) * unit, "limit": SMALL, "meaning": meaning}
            for key, value, meaning in measures
        ],
    }


def _exact(problem: Problem) -> Problem:
    """The problem with the exact sphere in place of a paraboloid."""
    if problem.punch.kind != _PARABOLOID:
        return problem
    return replace(problem, punch=Section(_BALL, {"R": problem.punch["R"]}))


def _strain(problem: Problem, by_solution: bool) -> Json:
    """Relative error of the force for linear elasticity."""
    if not by_solution:
        return _tabulated(problem)
    exact = _exact(problem)
    finite = evaluate("fem-large-strain", "pull_off_force", exact)
    solved = _error(change_of(evaluate("fscm", "pull_off_force", exact), finite), finite.reason)
    tabulated = solved if solved["error"] is not None else _tabulated(problem)
    return tabulated if tabulated["error"] is not None else solved


def _tabulated(problem: Problem) -> Json:
    """The same where the table of forces of spheres has it."""
    if problem.punch.kind not in (_PARABOLOID, _BALL) or not problem.is_of_the_paper("law"):
        return _error(None, "the table has only spheres under the 9-3 law")
    if not problem.is_of_the_paper("solid") or problem.posed.k != 0.0:
        return _error(None, "the table has only homogeneous solids")
    softness = (problem.posed.mu * problem.units["displacement"] / problem.punch["R"]) ** 1.5
    change = strain_change(softness, problem.posed.mu, problem.solid["nu"])
    if change is None:
        return _error(None, f"the table has no solid as soft as w/(E* R) = {softness:.2g}")
    error, u = -change.value / (1.0 + change.value), change.uncertainty / (1.0 + change.value) ** 2
    return _error((error, u), is_estimate=change.is_extrapolated)


def total_errors(problem: Problem, errors: Sequence[Json], assumed: Json | None) -> list[Json]:
    """Return the errors of models with that of the assumptions, smallest first; none where that is unknown.

    Parameters
    ----------
    problem : Problem
    errors : sequence of dict
        ``model``, ``error`` and ``u_num`` against the force of small strains.
    assumed : dict, optional
        What `assumptions` returns.
    """
    if assumed is None or assumed["total"]["error"] is None:
        return []
    total = {row["model"]: _product((row, assumed["total"])) for row in errors}
    # JKR of the exact sphere does not share the error of the shape.
    exact = _exact(problem)
    change = change_of(evaluate("jkr-sphere", "pull_off_force", exact), evaluate("fscm", "pull_off_force", exact))
    if change is not None:
        total["jkr-sphere"] = _product((_error(change), assumed["strain"]))
    rows = [
        {"model": name} | {key: error[key] for key in ("error", "u_num", "is_estimate")}
        for name, error in total.items()
    ]
    return sorted(rows, key=lambda row: abs(row["error"]))
