"""What all models assume: a paraboloid, small strains, forces over vertical gaps; how well it holds, and its error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.description.forces import change_of
from comparisons.description.strain_errors import Change, body_change, strain_change
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.fem_model import LargeStrain
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


#: What is known of an error, from the best to the worst: a bound on it, an estimate, nothing.
BASES = ("bound", "estimate", "unknown")

#: The assumptions in the order of the text, and their names there.
ASSUMPTIONS = {"geometry": "the paraboloid", "derjaguin": "vertical gaps", "strain": "small strains"}


def _error(change: tuple[float, float] | None, basis: str = "bound", reason: str = "") -> Json:
    """A relative change with its uncertainty, or the reason why it is unknown."""
    error, bound = change or (None, None)
    return {"error": error, "u_num": bound, "basis": basis if change else "unknown", "reason": "" if change else reason}


def _product(changes: Mapping[str, Json]) -> Json:
    """Error of the relative changes that are known, after each other; the reason names the others."""
    total, bound, basis = 1.0, 0.0, BASES[0]
    unknown = [ASSUMPTIONS[name] for name, change in changes.items() if change["error"] is None]
    reason = f"without {' and '.join(unknown)}" if unknown else ""
    known = [change for change in changes.values() if change["error"] is not None]
    if unknown and not any(change["error"] or change["u_num"] for change in known):
        return _error(None, reason=reason)
    for change in known:
        factor = 1.0 + change["error"]
        total, bound = total * factor, bound * abs(factor) + abs(total) * change["u_num"]
        basis = max(basis, change["basis"], key=BASES.index)
    return {"error": total - 1.0, "u_num": bound, "basis": basis, "reason": reason}


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
        ``contact_radius`` in m, where the tension is largest.  ``geometry``, ``derjaguin``, ``strain`` and ``total``
        have ``error``, ``u_num``, ``basis`` and ``reason``: relative errors of a paraboloid against the ball, of
        vertical gaps against the potential of the ball, of small strains against a neo-Hookean solid without friction,
        and of those of them that are known.  ``basis`` is "bound", "estimate" or "unknown".  ``recommendable`` is
        false where the contact is larger than the sphere, ``by_solution`` the argument.  None where there is no
        pull-off force.
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
        errors = dict.fromkeys(ASSUMPTIONS, _error(None, reason="the contact is larger than the sphere"))
    else:
        errors = {"geometry": _geometry(problem, force), **_of_strain(problem, by_solution)}
    return {
        **measures,
        **errors,
        "total": _product({name: errors[name] for name in ASSUMPTIONS}),
        "recommendable": not is_too_large,
        "by_solution": by_solution,
    }


def _geometry(problem: Problem, force: Row) -> Json:
    """Relative error of the force for a paraboloid in place of the sphere."""
    if problem.punch.kind != _PARABOLOID:
        return _error((0.0, 0.0))
    ball = evaluate("fscm", "pull_off_force", _exact(problem))
    return _error(change_of(force, ball), reason=ball.reason)


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


def _of_strain(problem: Problem, by_solution: bool) -> dict[str, Json]:
    """Relative errors of the force for vertical gaps, and for linear elasticity."""
    exact = _exact(problem)
    tabulated = _tabulated(exact)
    if not by_solution:
        return tabulated
    small = evaluate("fscm", "pull_off_force", exact)
    vertical_gaps: Any = LargeStrain("derjaguin")
    vertical = evaluate(vertical_gaps, "pull_off_force", exact)
    solved = {"strain": _error(change_of(small, vertical), reason=vertical.reason), "derjaguin": tabulated["derjaguin"]}
    if exact.punch.kind == _BALL:
        body = evaluate("fem-large-strain", "pull_off_force", exact)
        solved["derjaguin"] = _error(change_of(vertical, body), reason=body.reason)
    return {name: tabulated[name] if error["error"] is None else error for name, error in solved.items()}


def _tabulated(problem: Problem) -> dict[str, Json]:
    """The same where the table of forces of balls has them."""
    names = ("derjaguin", "strain")
    if problem.punch.kind != _BALL or not problem.is_of_the_paper("law"):
        return dict.fromkeys(names, _error(None, reason="the table has only spheres under the 9-3 law"))
    if not problem.is_of_the_paper("solid") or problem.posed.k != 0.0:
        return dict.fromkeys(names, _error(None, reason="the table has only homogeneous solids"))
    mu = problem.posed.mu
    softness = (mu * problem.units["displacement"] / problem.punch["R"]) ** 1.5
    changes = body_change(softness, mu, problem.solid["nu"]), strain_change(softness, mu, problem.solid["nu"])
    reason = f"the table has no solid as soft as w/(E* R) = {softness:.2g}"
    return {name: _error(_inverse(change), "estimate", reason) for name, change in zip(names, changes, strict=True)}


def _inverse(change: Change | None) -> tuple[float, float] | None:
    """Relative error of what a change leads away from."""
    return change and (-change.value / (1.0 + change.value), change.uncertainty / (1.0 + change.value) ** 2)


def total_errors(problem: Problem, errors: Sequence[Json], assumed: Json | None) -> list[Json]:
    """Return the errors of models with those of the assumptions that are known, smallest first; none where none is.

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
    assumptions_known = {name: assumed[name] for name in ASSUMPTIONS}
    total = {row["model"]: _product({"model": row | {"basis": "bound"}, **assumptions_known}) for row in errors}
    # JKR of the exact sphere does not share the error of the shape, and has the true area of contact.
    exact = _exact(problem)
    force = evaluate("fscm", "pull_off_force", exact)
    shared = {name: assumed[name] for name in ("derjaguin", "strain")}
    for name in ("jkr-sphere", "jkr-sphere-projected"):
        change = change_of(evaluate(name, "pull_off_force", exact), force)
        if change is not None:
            total[name] = _product({"model": _error(change), **shared})
    rows = [{"model": name} | {key: error[key] for key in ("error", "u_num", "basis")} for name, error in total.items()]
    return sorted(rows, key=lambda row: abs(row["error"]))
