"""Tests of the surface at pull-off: pile-up, pressure, contact zone, band of large tension, cohesive zones."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from comparisons.data.paper_statements import PaperStatement
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.solver import translated
from comparisons.paper.cache import CachedCall
from comparisons.paper.figures.fig05_07_pull_off_surfaces import surface
from comparisons.paper.figures.fig17_surface_models import cohesive_surface
from comparisons.paper.paper_figure import Plan, results_by
from comparisons.paper.statements.evidence import REFERENCES, Evidence, Number
from comparisons.paper.statements.numbers import (
    Case,
    Comparisons,
    case_label,
    grid,
    number,
    reading,
    tasks_of,
    witnesses,
)
from comparisons.paper.statements.trends import ordered
from comparisons.paper.tasks import profile
from fscm import Analysis, NoSuchEvent, NotConverged
from fscm.laws import LennardJones
from fscm.problem import Problem
from fscm.solution import FLOOR, SAFETY, State

__all__ = ["TESTS", "band_width", "half_strength_gaps"]

Json = dict[str, Any]

_LAW = LennardJones()
_IMPROVED, _ORIGINAL = "md-improved", "md-original"
#: Relative rounding of the radii of a Maugis-Dugdale contact, which are roots.
_ROUNDING = 1e4 * EPS
_FARTHEST = 3.0
#: Radii at which two surfaces are compared, and at which the gap is averaged, evenly spaced.
_SAMPLES, _MEANS = 501, 2001


def _traction(gap: float) -> float:
    return float(_LAW.traction(np.array(gap)))


def half_strength_gaps() -> tuple[float, float]:
    """Return the two gaps where the tension of the 9-3 law is half of its strength.

    Examples
    --------
    >>> [round(gap, 4) for gap in half_strength_gaps()]
    [0.0417, 0.7085]
    """
    peak = float(_LAW.peak_gap)
    half = 0.5 * _traction(peak)
    near, far = (
        float(brentq(lambda gap: _traction(gap) - half, a, b, xtol=1e-15)) for a, b in ((0.0, peak), (peak, 5.0))
    )
    return near, far


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
    >>> found = band_width(2, 0.4, 1)
    >>> 0.2 < found["width"] < 0.3, found["u"] < 1e-6
    (True, True)
    """
    with translated(NoSuchEvent, NotConverged):
        event = Analysis(Problem(n, k, mu)).event("pull_off")
    check, value = _width(event.check), _width(event.value)
    return {"width": value, "u": SAFETY * abs(value - check) + FLOOR}


def _width(state: State) -> float:
    """Width in the plane of radius and gap, between roots of the interpolated gap."""
    outer = float(state.radius[-1])

    def gap_at(radius: float) -> float:
        return float(state.disc.mesh.evaluate(state.gap, np.array([radius / state.scale]))[0])

    def radius_of(gap: float) -> float:
        return float(brentq(lambda r: gap_at(r) - gap, 0.0, outer, xtol=1e-14))

    near, far = (radius_of(gap) for gap in half_strength_gaps())
    return (far - near) / radius_of(float(_LAW.peak_gap))


def _of_grid(function: Callable[..., Json], statement: PaperStatement) -> Plan[dict[Case, Json]]:
    found = yield from results_by({case: CachedCall.of(function, *case) for case in grid(statement)})
    return found


def pile_up_at_edge(statement: PaperStatement) -> Comparisons:
    """The surface is pulled up most at the edge, and less and less outside."""
    surfaces = yield from _of_grid(surface, statement)
    rows = []
    for case, values in surfaces.items():
        label = case_label(case)
        radius, w, u = (np.array(values[name]) for name in ("radius", "deformation", "u_deformation"))
        edge, top = int(np.argmin(values["pressure"])), int(np.argmin(w))
        spacing = float(np.diff(radius)[max(top - 1, 0) : top + 1].max())
        apart = Number(
            abs(radius[top] - radius[edge]) / radius[edge],
            spacing / radius[edge],
            f"distance of the highest point of the surface from the edge, over the edge's radius, {label}",
        )
        outside = np.arange(len(radius)) >= edge
        steps, bounds = np.diff(w[outside]), u[outside][1:] + u[outside][:-1]
        least = int(np.argmin(steps))
        falling = Number(float(steps[least]), float(bounds[least]), f"least step of w outside the edge, {label}")
        rows.append(Evidence(label, "fscm", apart, "<", reading(statement)))
        rows.append(Evidence(label, "fscm", falling, ">", Number(0.0, 0.0, "w approaches zero from below")))
    return rows


