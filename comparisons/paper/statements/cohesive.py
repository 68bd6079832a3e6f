"""Tests of the two Maugis-Dugdale models: cohesive zones, areas of the laws, surfaces, and signs of their errors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import CubicSpline

from comparisons.data.paper_statements import PaperStatement
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig17_surface_models import cohesive_surface
from comparisons.paper.statements.evidence import REFERENCES, Evidence, Number
from comparisons.paper.statements.sources import Case, StatementTest, case_label, grid, number, reading, tasks_of
from comparisons.paper.tasks import profile
from fscm.laws import LennardJones

__all__ = ["TESTS"]

_IMPROVED, _ORIGINAL = "md-improved", "md-original"
#: Relative rounding of the radii of a Maugis-Dugdale contact, which are roots.
_ROUNDING = 1e4 * EPS
_FARTHEST = 3.0
_LAW = LennardJones()
#: Radii at which two surfaces are compared, evenly spaced.
_SAMPLES = 501


def _zone_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(cohesive_surface, m, *case) for case in grid(statement) for m in (_IMPROVED, _ORIGINAL)]


def _zones(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The cohesive zone of the improved model is wider."""
    rows = []
    for case in grid(statement):
        widths = []
        for model in (_IMPROVED, _ORIGINAL):
            zone = results[CachedCall.of(cohesive_surface, model, *case)]
            outer, inner = zone["cohesive_radius"], zone["contact_radius"]
            what = f"width c - a of {model} at pull-off, {case_label(case)}"
            widths.append(Number(outer - inner, _ROUNDING * outer, what))
        rows.append(Evidence(case_label(case), "formula", widths[0], ">", widths[1]))
    return rows


def _areas(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The tension over the gap, from zero gap on, has the area of the work of adhesion in each model.

    The area of a Maugis-Dugdale model is its cohesive stress times its gap at c, at which Eq. 69 ends the zone.
    """
    area, u = quad(lambda gap: float(_LAW.traction(np.array(gap))), 0.0, np.inf, epsabs=1e-13, epsrel=1e-13)
    rows = [_area("fscm", "area of the 9-3 law", -area, u, reading(statement))]
    for case in grid(statement):
        for model, stress in ((_IMPROVED, eta(case[0])), (_ORIGINAL, THEORETICAL_STRENGTH)):
            zone = results[CachedCall.of(cohesive_surface, model, *case)]
            radius, gap = np.array(zone["radius"]), np.array(zone["gap"])
            at_end = float(np.interp(zone["cohesive_radius"], radius, gap))
            # The end of the zone is a sample of the surface; its neighbours tell what interpolation may miss.
            apart = float(np.abs(radius - zone["cohesive_radius"]).min())
            u_gap = apart * float(np.abs(np.gradient(gap, radius)).max()) + _ROUNDING
            title = f"cohesive stress times the gap at c of {model}, {case_label(case)}"
            rows.append(_area(model, title, stress * at_end, stress * u_gap, reading(statement)))
    return rows


def _area(model: str, title: str, area: float, u: float, limit: Number) -> Evidence:
    value = Number(abs(area - 1.0), u, f"difference from the work of adhesion: {title}")
    return Evidence(model, "formula", value, "<", limit)


def _sign_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [
        call for case in grid(statement) for m in ("fscm", _IMPROVED) for call in tasks_of(m, "pull_off_force", case)
    ]


def _above(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The force of the improved model is above that of the reference."""
    return [
        Evidence(
            case_label(case),
            "fscm",
            number(results, _IMPROVED, "pull_off_force", case),
            ">",
            number(results, "fscm", "pull_off_force", case),
        )
        for case in grid(statement)
    ]


def _surface_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [*_zone_tasks(statement), *(call for case in grid(statement) for call in _exact(case))]


def _exact(case: Case) -> list[CachedCall]:
    return [
        call
        for model in REFERENCES
        for call in (CachedCall.of(profile, model, *case), *tasks_of(model, "pull_off_displacement", case))
    ]


def _surfaces(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The surface of the improved model is nearer inside its contact and outside its cohesive zone."""
    return [row for case in grid(statement) for model in REFERENCES for row in _distances(case, model, results)]


def _distances(case: Case, reference: str, results: Results) -> list[Evidence]:
    exact = results[CachedCall.of(profile, reference, *case)]
    displacement = number(results, reference, "pull_off_displacement", case)
    radius, gap = np.array(exact["radius"]), np.array(exact["gap"])
    u = displacement.u + 2.0 * exact["u_distance"] * float(np.ptp(gap))
    zones = {model: results[CachedCall.of(cohesive_surface, model, *case)] for model in (_IMPROVED, _ORIGINAL)}
    inner = min(found["contact_radius"] for found in zones.values())
    outer = max(found["cohesive_radius"] for found in zones.values())
    rows = []
    for clause, start, end in (
        ("inside the contact", float(radius[0]), inner),
        ("outside the cohesive zone", outer, _FARTHEST),
    ):
        r = np.linspace(start, end, _SAMPLES)
        # The deformation is w = H + delta - f (Eq. 4); f is the same everywhere.
        own = CubicSpline(radius, gap)(r) + displacement.value
        errors = []
        for model, found in zones.items():
            theirs = np.interp(r, found["radius"], found["gap"]) + found["displacement"]
            what = f"mean distance of the surface of {model} from {reference} {clause}, {case_label(case)}"
            errors.append(Number(float(np.abs(theirs - own).mean()), u, what))
        rows.append(Evidence(f"{clause}, {case_label(case)}", reference, errors[0], "<", errors[1]))
    return rows


#: Tests of statements on the models of Maugis and Dugdale, by name.
TESTS = {
    "wider_zone": StatementTest(_zone_tasks, _zones),
    "equal_areas": StatementTest(_zone_tasks, _areas),
    "force_above": StatementTest(_sign_tasks, _above),
    "surface_nearer": StatementTest(_surface_tasks, _surfaces),
}
