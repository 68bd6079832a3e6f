"""Tests of the surface at pull-off: pile-up, pressure, contact zone, and the width of the band of large tension."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from comparisons.data.paper_statements import PaperStatement
from comparisons.models.solver import translated
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig05_07_pull_off_surfaces import surface
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.sources import Case, StatementTest, case_label, grid, reading, witnesses
from comparisons.paper.statements.trends import families, one_way
from comparisons.paper.tasks import profile
from fscm import Analysis, NoSuchEvent, NotConverged
from fscm.laws import LennardJones
from fscm.problem import Problem
from fscm.solution import FLOOR, SAFETY, State

__all__ = ["TESTS", "band_width", "half_strength_gaps"]

Json = dict[str, Any]
Comparisons = Callable[[PaperStatement, Case, Json], list[Evidence]]

_LAW = LennardJones()


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

    def radius_of(gap: float) -> float:
        return float(brentq(lambda r: _gap_at(state, r) - gap, 0.0, outer, xtol=1e-14))

    near, far = (radius_of(gap) for gap in half_strength_gaps())
    return (far - near) / radius_of(float(_LAW.peak_gap))


def _gap_at(state: State, radius: float) -> float:
    return float(state.disc.mesh.evaluate(state.gap, np.array([radius / state.scale]))[0])


def _surface_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(surface, *case) for case in grid(statement)]


def _each_surface(comparisons: Comparisons) -> StatementTest:
    """Return the test that compares numbers of every surface of a grid."""

    def evidence(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
        return [
            row
            for case in grid(statement)
            for row in comparisons(statement, case, results[CachedCall.of(surface, *case)])
        ]

    return StatementTest(_surface_tasks, evidence)


def _pile_up(statement: PaperStatement, case: Case, values: Json) -> list[Evidence]:
    """The surface is pulled up most at the edge, and less and less outside."""
    radius, w, u = (np.array(values[name]) for name in ("radius", "deformation", "u_deformation"))
    edge, top = int(np.argmin(values["pressure"])), int(np.argmin(w))
    spacing = float(np.diff(radius)[max(top - 1, 0) : top + 1].max())
    apart = Number(
        abs(radius[top] - radius[edge]) / radius[edge],
        spacing / radius[edge],
        f"distance of the highest point of the surface from the edge, over the edge's radius, {case_label(case)}",
    )
    outside = np.arange(len(radius)) >= edge
    steps, bounds = np.diff(w[outside]), u[outside][1:] + u[outside][:-1]
    least = int(np.argmin(steps))
    falling = Number(float(steps[least]), float(bounds[least]), f"least step of w outside the edge, {case_label(case)}")
    return [
        Evidence(case_label(case), "fscm", apart, "<", reading(statement)),
        Evidence(case_label(case), "fscm", falling, ">", Number(0.0, 0.0, "w approaches zero from below")),
    ]


def _centre(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The pressure at the centre is compressive."""
    rows = []
    for case in grid(statement):
        values = results[CachedCall.of(surface, *case)]
        rows.append(_compressed("fscm", values["pressure"][0], values["u_pressure"][0], case))
    for case in witnesses(statement):
        values = results[CachedCall.of(profile, "fem", *case)]
        u = values["u_distance"] * float(np.ptp(values["pressure"]))
        rows.append(_compressed("fem", values["pressure"][0], u, case))
    return rows


def _compressed(model: str, pressure: float, u: float, case: Case) -> Evidence:
    value = Number(pressure, u, f"pressure at the centre at pull-off, {case_label(case)}")
    return Evidence(case_label(case), model, value, ">", Number(0.0, 0.0, "compressive"))


def _centre_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [*_surface_tasks(statement), *(CachedCall.of(profile, "fem", *case) for case in witnesses(statement))]


def _mean_gap(case: Case, values: Json) -> Number:
    """Mean of the gap's size inside the radius of the largest tension."""
    radius, gap, u = (np.array(values[name]) for name in ("radius", "gap", "u_gap"))
    edge = float(radius[np.argmin(values["pressure"])])
    x = np.linspace(0.0, edge, 2001)
    size = np.abs(CubicSpline(radius, gap)(x))
    linear = np.abs(np.interp(x, radius, gap))
    mean, rough = (float(np.trapezoid(sampled, x)) / edge for sampled in (size, linear))
    return Number(
        mean, abs(mean - rough) + float(u[radius <= edge].max()), f"mean gap inside the edge, {case_label(case)}"
    )


def _from_mu(statement: PaperStatement, case: Case) -> str:
    """Below the limit from one Tabor number on, and above it at a smaller one."""
    return "<" if case[2] >= float(statement.arguments["from_mu"]) else ">"


def _gap_size(statement: PaperStatement, case: Case, values: Json) -> list[Evidence]:
    """The mean gap in the contact is below a limit from one Tabor number on, and above it at a small one."""
    mean, relation = _mean_gap(case, values), _from_mu(statement, case)
    return [Evidence(case_label(case), "fscm", mean, relation, reading(statement))]


def _centre_falls(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Deformation and pressure at the centre fall with k."""
    rows = []
    for label, cases in families(statement, "k").items():
        for name, title in (("deformation", "size of the deformation"), ("pressure", "pressure")):
            numbers = []
            for case in cases:
                values = results[CachedCall.of(surface, *case)]
                what = f"{title} at the centre at pull-off, {case_label(case)}"
                numbers.append(Number(abs(values[name][0]), values[f"u_{name}"][0], what))
            rows += one_way(label, "fscm", numbers, "<")
    return rows


def _pile_up_heights(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The pile-up above the centre rises with k."""
    rows = []
    for label, cases in families(statement, "k").items():
        numbers = []
        for case in cases:
            values = results[CachedCall.of(surface, *case)]
            w, u = np.array(values["deformation"]), np.array(values["u_deformation"])
            what = f"height of the pile-up above the centre at pull-off, {case_label(case)}"
            numbers.append(Number(float(w[0] - w.min()), float(u[0] + u[np.argmin(w)]), what))
        rows += one_way(label, "fscm", numbers, ">")
    return rows


def _width_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(band_width, *case) for case in grid(statement)]


def _widths(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The band of large tension becomes narrower along the cases."""
    return [
        row
        for label, cases in families(statement, str(statement.arguments["along"])).items()
        for row in one_way(label, "fscm", [_width_of(case, results) for case in cases], "<")
    ]


def _edges(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The band of large tension is narrow from one Tabor number on, and wide at a smaller one."""
    return [
        Evidence(case_label(case), "fscm", _width_of(case, results), _from_mu(statement, case), reading(statement))
        for case in grid(statement)
    ]


def _width_of(case: Case, results: Results) -> Number:
    band = results[CachedCall.of(band_width, *case)]
    return Number(band["width"], band["u"], _width_title(case))


def _width_title(case: Case) -> str:
    return f"width of the band with more than half of the strength, over its radius, {case_label(case)}"


#: Tests of statements on the surface at pull-off, by name.
TESTS = {
    "pile_up_at_edge": _each_surface(_pile_up),
    "compressed_centre": StatementTest(_centre_tasks, _centre),
    "contact_gap": _each_surface(_gap_size),
    "contact_edge": StatementTest(_width_tasks, _edges),
    "centre_falls_with_k": StatementTest(_surface_tasks, _centre_falls),
    "pile_up_rises": StatementTest(_surface_tasks, _pile_up_heights),
    "band_narrows": StatementTest(_width_tasks, _widths),
}
