"""Measures of equilibrium paths, as turning points, and of the surface at pull-off, as pile-up and cohesive zones."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import beta

from comparisons.model import Array
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.numerics.curve_distance import curve_distance as distance_of
from comparisons.paper.plan import Plan, result_of, together
from comparisons.paper.statements.measures import ROUNDING, Measured, Number, Place, call, measure, term
from comparisons.paper.tasks import COHESIVE, band_width, cohesive_surface, curve, near_critical, profile, surface

__all__ = ["count_jumps", "turning_points"]

#: A path or a surface: arrays by name, and their bounds.
Path = dict[str, Any]

#: Central gap from which the two bodies count as far apart: the paper begins there (Sec. 2.4).
_FAR = 10.0
#: Excesses of the Tabor number over the critical one, of which the distances of the gaps are compared.
_EXCESSES = (1e-4, 1e-2)
#: Relative rounding of the radii of a Maugis-Dugdale contact, which are roots.
_ROOT_ROUNDING = 1e4 * EPS
#: Largest radius at which two surfaces are compared; numbers of radii of that, and of the mean gap.
_FARTHEST, _SAMPLES, _MEANS = 3.0, 501, 2001


def turning_points(displacement: Array, u: float) -> list[int]:
    """Return the points where a displacement turns back by more than twice its bound.

    Examples
    --------
    >>> turning_points(np.array([0.0, 2.0, 1.0, 1.5, 1.4999, 3.0]), 0.001)
    [1, 2]
    """
    turns: list[int] = []
    extreme, rising = 0, True
    for i, value in enumerate(displacement):
        ahead = value - displacement[extreme] if rising else displacement[extreme] - value
        if ahead >= 0.0:
            extreme = i
        elif ahead < -2.0 * u:
            turns.append(extreme)
            extreme, rising = i, not rising
    return turns


def count_jumps(displacement: Array, u: float) -> int:
    """Return how many jumps a machine that controls the displacement sees while it approaches and while it retracts.

    A jump ends where the path rises again to the displacement at which it began; what is between is passed over.

    Examples
    --------
    >>> count_jumps(np.array([0.0, 3.0, 1.0, 2.0, -1.0, 4.0]), 0.001)          # one inside another
    2
    >>> count_jumps(np.array([0.0, 2.0, 1.0, 3.0, -1.0, 4.0]), 0.001)          # two maxima
    3
    """
    count = 0
    for path in (displacement, -displacement[::-1]):
        maxima = path[turning_points(path, u)[::2]]
        # A maximum below one that was passed before it is on a part of the path that the jump leaves out.
        count += len(np.unique(np.maximum.accumulate(maxima)))
    return count


#: Paths of the reference, and of the model that the term names.
_PATH, _PATH_OF_MODEL = call(curve, "{reference}"), call(curve, "{0}")


@measure("largest step of the central gap along the path", _PATH)
def gap_step(at: Place, path: Path) -> Measured:
    # The gap is as certain as the displacement: delta = -H_0 + w(0) (Eq. 33).
    return np.diff(path["central_gap"]).max(), 2.0 * path["u_displacement"]


@measure("", _PATH)
def turns_of_displacement(at: Place, path: Path) -> Measured:
    displacement, u = path["displacement"], path["u_displacement"]
    turns = turning_points(displacement, u)
    rise = max((displacement[turns[2:-1:2]] - displacement[turns[1:-1:2]]), default=0)
    again = f", between them the displacement rises again by at least {rise:.5f} (bound {2 * u:.1g})" if rise else ""
    return len(turns), 0.0, f"turning points of the displacement, {at.label}{again}"


@measure("jumps under displacement control", _PATH)
def jumps_seen(at: Place, path: Path) -> Measured:
    return count_jumps(path["displacement"], path["u_displacement"]), 0.0


@measure("largest |delta + H_0| / H_0 from H_0 = 10 on", _PATH)
def far_deformation(at: Place, path: Path) -> Measured:
    gap = path["central_gap"]
    far = gap >= _FAR
    return np.max(np.abs(gap + path["displacement"])[far] / gap[far]), path["u_displacement"] / _FAR


@measure("largest |P| over the pull-off force from H_0 = 10 on", _PATH)
def far_load(at: Place, path: Path) -> Measured:
    load, depth = path["load"], -path["load"].min()
    return np.max(np.abs(load)[path["central_gap"] >= _FAR] / depth), 2.0 * path["u_load"] / depth


@measure("distance of the curves, {0} from {reference}", _PATH, _PATH_OF_MODEL)
def curve_distance(at: Place, exact: Path, path: Path) -> Measured:
    x, y = exact["displacement"], exact["load"]
    # Both bounds as shares of the picture, in which the distance is measured.
    bound = exact["u_displacement"] / np.ptp(x) + exact["u_load"] / np.ptp(y)
    distance = distance_of(path["displacement"], path["load"], x, y)
    return distance.value, distance.u_interpolation + 2.0 * bound


@measure("largest difference of the loads of {0} and {reference} over the pull-off force", _PATH, _PATH_OF_MODEL)
def load_difference(at: Place, exact: Path, path: Path) -> Measured:
    """At one displacement, from the pull-off to the end of the path."""
    (x, y), (model_x, model_y) = _branch(exact), _branch(path)
    inside = (x >= model_x[0]) & (x <= model_x[-1])
    linear, spline = np.interp(x[inside], model_x, model_y), CubicSpline(model_x, model_y)(x[inside])
    depth = -float(y.min())
    return np.abs(spline - y[inside]).max() / depth, (np.abs(spline - linear).max() + exact["u_load"]) / depth


def _branch(path: Path) -> tuple[Array, Array]:
    """Displacements and loads from the smallest load on, where the displacement rises."""
    start = int(np.argmin(path["load"]))
    x, y = path["displacement"][start:], path["load"][start:]
    rising = np.concatenate([[True], np.diff(x) > 0.0])
    return x[rising], y[rising]


@measure("distance of the gaps against the square root of the excess", lambda at: result_of(near_critical, at.n, at.k))
def gap_cusp(at: Place, onset: dict[str, Any]) -> Measured:
    distances, u = [], 0.0
    for excess in _EXCESSES:
        jump = next(row for row in onset["jumps"] if abs(row["mu"] / onset["mu"] - 1.0 - excess) < 1e-9)
        distances.append(jump["jump_in_gap"] - jump["jump_out_gap"])
        u = u + jump["u_jump_in_gap"] + jump["u_jump_out_gap"]
    ratio = distances[0] / distances[1] / (_EXCESSES[0] / _EXCESSES[1]) ** 0.5
    return abs(ratio - 1.0), ratio * u * (1.0 / distances[0] + 1.0 / distances[1])


@measure("repulsive over attractive term of Eq. {0} at jump-in", term("jump_in_gap"))
def repulsion(at: Place, gap: Number) -> Measured:
    b = ((1.0 - at.k) if at.arguments[0] == "41" else 2.0) / at.n
    share = float(beta(9.0 - b, b) / beta(3.0 - b, b)) / (gap.value + 1.0) ** 6
    return share, share * (6.0 * gap.u / (gap.value + 1.0) + ROUNDING)


#: The surface at pull-off.
_SURFACE = call(surface)


@measure("distance of the highest point of the surface from the edge, over the edge's radius", _SURFACE)
def pile_up_distance(at: Place, shape: Path) -> Measured:
    radius, top = shape["radius"], int(np.argmin(shape["deformation"]))
    edge = radius[np.argmin(shape["pressure"])]
    spacing = np.diff(radius)[max(top - 1, 0) : top + 1].max()
    return abs(radius[top] - edge) / edge, spacing / edge


@measure("least step of w outside the edge", _SURFACE)
def step_outside(at: Place, shape: Path) -> Measured:
    edge = int(np.argmin(shape["pressure"]))
    w, u = shape["deformation"][edge:], shape["u_deformation"][edge:]
    least = int(np.argmin(np.diff(w)))
    return np.diff(w)[least], u[least + 1] + u[least]


@measure("height of the pile-up above the centre at pull-off", _SURFACE)
def pile_up_height(at: Place, shape: Path) -> Measured:
    w, u = shape["deformation"], shape["u_deformation"]
    return w[0] - w.min(), u[0] + u[np.argmin(w)]


@measure("size of the deformation at the centre at pull-off", _SURFACE)
def centre_deformation(at: Place, shape: Path) -> Measured:
    return abs(shape["deformation"][0]), shape["u_deformation"][0]


def _of_reference(at: Place) -> Plan[Path]:
    return _SURFACE(at) if at.reference == "fscm" else call(profile, "{reference}")(at)


@measure("pressure at the centre at pull-off", _of_reference)
def centre_pressure(at: Place, shape: Path) -> Measured:
    pressure = shape["pressure"]
    u = shape["u_pressure"][0] if at.reference == "fscm" else shape["u_distance"] * np.ptp(pressure)
    return pressure[0], u


@measure("mean gap inside the edge", _SURFACE)
def gap_inside(at: Place, shape: Path) -> Measured:
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
def zone_width(at: Place, zone: Path) -> Measured:
    return zone["cohesive_radius"] - zone["contact_radius"], _ROOT_ROUNDING * zone["cohesive_radius"]


_AREA = "difference from the work of adhesion: cohesive stress times the gap at c of {0}"


@measure(_AREA, call(cohesive_surface, "{0}"), model="formula")
def zone_area(at: Place, zone: Path) -> Measured:
    """The area of a Maugis-Dugdale model is its cohesive stress times its gap at c, at which Eq. 69 ends the zone."""
    stress = eta(at.n) if at.arguments[0] == "md-improved" else THEORETICAL_STRENGTH
    radius, gap, edge = zone["radius"], zone["gap"], zone["cohesive_radius"]
    # The end of the zone is a sample of the surface; its neighbours tell what interpolation may miss.
    u = np.abs(radius - edge).min() * np.abs(np.gradient(gap, radius)).max() + _ROOT_ROUNDING
    return abs(stress * float(np.interp(edge, radius, gap)) - 1.0), stress * u


def _zones(at: Place) -> Plan[dict[str, Path]]:
    return together({name: call(cohesive_surface, name)(at) for name in COHESIVE})


_BESIDE = _zones, call(profile, "{reference}"), term("pull_off_displacement")


@measure("mean distance of the surface of {0} from {reference} inside the contact", *_BESIDE)
def distance_inside(at: Place, zones: dict[str, Path], exact: Path, displacement: Number) -> Measured:
    """Up to the smaller contact radius."""
    ends = float(exact["radius"][0]), min(zone["contact_radius"] for zone in zones.values())
    return _distance(zones[at.arguments[0]], exact, displacement, ends)


@measure("mean distance of the surface of {0} from {reference} outside the cohesive zone", *_BESIDE)
def distance_outside(at: Place, zones: dict[str, Path], exact: Path, displacement: Number) -> Measured:
    """From the larger cohesive radius on."""
    ends = max(zone["cohesive_radius"] for zone in zones.values()), _FARTHEST
    return _distance(zones[at.arguments[0]], exact, displacement, ends)


def _distance(zone: Path, exact: Path, displacement: Number, ends: tuple[float, float]) -> Measured:
    gap = exact["gap"]
    r = np.linspace(*ends, _SAMPLES)
    # The deformation is w = H + delta - f (Eq. 4); f is the same everywhere.
    of_zone = np.interp(r, zone["radius"], zone["gap"]) + zone["displacement"]
    apart = np.abs(of_zone - (CubicSpline(exact["radius"], gap)(r) + displacement.value)).mean()
    return apart, displacement.u + 2.0 * exact["u_distance"] * float(np.ptp(gap))
