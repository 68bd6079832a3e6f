"""What all models assume: a paraboloid, small strains, forces over vertical gaps; how well it holds, and its error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.description.choice import by_size, size_of
from comparisons.description.equivalent_ball import BALL, PARABOLOID
from comparisons.description.forces import change_of, fscm_force
from comparisons.description.shared_errors import ASSUMPTIONS, NOT_ASSUMED_OF_BALLS, Json, error_of, estimates, together
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.fscm_model import SharedAnalysis
from comparisons.models.jkr_sphere import LARGEST_CONTACT
from comparisons.problem import Problem, Section
from comparisons.problem.units import si_text
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

#: Largest slope and strain that count as small: their squares, which linear theory leaves out, are 1 %.
SMALL = 0.1

#: Contact radius over that of the sphere, above which no model is recommended whose errors by vertical gaps and by
#: small strains are unknown: the former is 12 % at 0.51, on a homogeneous solid at a large Tabor number.
_WIDE = 0.5

#: The edge of the contact is where the tension is above this share of its largest value.
_EDGE = 0.5


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
        ``contact_radius`` in m, where the tension is largest.  Relative errors with ``error``, ``u_num``, ``basis``
        ("bound", "estimate" or "unknown") and ``reason``: ``geometry`` of a paraboloid against the ball, ``derjaguin``
        of vertical gaps against the potential of the ball, ``strain`` of small strains against a neo-Hookean solid,
        ``surface_tension`` of a surface without it, ``friction`` of a frictionless surface, and ``total`` of those of
        them that are known.  ``recommendable`` is false where the contact is larger than the sphere, or wide with
        errors that are not known; ``refusal`` says so, and ``remedy`` what to do.  ``by_solution`` is the argument,
        and ``unsolved`` why no error of finite strain was computed although it is true.  None where there is no
        pull-off force.
    """
    if force.value is None:
        return None
    try:
        measures = _measures(problem)
    except (NotApplicable, ComputationFailed):
        return None
    contact_radius = measures["contact_radius"]
    is_sphere = problem.punch.kind in (PARABOLOID, BALL)
    width = contact_radius / min(problem.punch.values.values()) if is_sphere else 0.0
    refusal = remedy = unsolved = ""
    if width > LARGEST_CONTACT:
        refusal = "the contact is larger than the sphere"
        remedy, unsolved = _beyond_sphere(problem, by_solution)
        own = {"surface_tension": estimates(problem)["surface_tension"]}
        errors = dict.fromkeys(ASSUMPTIONS, error_of(None, reason=refusal)) | own
    elif "R_solid" in problem.punch.values:
        reason = "it is known for one sphere on a plane"
        unsolved = reason if by_solution else ""
        errors = dict.fromkeys(ASSUMPTIONS, error_of(None, reason=reason))
    else:
        solved, unsolved = _solved(problem, force, by_solution)
        errors = estimates(problem, contact_radius) | solved
        if width > _WIDE and errors["derjaguin"]["error"] is None and errors["strain"]["error"] is None:
            refusal = (
                f"the contact has {width:.2g} of the radius of the sphere, and what vertical gaps and small strains "
                "change there is unknown"
            )
            remedy = _narrower(problem) if by_solution else "--large-strain may compute both"
    return {
        **measures,
        **errors,
        "total": together(errors),
        "recommendable": not refusal,
        "refusal": refusal,
        "remedy": remedy,
        "by_solution": by_solution,
        "unsolved": unsolved,
    }


def _beyond_sphere(problem: Problem, by_solution: bool) -> tuple[str, str]:
    """What to do where small strains have no contact of the sphere; why finite strain has none, if it is tried."""
    if not by_solution:
        return f"--large-strain may compute the force of the sphere; {_narrower(problem)}", ""
    row = evaluate("fem-large-strain", "pull_off_force", exact_sphere(problem))
    if row.value is None or row.u_num is None:
        return _narrower(problem), row.reason
    return f"fem-large-strain has {si_text(row.value, row.u_num, row.unit)} for the sphere with finite strain", ""


def _narrower(problem: Problem) -> str:
    """What may be changed in a file, so that its contact is small beside the sphere."""
    changes = "a stiffer solid or a smaller work of adhesion"
    if problem.solid.get("surface_tension") is None:
        changes = f"the surface tension of the solid (solid.surface_tension), {changes}"
    return f"the force above is no estimate of that of the true sphere; the contact is narrower with {changes}"