def compressed_centre(statement: PaperStatement) -> Comparisons:
    """The pressure at the centre is compressive."""
    calls = {("fscm", case): CachedCall.of(surface, *case) for case in grid(statement)}
    calls |= {("fem", case): CachedCall.of(profile, "fem", *case) for case in witnesses(statement)}
    found = yield from results_by(calls)
    rows = []
    for (model, case), values in found.items():
        pressure = values["pressure"]
        u = values["u_pressure"][0] if model == "fscm" else values["u_distance"] * float(np.ptp(pressure))
        value = Number(pressure[0], u, f"pressure at the centre at pull-off, {case_label(case)}")
        rows.append(Evidence(case_label(case), model, value, ">", Number(0.0, 0.0, "compressive")))
    return rows


def _from_mu(statement: PaperStatement, case: Case) -> str:
    """Below the limit from one Tabor number on, and above it at a smaller one."""
    return "<" if case[2] >= float(statement.arguments["from_mu"]) else ">"


def contact_gap(statement: PaperStatement) -> Comparisons:
    """The mean gap in the contact is below a limit from one Tabor number on, and above it at a small one."""
    surfaces = yield from _of_grid(surface, statement)
    rows = []
    for case, values in surfaces.items():
        radius, gap, u = (np.array(values[name]) for name in ("radius", "gap", "u_gap"))
        # Inside the radius of the largest tension, by a spline and by chords.
        edge = float(radius[np.argmin(values["pressure"])])
        x = np.linspace(0.0, edge, _MEANS)
        sizes = np.abs(CubicSpline(radius, gap)(x)), np.abs(np.interp(x, radius, gap))
        mean, rough = (float(np.trapezoid(sampled, x)) / edge for sampled in sizes)
        bound = abs(mean - rough) + float(u[radius <= edge].max())
        value = Number(mean, bound, f"mean gap inside the edge, {case_label(case)}")
        rows.append(Evidence(case_label(case), "fscm", value, _from_mu(statement, case), reading(statement)))
    return rows


def centre_falls_with_k(statement: PaperStatement) -> Comparisons:
    """Deformation and pressure at the centre fall with k."""
    surfaces = yield from _of_grid(surface, statement)
    rows: list[Evidence] = []
    for name, title in (("deformation", "size of the deformation"), ("pressure", "pressure")):
        values = {}
        for case, found in surfaces.items():
            what = f"{title} at the centre at pull-off, {case_label(case)}"
            values[case] = Number(abs(found[name][0]), found[f"u_{name}"][0], what)
        rows += ordered(values, "k", "<")
    return rows


def pile_up_rises(statement: PaperStatement) -> Comparisons:
    """The pile-up above the centre rises with k."""
    surfaces = yield from _of_grid(surface, statement)
    heights = {}
    for case, found in surfaces.items():
        w, u = (np.array(found[name]) for name in ("deformation", "u_deformation"))
        what = f"height of the pile-up above the centre at pull-off, {case_label(case)}"
        heights[case] = Number(float(w[0] - w.min()), float(u[0] + u[np.argmin(w)]), what)
    return ordered(heights, "k", ">")


def _widths(statement: PaperStatement) -> Plan[dict[Case, Number]]:
    bands = yield from _of_grid(band_width, statement)
    title = "width of the band with more than half of the strength, over its radius"
    return {case: Number(band["width"], band["u"], f"{title}, {case_label(case)}") for case, band in bands.items()}


def band_narrows(statement: PaperStatement) -> Comparisons:
    """The band of large tension becomes narrower along the cases."""
    widths = yield from _widths(statement)
    return ordered(widths, str(statement.arguments["along"]), "<")


def contact_edge(statement: PaperStatement) -> Comparisons:
    """The band of large tension is narrow from one Tabor number on, and wide at a smaller one."""
    widths = yield from _widths(statement)
    return [
        Evidence(case_label(case), "fscm", width, _from_mu(statement, case), reading(statement))
        for case, width in widths.items()
    ]


def _zones(cases: Iterable[Case]) -> dict[tuple[str, Case], CachedCall]:
    """Surfaces of both Maugis-Dugdale models."""
    models = (_IMPROVED, _ORIGINAL)
    return {(model, case): CachedCall.of(cohesive_surface, model, *case) for case in cases for model in models}


