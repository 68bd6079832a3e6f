"""The front door: one number of one contact problem, with its uncertainty; and the equilibrium path.

Physical quantities in any consistent units go in and come out.  The mesh is chosen here: first by the length
over which the surface law and the solid balance, then by the width of the contact edge in the computed
profile.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_reference.contact import Contact
from fem_reference.errors import NotConverged
from fem_reference.events import LOSSES, QUANTITIES, Event, find_event, locate, walk
from fem_reference.modulus import Modulus, OffsetPowerLaw, PowerLaw
from fem_reference.path import EDGE_RISE, Point, edge_width
from fem_reference.punch import Punch, radius_at_height
from fem_reference.surface import MeshSpec, compliance_for
from fem_reference.traction import LennardJones
from fem_reference.uncertainty import three_meshes

__all__ = [
    "ACCURACIES",
    "CustomSolid",
    "Path",
    "Profile",
    "Solid",
    "Solution",
    "event_state",
    "profile",
    "solve",
    "solve_together",
    "trace",
]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Accuracy:
    """Element order and the three mesh densities, coarse to fine."""

    order: int
    densities: tuple[float, float, float]


ACCURACIES = {
    "quick": Accuracy(6, (1.4, 1.15, 0.95)),
    "default": Accuracy(6, (1.05, 0.85, 0.69)),
    "fine": Accuracy(6, (0.75, 0.61, 0.5)),
}
"""Measured on n = 2, 9-3 law: pull-off forces to 1e-6, 1e-7 and 1e-8 of their value."""

APEX_WIDTH = 0.05
"""Radial length resolved at r = 0, relative to the edge radius: a cone then has its pull-off force to
3e-10."""

LAYER_DEPTH = 0.02
"""Depth resolved under the surface relative to the edge width, times min(1, 5 k): the first layer's error is
linear in its thickness for 0 < k < 0.2, where z^(1-k) and z are hard to tell apart."""

WIDTH_SHARE = 0.18
"""Resolved edge width relative to the length over which the gap rises by z0 at the edge."""

FAR_HEIGHT = 1e4
"""Height of the punch, in z0, at the end of the mesh: beyond it the traction enters P in closed form and its
displacement (below 1e-8 z0 even for a cone) is dropped."""

LARGEST_EXTENT = 1e8
"""Of a mesh, in units of its edge radius.  It costs an element for each factor of two."""

HOMOGENEOUS_DEPTH = 64.0
"""End of the mesh relative to the depth over which the modulus leaves its surface law: the exterior beyond takes
it for the power law of great depth (measured: four times as far changes displacements by 1.3e-7 z0 at most)."""

GAP_ORDER = 2.0
"""Declared order of the central gap at jump-out, in contact: the stress under the tip of a cone is singular, which
decides it, not the element (measured worst error / u_num with the element's order: 1.15 at n = 1, k = 0.6, mu = 3)."""

REFINEMENTS = 8
"""Attempts to find the edge width before the search is given up."""


@dataclass(frozen=True, slots=True)
class Solid:
    """Half-space with E = E0 ((z + z_s) / c0)^k and a constant Poisson ratio.

    Examples
    --------
    >>> Solid(E0=1.0, c0=1.0, k=0.4, nu=0.5)
    Traceback (most recent call last):
    ValueError: Poisson ratio nu = 0.5 is outside [0, 0.5): ...
    """

    E0: float
    c0: float
    k: float
    nu: float
    z_s: float = 0.0

    def __post_init__(self) -> None:
        _check_poisson(self.nu)
        if self.z_s < 0:
            raise ValueError(f"surface offset z_s = {self.z_s} is negative: the modulus would vanish inside the solid")
        self.modulus  # noqa: B018  (validates the rest)

    @property
    def modulus(self) -> Modulus:
        """E(z)."""
        if self.z_s > 0:
            return OffsetPowerLaw(self.E0, self.c0, self.k, self.z_s)
        return PowerLaw(self.E0, self.c0, self.k)


@dataclass(frozen=True, slots=True)
class CustomSolid:
    """Half-space with any modulus E(z) and a constant Poisson ratio."""

    modulus: Modulus
    nu: float

    def __post_init__(self) -> None:
        _check_poisson(self.nu)


def _check_poisson(nu: float) -> None:
    if not 0 <= nu < 0.5:
        raise ValueError(
            f"Poisson ratio nu = {nu} is outside [0, 0.5): displacement elements cannot keep the volume; "
            "take nu = 0.499 or less"
        )


@dataclass(frozen=True, slots=True)
class Solution:
    """One quantity, in the units of the input.

    Attributes
    ----------
    value, u_num : float
        The quantity and a bound on its numerical error.
    size : int
        Unknowns of the finest finite-element mesh.
    iterations : int
        Newton steps along the path on the finest mesh.
    residual : float
        Residual of the equilibrium at the event, in units of z0.
    seconds : float
        Wall-clock time of everything.
    observed_order : float
        Order of convergence in the mesh density over the three meshes.
    densities, values : tuple of float
        The meshes, coarse to fine, and the quantity on each.
    """

    value: float
    u_num: float
    size: int
    iterations: int
    residual: float
    seconds: float
    observed_order: float
    densities: tuple[float, float, float]
    values: tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """The equilibrium path: arrays of approach, load (tension negative), gap at r = 0, edge radius."""

    displacement: Array
    load: Array
    central_gap: Array
    contact_radius: Array


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Surface state at a point of the path: radius, gap, pressure (compression positive), displacement."""

    r: Array
    gap: Array
    pressure: Array
    displacement: Array


def solve(
    solid: Solid | CustomSolid, punch: Punch, law: LennardJones, quantity: str, accuracy: str = "default"
) -> Solution:
    """Compute one quantity with its numerical uncertainty from three meshes.

    Parameters
    ----------
    solid, punch, law
        The problem, in consistent units.
    quantity : str
        One of `QUANTITIES` or `LOSSES`.
    accuracy : {"default", "fine", "quick"}
        Mesh densities.

    Returns
    -------
    Solution

    Raises
    ------
    ValueError
        For an unknown quantity or accuracy.
    NoSuchEvent
        If the path has no such point.
    NotConverged
        If an iteration misses its tolerance.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Solid, solve
    >>> sphere, law = PowerPunch(n=2.0, Q=1.0), LennardJones(work_of_adhesion=1.0, z0=1.0)
    >>> solid = Solid(E0=1.0, c0=1.0, k=0.0, nu=0.0)  # Tabor's ratio (Q w^2 / E*^2 z0^3)^(1/3) is 1
    >>> answer = solve(solid, sphere, law, "pull_off_force", accuracy="quick")
    >>> abs(answer.value / (3.141592653589793 * 1.67066478) - 1.0) < 1e-5
    True
    """
    return solve_together(solid, punch, law, (quantity,), accuracy)[quantity]


def solve_together(
    solid: Solid | CustomSolid,
    punch: Punch,
    law: LennardJones,
    quantities: Sequence[str],
    accuracy: str = "default",
) -> dict[str, Solution]:
    """Compute several quantities on the meshes that suit the first of them, walking each path once.

    Parameters
    ----------
    solid, punch, law, accuracy
        As for `solve`.
    quantities : sequence of str
        Of `QUANTITIES` and `LOSSES`.  The mesh of a solid that is no power law is finest at the edge of the first:
        others whose edge is elsewhere are less certain, and say so.

    Returns
    -------
    dict of str to Solution
        `seconds` are those of all together.

    Raises
    ------
    ValueError, NoSuchEvent, NotConverged
        As `solve`, if one of them fails.
    """
    for quantity in quantities:
        _check_request(quantity, accuracy)
    begin = time.perf_counter()
    level = ACCURACIES[accuracy]
    problem = _Problem(solid, punch, law)
    spec, size = problem.adapted(quantities[0], level)
    walks = [walk(problem.contact(problem.at_density(spec, density), size)) for density in level.densities]
    found = {quantity: [locate(points, quantity) for points in walks] for quantity in quantities}
    ratio = math.sqrt(level.densities[0] / level.densities[2])
    solutions = {}
    for quantity, events in found.items():
        coarse, medium, fine = (value for value, _ in events)
        scale = problem.scale(quantity, fine)
        order = GAP_ORDER if quantity == "jump_out_gap" else level.order
        outcome = three_meshes((coarse, medium, fine), ratio, order, scale)
        point = events[-1][1]
        solutions[quantity] = Solution(
            outcome.value,
            outcome.u_num,
            point.leg.contact.compliance.unknowns,
            sum(p.state.iterations for p in walks[-1]),
            point.state.residual,
            time.perf_counter() - begin,
            outcome.observed_order,
            level.densities,
            (coarse, medium, fine),
        )
    return solutions


def trace(solid: Solid | CustomSolid, punch: Punch, law: LennardJones, accuracy: str = "default") -> Path:
    """Walk the equilibrium path from far away until the load is compressive, on the finest mesh.

    Raises
    ------
    ValueError
        For an unknown accuracy.
    NotConverged
        If the path cannot be followed.
    """
    _check_request("zero_load_displacement", accuracy)
    level = ACCURACIES[accuracy]
    problem = _Problem(solid, punch, law)
    spec, size = problem.adapted("zero_load_displacement", level)
    points = walk(problem.contact(problem.at_density(spec, level.densities[-1]), size))
    return Path(
        np.array([p.state.displacement for p in points]),
        np.array([p.state.load for p in points]),
        np.array([p.state.central_gap for p in points]),
        np.array([p.contact_radius for p in points]),
    )


def event_state(
    solid: Solid | CustomSolid,
    punch: Punch,
    law: LennardJones,
    quantity: str = "pull_off_force",
    accuracy: str = "default",
) -> tuple[MeshSpec, Point]:
    """Equilibrium at an event on the finest mesh, with the mesh: what fields and cross-checks start from.

    Raises
    ------
    ValueError
        For an unknown quantity or accuracy.
    NoSuchEvent
        If the path has no such point.
    NotConverged
        If an iteration misses its tolerance.
    """
    _check_request(quantity, accuracy)
    level = ACCURACIES[accuracy]
    problem = _Problem(solid, punch, law)
    spec, size = problem.adapted(quantity, level)
    spec = problem.at_density(spec, level.densities[-1])
    return spec, problem.event(quantity, spec, size).point


def profile(
    solid: Solid | CustomSolid,
    punch: Punch,
    law: LennardJones,
    quantity: str = "pull_off_force",
    accuracy: str = "default",
    radii: Array | None = None,
) -> Profile:
    """Surface gap, pressure and displacement at an event, at the Gauss points or at the wanted radii.

    Raises
    ------
    ValueError
        For an unknown quantity or accuracy, or radii beyond the mesh.
    NotConverged
        If the path cannot be followed.
    """
    _, point = event_state(solid, punch, law, quantity, accuracy)
    mesh = point.leg.contact.compliance.trace
    y = point.state.y
    s = mesh.s if radii is None else np.asarray(radii, float) / y[-1]
    if s.min() < 0 or s.max() > mesh.extent:
        raise ValueError(f"radii up to {s.max() * y[-1]:.4g} leave the mesh, which ends at {mesh.extent * y[-1]:.4g}")
    w = mesh.evaluate(s) @ y[:-2]
    gap = -y[-2] + punch.height(s * y[-1]) + w
    return Profile(s * y[-1], gap, law.traction(gap), w)


def _check_request(quantity: str, accuracy: str) -> None:
    if quantity not in QUANTITIES + LOSSES:
        raise ValueError(f"quantity {quantity!r} is unknown; choose one of {', '.join(QUANTITIES + LOSSES)}")
    if accuracy not in ACCURACIES:
        raise ValueError(f"accuracy {accuracy!r} is unknown; choose one of {', '.join(ACCURACIES)}")


@dataclass(frozen=True, slots=True)
class _Problem:
    """Solid, punch and law, with the choice of the mesh."""

    solid: Solid | CustomSolid
    punch: Punch
    law: LennardJones

    def contact(self, spec: MeshSpec, size: float) -> Contact:
        return Contact(self.punch, self.law, compliance_for(self.solid.modulus, self.solid.nu, spec, size))

    def event(self, quantity: str, spec: MeshSpec, size: float) -> Event:
        return find_event(self.contact(spec, size), quantity)

    def at_density(self, spec: MeshSpec, density: float) -> MeshSpec:
        return MeshSpec(spec.edge_width, spec.surface_depth, spec.extent, density, spec.order, spec.apex_width)

    def scale(self, quantity: str, value: float) -> float:
        """Size of a quantity, for the floor of its uncertainty."""
        return max(abs(value), self.law.z0) if "force" not in quantity and "energy" not in quantity else abs(value)

    def spec(self, width: float, size: float, level: Accuracy, smallest: float) -> MeshSpec:
        """Mesh for an edge of that relative width; lengths are rounded so that similar cases share a mesh.

        Also where its edge has the radius `smallest`, the mesh ends where the punch is `FAR_HEIGHT` high.
        """
        modulus = self.solid.modulus
        k = modulus.surface_exponent
        width = 2.0 ** math.floor(math.log2(min(max(width, 1e-6), 0.25)))
        depth = LAYER_DEPTH * width * min(1.0, 5.0 * k) if k > 0 else 0.3 * width
        if math.isfinite(modulus.surface_depth):
            depth = min(depth, 0.2 * modulus.surface_depth / size)
        far = radius_at_height(self.punch, FAR_HEIGHT * self.law.z0)
        deep = HOMOGENEOUS_DEPTH * modulus.surface_depth / size if math.isfinite(modulus.surface_depth) else 0.0
        extent = 2.0 ** math.ceil(math.log2(min(max(far / smallest, 50.0, deep), LARGEST_EXTENT)))
        return MeshSpec(width, depth, extent, level.densities[0], level.order, APEX_WIDTH)

    def first_width(self, radius: float) -> float:
        """Relative length over which traction and stiffness balance, at a contact of that radius."""
        law = self.law
        depth = np.array(radius)
        for _ in range(40):
            # E(l) z0 / l = traction: solved by fixed point in log l.
            E = float(self.solid.modulus(depth)) / (1.0 - self.solid.nu**2)
            depth = np.sqrt(depth * E * law.z0**2 / (2.0 * law.work_of_adhesion))
        return 0.5 * float(depth) / radius

    def adapted(self, quantity: str, level: Accuracy) -> tuple[MeshSpec, float]:
        """Mesh whose edge width (and, if the solid does not scale, size) fits the computed profile."""
        scaling = isinstance(self.solid.modulus, PowerLaw)
        size = 2.0 * radius_at_height(self.punch, self.law.z0)
        width = self.first_width(size)
        smallest = radius_at_height(self.punch, EDGE_RISE * self.law.z0)
        spec = self.spec(width, size, level, smallest)
        for _ in range(REFINEMENTS):
            try:
                points = walk(self.contact(spec, size))
            except NotConverged:
                # An under-resolved edge is pinned to the elements, and its path may not be traversable.
                spec = self.spec(0.25 * spec.edge_width, size, level, smallest)
                continue
            if quantity not in ("zero_load_displacement", "hysteresis_energy", "jump_in_energy"):
                # Beyond the pull-off the edge is sharper relative to its radius, but nobody asked.
                deepest = min(range(len(points)), key=lambda i: points[i].state.load)
                points_used = points[: deepest + 2]
            else:
                points_used = points
            widths = [edge_width(point) for point in points_used if point.leg.touching]
            if scaling:
                # Contact may be born on a spot much smaller than the punch, and the mesh shrinks with it.
                smallest = min(smallest, *(point.state.size for point in points_used))
            needed = self.spec(WIDTH_SHARE * min(widths, default=1.0), size, level, smallest)
            if needed.edge_width >= spec.edge_width and needed.extent <= spec.extent:
                if scaling:
                    return spec, size
                point = locate(points, quantity)[1]
                if not point.leg.touching or abs(point.contact_radius / size - 1.0) <= 0.5 * spec.edge_width:
                    return spec, size
                size = point.contact_radius
            spec = self.spec(min(needed.edge_width, spec.edge_width), size, level, smallest)
        raise NotConverged("the width of the contact edge was not found; the edge is finer than the mesh can follow")