def _solved(problem: Problem, force: Row, by_solution: bool) -> tuple[dict[str, Json], str]:
    """Errors against solutions: of the exact sphere, and if it is asked for of finite strain; why the latter is not."""
    exact, errors, unsolved = exact_sphere(problem), {}, ""
    if problem.punch.kind != PARABOLOID and not by_solution:
        return {}, ""
    small = force if exact is problem else fscm_force(exact)
    if exact is not problem:
        errors["geometry"] = error_of(change_of(force, small), reason=small.reason)
    if by_solution:
        # Imported here: finite elements take longer to import than the rest of a description.
        from comparisons.models.fem_model import LargeStrain

        vertical_gaps: Any = LargeStrain("derjaguin")
        vertical = evaluate(vertical_gaps, "pull_off_force", exact)
        errors["strain"] = error_of(change_of(small, vertical), reason=vertical.reason)
        if exact.punch.kind == BALL:
            body = evaluate("fem-large-strain", "pull_off_force", exact)
            errors["derjaguin"] = error_of(change_of(vertical, body), reason=body.reason)
        unsolved = errors["strain"]["reason"]
    return {name: error for name, error in errors.items() if error["error"] is not None}, unsolved


def _measures(problem: Problem) -> Json:
    """Contact radius and slopes at pull-off, by the FSCM."""
    surface = SharedAnalysis().pull_off_surface(problem)
    # At a very large Tabor number neighbouring nodes of the edge are one number.
    apart = np.diff(surface.radius, prepend=-1.0) > 0.0
    radius, gap, tension = surface.radius[apart], surface.gap[apart], -surface.pressure[apart]
    edge = int(np.argmax(tension))
    near_edge = tension > _EDGE * tension[edge]
    slope_of_gap = np.gradient(gap, radius)
    slope_of_punch = problem.posed.punch.slope(radius)
    of_gap, of_surface = (np.abs(slope)[near_edge].max() for slope in (slope_of_gap, slope_of_gap - slope_of_punch))
    measures = (
        ("punch_slope", slope_of_punch[edge], "slope of the punch at the contact edge"),
        ("surface_slope", of_surface, "largest slope of the surface, in the very edge as at a crack tip"),
        (
            "gap_slope",
            of_gap,
            "largest slope of the gap, in the very edge as at a crack tip",
        ),
    )
    unit = problem.units["gap"] / problem.units["radius"]
    return {
        "contact_radius": float(radius[edge]) * problem.units["radius"],
        "measures": [
            {"key": key, "value": float(value) * unit, "limit": SMALL, "meaning": meaning}
            for key, value, meaning in measures
        ],
    }


def exact_sphere(problem: Problem) -> Problem:
    """Return the problem with the exact sphere in place of a paraboloid."""
    if problem.punch.kind != PARABOLOID:
        return problem
    return replace(problem, punch=Section(BALL, {"R": problem.punch["R"]}))


def total_errors(problem: Problem, errors: Sequence[Json], assumed: Json | None) -> list[Json]:
    """Return the errors of models with those of the assumptions that are known, smallest first; none where none is.

    ``at_most`` of a row is what the size of the error of the model and that of its assumptions together make.

    Parameters
    ----------
    problem : Problem
    errors : sequence of dict
        ``model``, ``error`` and ``u_num`` against the force of small strains, with ``at_most`` by which it counts.
    assumed : dict, optional
        What `assumptions` returns.
    """
    if assumed is None or assumed["total"]["error"] is None:
        return []
    shared = {name: assumed[name] for name in ASSUMPTIONS}
    rows = {row["model"]: _with_assumptions(row, shared) for row in errors}
    # JKR of the exact sphere does not share the error of the shape, and has the true area of contact.
    shared = {name: error for name, error in shared.items() if name != "geometry"}
    rows |= {row["model"]: _with_assumptions(row, shared) for row in errors_of_exact_sphere(problem)}
    return sorted(rows.values(), key=lambda row: abs(row["error"]))


def errors_of_exact_sphere(problem: Problem) -> list[Json]:
    """Return the errors of the closed forms of JKR for an exact sphere against the force of that sphere."""
    exact = exact_sphere(problem)
    force, rows = fscm_force(exact), []
    for name in ("jkr-sphere", "jkr-sphere-projected"):
        change = change_of(evaluate(name, "pull_off_force", exact), force)
        if change is not None:
            rows.append({"model": name, "error": change[0], "u_num": change[1]})
    return rows


def _with_assumptions(row: Json, shared: Mapping[str, Json]) -> Json:
    """The error of a model with those of the assumptions; the force of a model without one of these has its effect."""
    avoided = NOT_ASSUMED_OF_BALLS.get(row["model"], ())
    known = {name: error for name, error in shared.items() if error["error"] is not None}
    own = together({"model": row | {"basis": "bound"}} | {name: known[name] for name in avoided if name in known})
    of_others = together({name: error for name, error in known.items() if name not in avoided})
    total = together({"model": row | {"basis": "bound"}, **shared})
    of_model = row["at_most"] if "at_most" in row else size_of(own)
    assumed = size_of(of_others) if of_others["error"] is not None else 0.0
    return {
        "model": row["model"],
        **{key: total[key] for key in ("error", "u_num", "basis")},
        "at_most": by_size(of_model, assumed),
    }
