"""Errors of the assumptions that all models share, one by one and together, without a solution.

Each is an object of JSON with ``error`` and ``u_num``, relative to the pull-off force, ``basis`` ("bound", "estimate"
or "unknown") and ``reason``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

from comparisons.description.changes import Change
from comparisons.description.equivalent_ball import BALL, PARABOLOID, EquivalentBall, equivalent_ball
from comparisons.description.strain_errors import body_change, shape_change, strain_change
from comparisons.model import NotApplicable
from comparisons.problem import Problem, Section
from comparisons.problem.units import si_text
from comparisons.runs.tasks import evaluate

Json = dict[str, Any]

#: What is known of an error, from the best to the worst: a bound on it, an estimate, nothing.
BASES = ("bound", "estimate", "unknown")

#: The assumptions in the order of the text, and their names there.
ASSUMPTIONS = {
    "geometry": "the paraboloid",
    "derjaguin": "vertical gaps",
    "strain": "small strains",
    "surface_tension": "surface tension",
    "friction": "friction",
}

#: Assumptions that a model does not make for a ball.
NOT_ASSUMED_OF_BALLS = {"jkr-sphere": ("derjaguin",), "fem-large-strain": ("derjaguin", "strain")}

#: Share of an error that its uncertainty has where another ball stands for the problem; of strain, the share of that of
#: an incompressible solid (measured on layers, films and gradients against solutions: the paraboloid by up to 0.35, the
#: vertical gap by up to 0.2, strain by up to 0.15).
_OF_EQUIVALENT = 0.5

#: Surface tension in N/m that a soft solid may have: that of PDMS is 20 mN/m, that of water 72 mN/m.
TENSION = 0.02

#: Tabor numbers below and above which the force of a paraboloid is that of its limit.
_LIMITS = ((0.01, "bradley"), (10.0, "jkr"))


def error_of(change: tuple[float, float] | None, basis: str = "bound", reason: str = "") -> Json:
    """Return a relative error with its uncertainty, or the reason why it is unknown."""
    error, bound = change or (None, None)
    return {"error": error, "u_num": bound, "basis": basis if change else "unknown", "reason": "" if change else reason}


def together(errors: Mapping[str, Json]) -> Json:
    """Return the error of the relative errors that are known, after each other; the reason names the others.

    Examples
    --------
    >>> known = error_of((0.1, 0.01)), error_of((-0.5, 0.0), "estimate")
    >>> total = together(dict(zip(ASSUMPTIONS, known)) | {"strain": error_of(None)})
    >>> round(total["error"], 12), total["basis"], total["reason"]
    (-0.45, 'estimate', 'without small strains')
    """
    total, bound, basis = 1.0, 0.0, BASES[0]
    unknown = [ASSUMPTIONS[name] for name, error in errors.items() if error["error"] is None]
    reason = f"without {_listed(unknown)}" if unknown else ""
    known = [error for error in errors.values() if error["error"] is not None]
    if unknown and not any(error["error"] or error["u_num"] for error in known):
        return error_of(None, reason=reason)
    for error in known:
        factor = 1.0 + error["error"]
        total, bound = total * factor, bound * abs(factor) + abs(total) * error["u_num"]
        basis = max(basis, error["basis"], key=BASES.index)
    return {"error": total - 1.0, "u_num": bound, "basis": basis, "reason": reason}


def direction(error: Json) -> str:
    """Return in brackets what the sign of a relative error says of a force, where it is certain.

    Examples
    --------
    >>> direction({"error": -0.02, "u_num": 0.003}), direction({"error": -0.02, "u_num": 0.03})
    (' (too small)', '')
    """
    if abs(error["error"]) <= error["u_num"]:
        return ""
    return " (too large)" if error["error"] > 0.0 else " (too small)"


def _listed(names: list[str]) -> str:
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


@lru_cache(maxsize=256)
def estimates(problem: Problem, contact_radius: float | None = None) -> dict[str, Json]:
    """Return the error of each assumption, by the table of balls and closed forms.

    Parameters
    ----------
    problem : Problem
        In physical units.
    contact_radius : float, optional
        In m at pull-off, for a solid that is not homogeneous.
    """
    errors = _of_ball(problem, contact_radius)
    if problem.punch.kind != PARABOLOID:
        errors["geometry"] = error_of((0.0, 0.0))
    if problem.law.get("interaction") == "body":
        errors["derjaguin"] = error_of((0.0, 0.0))
    return errors | {"surface_tension": _surface_tension(problem), "friction": _friction(problem)}


def _of_ball(problem: Problem, contact_radius: float | None) -> dict[str, Json]:
    """Those that the table has."""
    changes: dict[str, Callable[[EquivalentBall], Change | None]] = {
        "geometry": lambda ball: shape_change(ball.softness, ball.mu),
        "derjaguin": lambda ball: body_change(ball.softness, ball.mu, ball.nu),
        "strain": lambda ball: strain_change(ball.softness, ball.mu, ball.nu),
    }
    try:
        ball = equivalent_ball(problem, contact_radius)
    except NotApplicable as reason:
        return dict.fromkeys(changes, error_of(None, reason=str(reason)))
    too_soft = f"the table has no solid as soft as w/(E* R) = {ball.softness:.2g}"
    errors = {}
    for name, change_of in changes.items():
        error, largest = _inverse(change_of(ball)), _inverse(change_of(ball._replace(nu=0.5)))
        if error is not None and largest is not None and not ball.is_exact:
            error = error[0], error[1] + _OF_EQUIVALENT * max(abs(error[0]), abs(largest[0]))
        errors[name] = error_of(error, "estimate", too_soft)
    if problem.is_of_the_paper("solid") and not ball.is_exact:
        errors["strain"] = error_of(None, reason="finite strain has no surface without a modulus")
    return errors


def _inverse(change: Change | None) -> tuple[float, float] | None:
    """Relative error of what a change leads away from."""
    return change and (-change.value / (1.0 + change.value), change.uncertainty / (1.0 + change.value) ** 2)


def _surface_tension(problem: Problem) -> Json:
    """None where the problem states the surface tension of each body, so that it has been computed with it."""
    if all(body.get("surface_tension") is not None for body in problem.bodies):
        return error_of((0.0, 0.0))
    reason, effect = "solid.surface_tension is not stated", effect_of_tension(problem)
    if effect is not None:
        reason += f"; {si_text(TENSION, 0.0, 'N/m')} would change the force by about {100.0 * effect:+.1f} %"
    return error_of(None, reason=reason)


def effect_of_tension(problem: Problem) -> float | None:
    """Return the relative change of the pull-off force of JKR by the surface tension `TENSION` of the solid.

    That of the paraboloid for a ball.  None where JKR is not the limit: for a punch that is no sphere, a solid that is
    not homogeneous, and a stiff one, for which the change is smaller.
    """
    if problem.punch.kind == BALL:
        paraboloid = replace(problem, punch=Section(PARABOLOID, {"R": problem.punch["R"]}))
        return effect_of_tension(paraboloid.without("law.interaction"))
    (_, _), (highest, soft) = _LIMITS
    if problem.punch.kind != PARABOLOID or problem.solid.kind != "homogeneous" or problem.posed.mu < highest:
        return None
    tense = problem.with_value("solid.surface_tension", TENSION)
    with_tension = evaluate("jkr-surface-tension", "pull_off_force", tense).value
    without = evaluate(soft, "pull_off_force", problem).value
    return with_tension / without - 1.0 if with_tension and without else None


def _friction(problem: Problem) -> Json:
    """Error of a frictionless surface against one without slip, between none and that of an inextensible surface.

    The compliance of an inextensible surface is (3 - 4 nu)/(4 (1 - nu)^2) of that of a free one.  Without slip the
    surface is inextensible inside of the contact alone.
    """
    if problem.solid.get("friction") == "bonded":
        return error_of((0.0, 0.0))
    if problem.punch_solid is not None:
        return error_of(None, reason="there is no formula for two elastic bodies")
    if problem.solid.kind == "homogeneous" and problem.solid["nu"] == 0.5:
        return error_of((0.0, 0.0))
    if not problem.is_of_the_paper("solid") or problem.posed.k != 0.0:
        return error_of(
            None, reason=f"there is no formula for the {problem.parts.partition(',')[0].removeprefix('a ')}"
        )
    nu = problem.solid["nu"]
    compliance = (3.0 - 4.0 * nu) / (4.0 * (1.0 - nu) ** 2)
    if compliance == 1.0:
        return error_of((0.0, 0.0))
    modulus = "solid.E" if problem.solid.kind == "homogeneous" else "solid.E0"
    forces = [_by_formula(problem.with_value(modulus, problem[modulus] / factor)) for factor in (1.0, compliance)]
    if forces[0] is None or forces[1] is None:
        return error_of(None, reason="there is no formula for this punch or this law")
    half = 0.5 * (forces[0] / forces[1] - 1.0)
    return error_of((half, abs(half)), "estimate")


def _by_formula(problem: Problem) -> float | None:
    """The pull-off force of a problem, of the paraboloid for a ball, without a solution."""
    if problem.punch.kind == BALL:
        return _by_formula(Problem(problem.solid, Section(PARABOLOID, {"R": problem.punch["R"]}), problem.law))
    if not problem.is_of_the_paper():
        return None
    (lowest, rigid), (highest, soft) = _LIMITS
    mu = problem.posed.mu
    return evaluate(rigid if mu < lowest else soft if mu > highest else "atlas", "pull_off_force", problem).value
