"""Measures of the surface at pull-off: pile-up, pressure, contact, cohesive zones, distances of two surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import CubicSpline

from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.paper.paper_figure import Plan, result_of, together
from comparisons.paper.solver_tasks import TRACTION, band_width, surface
from comparisons.paper.statements.measures import Made, measure, measured, of_case
from comparisons.paper.tasks import COHESIVE, cohesive_surface, profile

__all__: list[str] = []

#: Relative rounding of the radii of a Maugis-Dugdale contact, which are roots.
_ROOT_ROUNDING = 1e4 * EPS
#: Largest radius at which two surfaces are compared; numbers of radii of that, and of the mean gap.
_FARTHEST, _SAMPLES, _MEANS = 3.0, 501, 2001


def _surface(case: dict[str, float]) -> Plan[dict[str, Any]]:
    """Plan the surface at pull-off, its lists as arrays."""
    shape = yield from result_of(surface, *of_case(case))
    return {name: np.array(values) for name, values in shape.items()}


@measure("distance of the highest point of the surface from the edge, over the edge's radius")
def pile_up_distance(reference: str, case: dict[str, float]) -> Made:
    shape = yield from _surface(case)
    radius, top = shape["radius"], int(np.argmin(shape["deformation"]))
    edge = radius[np.argmin(shape["pressure"])]
    spacing = np.diff(radius)[max(top - 1, 0) : top + 1].max()
    return abs(radius[top] - edge) / edge, spacing / edge


@measure("least step of w outside the edge")
def step_outside(reference: str, case: dict[str, float]) -> Made:
    shape = yield from _surface(case)
    edge = int(np.argmin(shape["pressure"]))
    w, u = shape["deformation"][edge:], shape["u_deformation"][edge:]
    least = int(np.argmin(np.diff(w)))
    return np.diff(w)[least], u[least + 1] + u[least]


@measure("height of the pile-up above the centre at pull-off")
def pile_up_height(reference: str, case: dict[str, float]) -> Made:
    shape = yield from _surface(case)
    w, u = shape["deformation"], shape["u_deformation"]
    return w[0] - w.min(), u[0] + u[np.argmin(w)]


@measure("size of the deformation at the centre at pull-off")
def centre_deformation(reference: str, case: dict[str, float]) -> Made:
    shape = yield from _surface(case)
    return abs(shape["deformation"][0]), shape["u_deformation"][0]


@measure("pressure at the centre at pull-off")
def centre_pressure(reference: str, case: dict[str, float]) -> Made:
    if reference == "fscm":
        shape = yield from _surface(case)
        return shape["pressure"][0], shape["u_pressure"][0]
    values = yield from result_of(profile, reference, *of_case(case))
    return values["pressure"][0], values["u_distance"] * np.ptp(values["pressure"])


@measure("mean gap inside the edge")
def gap_inside(reference: str, case: dict[str, float]) -> Made:
    """Inside the radius of the largest tension, by a spline and by chords."""
    shape = yield from _surface(case)
    radius, gap = shape["radius"], shape["gap"]
    edge = float(radius[np.argmin(shape["pressure"])])
    x = np.linspace(0.0, edge, _MEANS)
    sizes = np.abs(CubicSpline(radius, gap)(x)), np.abs(np.interp(x, radius, gap))
    mean, rough = (float(np.trapezoid(sampled, x)) / edge for sampled in sizes)
    return mean, abs(mean - rough) + shape["u_gap"][radius <= edge].max()


@measure("width of the band with more than half of the strength, over its radius")
def width_of_band(reference: str, case: dict[str, float]) -> Made:
    band = yield from result_of(band_width, *of_case(case))
    return band["width"], band["u"]


@measure("width c - a of {0} at pull-off", "formula")
def zone_width(reference: str, case: dict[str, float], model: str) -> Made:
    zone = yield from result_of(cohesive_surface, model, *of_case(case))
    return zone["cohesive_radius"] - zone["contact_radius"], _ROOT_ROUNDING * zone["cohesive_radius"]


@measure("", "formula")
def law_area(reference: str, case: dict[str, float]) -> Made:
    yield {}
    tension, u = quad(lambda gap: float(TRACTION(np.array(gap))), 0.0, np.inf, epsabs=1e-13, epsrel=1e-13)
    return abs(-tension - 1.0), u, "difference from the work of adhesion: area of the 9-3 law"


@measure("difference from the work of adhesion: cohesive stress times the gap at c of {0}", "formula")
def zone_area(reference: str, case: dict[str, float], model: str) -> Made:
    """The area of a Maugis-Dugdale model is its cohesive stress times its gap at c, at which Eq. 69 ends the zone."""
    zone = yield from result_of(cohesive_surface, model, *of_case(case))
    stress = eta(case["n"]) if model == "md-improved" else THEORETICAL_STRENGTH
    radius, gap, edge = np.array(zone["radius"]), np.array(zone["gap"]), zone["cohesive_radius"]
    # The end of the zone is a sample of the surface; its neighbours tell what interpolation may miss.
    u = np.abs(radius - edge).min() * np.abs(np.gradient(gap, radius)).max() + _ROOT_ROUNDING
    return abs(stress * float(np.interp(edge, radius, gap)) - 1.0), stress * u


@measure("mean distance of the surface of {0} from {reference} inside the contact")
def distance_inside(reference: str, case: dict[str, float], model: str) -> Made:
    """Up to the smaller contact radius."""
    return (yield from _distance(reference, case, model, inside=True))


@measure("mean distance of the surface of {0} from {reference} outside the cohesive zone")
def distance_outside(reference: str, case: dict[str, float], model: str) -> Made:
    """From the larger cohesive radius on."""
    return (yield from _distance(reference, case, model, inside=False))


def _distance(reference: str, case: dict[str, float], model: str, *, inside: bool) -> Made:
    plans = {name: result_of(cohesive_surface, name, *of_case(case)) for name in COHESIVE}
    plans |= {"exact": result_of(profile, reference, *of_case(case))}
    plans |= {"at": measured("pull_off_displacement", reference, tuple(case.items()))}
    shapes = yield from together(plans)
    exact, at, zones = shapes["exact"], shapes["at"], [shapes[name] for name in COHESIVE]
    radius, gap = np.array(exact["radius"]), np.array(exact["gap"])
    if inside:
        ends = float(radius[0]), min(zone["contact_radius"] for zone in zones)
    else:
        ends = max(zone["cohesive_radius"] for zone in zones), _FARTHEST
    r = np.linspace(*ends, _SAMPLES)
    # The deformation is w = H + delta - f (Eq. 4); f is the same everywhere.
    own = np.interp(r, shapes[model]["radius"], shapes[model]["gap"]) + shapes[model]["displacement"]
    apart = np.abs(own - (CubicSpline(radius, gap)(r) + at.value)).mean()
    return apart, at.u + 2.0 * exact["u_distance"] * float(np.ptp(gap))