def wider_zone(statement: PaperStatement) -> Comparisons:
    """The cohesive zone of the improved model is wider."""
    zones = yield from results_by(_zones(grid(statement)))

    def width(model: str, case: Case) -> Number:
        outer, inner = (zones[model, case][name] for name in ("cohesive_radius", "contact_radius"))
        return Number(outer - inner, _ROUNDING * outer, f"width c - a of {model} at pull-off, {case_label(case)}")

    return [
        Evidence(case_label(case), "formula", width(_IMPROVED, case), ">", width(_ORIGINAL, case))
        for case in grid(statement)
    ]


def equal_areas(statement: PaperStatement) -> Comparisons:
    """The tension over the gap, from zero gap on, has the area of the work of adhesion in each model.

    The area of a Maugis-Dugdale model is its cohesive stress times its gap at c, at which Eq. 69 ends the zone.
    """
    zones = yield from results_by(_zones(grid(statement)))
    tension, u = quad(_traction, 0.0, np.inf, epsabs=1e-13, epsrel=1e-13)
    areas = [("fscm", "area of the 9-3 law", -tension, u)]
    for (model, case), zone in zones.items():
        stress = eta(case[0]) if model == _IMPROVED else THEORETICAL_STRENGTH
        radius, gap = np.array(zone["radius"]), np.array(zone["gap"])
        at_end = float(np.interp(zone["cohesive_radius"], radius, gap))
        # The end of the zone is a sample of the surface; its neighbours tell what interpolation may miss.
        nearest = float(np.abs(radius - zone["cohesive_radius"]).min())
        u_gap = nearest * float(np.abs(np.gradient(gap, radius)).max()) + _ROUNDING
        title = f"cohesive stress times the gap at c of {model}, {case_label(case)}"
        areas.append((model, title, stress * at_end, stress * u_gap))
    rows = []
    for model, title, area, u_area in areas:
        apart = Number(abs(area - 1.0), u_area, f"difference from the work of adhesion: {title}")
        rows.append(Evidence(model, "formula", apart, "<", reading(statement)))
    return rows


def surface_nearer(statement: PaperStatement) -> Comparisons:
    """The surface of the improved model is nearer inside its contact and outside its cohesive zone."""
    cases = grid(statement)
    zones = _zones(cases)
    exact = {(model, case): CachedCall.of(profile, model, *case) for case in cases for model in REFERENCES}
    places = [call for model, case in exact for call in tasks_of(model, "pull_off_displacement", case)]
    results = yield [*zones.values(), *exact.values(), *places]
    rows: list[Evidence] = []
    for (reference, case), call in exact.items():
        displacement = number(results, reference, "pull_off_displacement", case)
        models = {model: results[zones[model, case]] for model in (_IMPROVED, _ORIGINAL)}
        rows += _distances(case, reference, results[call], displacement, models)
    return rows


def _distances(
    case: Case, reference: str, exact: Json, displacement: Number, models: dict[str, Json]
) -> list[Evidence]:
    radius, gap = np.array(exact["radius"]), np.array(exact["gap"])
    u = displacement.u + 2.0 * exact["u_distance"] * float(np.ptp(gap))
    inner = min(found["contact_radius"] for found in models.values())
    outer = max(found["cohesive_radius"] for found in models.values())
    rows = []
    for clause, start, end in (
        ("inside the contact", float(radius[0]), inner),
        ("outside the cohesive zone", outer, _FARTHEST),
    ):
        r = np.linspace(start, end, _SAMPLES)
        # The deformation is w = H + delta - f (Eq. 4); f is the same everywhere.
        own = CubicSpline(radius, gap)(r) + displacement.value
        errors = []
        for model, found in models.items():
            theirs = np.interp(r, found["radius"], found["gap"]) + found["displacement"]
            what = f"mean distance of the surface of {model} from {reference} {clause}, {case_label(case)}"
            errors.append(Number(float(np.abs(theirs - own).mean()), u, what))
        rows.append(Evidence(f"{clause}, {case_label(case)}", reference, errors[0], "<", errors[1]))
    return rows


#: Tests of statements on the surface at pull-off, by name.
TESTS = {
    "pile_up_at_edge": pile_up_at_edge,
    "compressed_centre": compressed_centre,
    "contact_gap": contact_gap,
    "contact_edge": contact_edge,
    "centre_falls_with_k": centre_falls_with_k,
    "pile_up_rises": pile_up_rises,
    "band_narrows": band_narrows,
    "wider_zone": wider_zone,
    "equal_areas": equal_areas,
    "surface_nearer": surface_nearer,
}
