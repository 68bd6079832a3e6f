"""Measures of the surface at pull-off: pile-up, pressure, contact, cohesive zones, distances of two surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.paper.paper_figure import Plan, result_of, together
from comparisons.paper.statements.evidence import Number
from comparisons.paper.statements.measures import Measured, Place, call, measure, term
from comparisons.paper.tasks import COHESIVE, band_width, cohesive_surface, profile, surface

__all__: list[str] = []

#: Relative rounding of the radii of a Maugis-Dugdale contact, which are roots.
_ROOT_ROUNDING = 1e4 * EPS
#: Largest radius at which two surfaces are compared; numbers of radii of that, and of the mean gap.
_FARTHEST, _SAMPLES, _MEANS = 3.0, 501, 2001

Shape = dict[str, NDArray[np.float64]]


def _surface(at: Place) -> Plan[Shape]:
    """Plan the surface at pull-off, its lists as arrays."""
    shape = yield from call(surface)(at)
    return {name: np.array(values) for name, values in shape.items()}


@measure("distance of the highest point of the surface from the edge, over the edge's radius", _surface)
def pile_up_distance(at: Place, shape: Shape) -> Measured:
    radius, top = shape["radius"], int(np.argmin(shape["deformation"]))
    edge = radius[np.argmin(shape["pressure"])]
    spacing = np.diff(radius)[max(top - 1, 0) : top + 1].max()
    return abs(radius[top] - edge) / edge, spacing / edge


@measure("least step of w outside the edge", _surface)
def step_outside(at: Place, shape: Shape) -> Measured:
    edge = int(np.argmin(shape["pressure"]))
    w, u = shape["deformation"][edge:], shape["u_deformation"][edge:]
    least = int(np.argmin(np.diff(w)))
    return np.diff(w)[least], u[least + 1] + u[least]


@measure("height of the pile-up above the centre at pull-off", _surface)
def pile_up_height(at: Place, shape: Shape) -> Measured:
    w, u = shape["deformation"], shape["u_deformation"]
    return w[0] - w.min(), u[0] + u[np.argmin(w)]


@measure("size of the deformation at the centre at pull-off", _surface)
def centre_deformation(at: Place, shape: Shape) -> Measured:
    return abs(shape["deformation"][0]), shape["u_deformation"][0]


def _of_reference(at: Place) -> Plan[dict[str, Any]]:
    return call(surface)(at) if at.reference == "fscm" else call(profile, "{reference}")(at)


@measure("pressure at the centre at pull-off", _of_reference)
def centre_pressure(at: Place, shape: dict[str, Any]) -> Measured:
    pressure = shape["pressure"]
    u = shape["u_pressure"][0] if at.reference == "fscm" else shape["u_distance"] * np.ptp(pressure)
    return pressure[0], u


@measure("mean gap inside the edge", _surface)
def gap_inside(at: Place, shape: Shape) -> Measured:
    """Inside the radius of the largest tension, by a spline and by chords."""
    radius, gap = shape["radius"], shape["gap"]
    edge = float(radius[np.argmin(shape["pressure"])])
    x = np.linspace(0.0, edge, _MEANS)
    sizes = np.abs(CubicSpline(radius, gap)(x)), np.abs(np.interp(x, radius, gap))
    mean, rough = (float(np.trapezoid(sampled, x)) / edge for sampled in sizes)
    return mean, abs(mean - rough) + shape["u_gap"][radius <= edge].max()


@measure("width of the band with more than half of the strength, over its radius", call(band_width))
def width_of_band(at: Place, band: dict[str, float]) -> Measured:
    return band["width"], band["u"]


@measure("width c - a of {0} at pull-off", call(cohesive_surface, "{0}"), model="formula")
def zone_width(at: Place, zone: dict[str, Any]) -> Measured:
    return zone["cohesive_radius"] - zone["contact_radius"], _ROOT_ROUNDING * zone["cohesive_radius"]


@measure(
    "difference from the work of adhesion: cohesive stress times the gap at c of {0}",
    call(cohesive_surface, "{0}"),
    model="formula",
)
def zone_area(at: Place, zone: dict[str, Any]) -> Measured:
    """The area of a Maugis-Dugdale model is its cohesive stress times its gap at c, at which Eq. 69 ends the zone."""
    stress = eta(at.n) if at.arguments[0] == "md-improved" else THEORETICAL_STRENGTH
    radius, gap, edge = np.array(zone["radius"]), np.array(zone["gap"]), zone["cohesive_radius"]
    # The end of the zone is a sample of the surface; its neighbours tell what interpolation may miss.
    u = np.abs(radius - edge).min() * np.abs(np.gradient(gap, radius)).max() + _ROOT_ROUNDING
    return abs(stress * float(np.interp(edge, radius, gap)) - 1.0), stress * u


def _zones(at: Place) -> Plan[dict[str, dict[str, Any]]]:
    return together({name: result_of(cohesive_surface, name, at.n, at.k, at.mu) for name in COHESIVE})


_BESIDE = _zones, call(profile, "{reference}"), term("pull_off_displacement")


@measure("mean distance of the surface of {0} from {reference} inside the contact", *_BESIDE)
def distance_inside(at: Place, zones: dict[str, Any], exact: dict[str, Any], displacement: Number) -> Measured:
    """Up to the smaller contact radius."""
    ends = float(exact["radius"][0]), min(zone["contact_radius"] for zone in zones.values())
    return _distance(zones[at.arguments[0]], exact, displacement, ends)


@measure("mean distance of the surface of {0} from {reference} outside the cohesive zone", *_BESIDE)
def distance_outside(at: Place, zones: dict[str, Any], exact: dict[str, Any], displacement: Number) -> Measured:
    """From the larger cohesive radius on."""
    ends = max(zone["cohesive_radius"] for zone in zones.values()), _FARTHEST
    return _distance(zones[at.arguments[0]], exact, displacement, ends)


def _distance(zone: dict[str, Any], exact: dict[str, Any], displacement: Number, ends: tuple[float, float]) -> Measured:
    radius, gap = np.array(exact["radius"]), np.array(exact["gap"])
    r = np.linspace(*ends, _SAMPLES)
    # The deformation is w = H + delta - f (Eq. 4); f is the same everywhere.
    of_zone = np.interp(r, zone["radius"], zone["gap"]) + zone["displacement"]
    apart = np.abs(of_zone - (CubicSpline(radius, gap)(r) + displacement.value)).mean()
    return apart, displacement.u + 2.0 * exact["u_distance"] * float(np.ptp(gap))
