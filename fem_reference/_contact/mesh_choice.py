"""Choice of the mesh: three densities an accuracy, and an edge as fine as the computed gap needs.

The first width of the contact edge is the length over which the surface law and the solid balance; the path traced
on that mesh shows how wide the edge is, and the mesh is made again until it is fine enough.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.events import PathEvents, beyond_pull_off
from fem_reference._contact.path import EDGE_RISE, edge_width
from fem_reference._contact.tracing import traced
from fem_reference._elastic.compliance import compliance_for, scaled_modulus
from fem_reference._elastic.depth_scales import depth_scales
from fem_reference._elastic.exterior import exterior_error
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import Level, finer_levels
from fem_reference.errors import NotConverged
from fem_reference.modulus import PowerLawModulus
from fem_reference.problem import Problem
from fem_reference.punch import check_without_asperities, radius_at_height

__all__ = ["MeshChoice", "chosen"]

APEX_WIDTH = 0.05
"""Radial length resolved at r = 0, relative to the edge radius: a cone then has its pull-off force to
3e-10."""

LAYER_DEPTH = 0.02
"""Depth resolved under the surface relative to the edge width, times min(1, 5 k): the first layer's error is
linear in its thickness for 0 < k < 0.2, where z^(1-k) and z are hard to tell apart."""

WIDTH_SHARE = 0.18
"""Resolved edge width relative to the length over which the gap rises by the length of the law at the edge."""

NARROWEST, WIDEST = 1e-6, 0.25
"""Relative width of an edge: the smallest that is meshed (it costs an element for each factor of two), and the
largest, which resolves a surface without one."""

FAR_HEIGHT = 1e4
"""Height of the punch, in lengths of the law, at the end of the mesh, for a tension that falls as H^-3 or faster (a
power 3/m of it for a slower H^-m): beyond it the traction enters P by a quadrature to infinity, and its displacement
(below 1e-8 z0 even for a cone) is dropped."""

LARGEST_EXTENT = 1e8
"""Of a mesh, in units of its edge radius.  It costs an element for each factor of two."""

EXTERIOR_ERROR = 5e-8
"""Bound of the relative error of the displacement from the power law that the exterior takes: half of the accuracy
"default", for all accuracies, because it falls with the square of the extent."""

FINEST_SCALE = 1e-3
"""Depth, relative to the one resolved under the surface, from which on changes of the modulus are searched for."""

LOWEST, HIGHEST = 1e-8, 1e4
"""Heights of a punch, in lengths of the law, between which it may have no asperity: below, it is flat to the law, and
above, the tension is 1e-12 of its peak."""

REFINEMENTS = 8
"""Largest number of meshes tried to find the width of the edge."""


@dataclass(frozen=True, slots=True)
class MeshChoice:
    """The mesh for a problem at an accuracy.

    Parameters
    ----------
    problem : Problem
    level : Level
        Order and densities of the meshes.
    """

    problem: Problem
    level: Level

    def contact(self, spec: MeshSpec, size: float) -> Contact:
        """Discretise the problem on a mesh with its edge at the radius `size`."""
        solid, punch, law = self.problem.solid, self.problem.punch, self.problem.law
        return Contact(punch, law, compliance_for(solid.modulus, solid.nu, spec, size))

    def traced(self, spec: MeshSpec, size: float) -> PathEvents:
        """The path on that mesh, traced once however many quantities are read from it."""
        return _traced(self, spec, size)

    def spec(self, width: float, size: float, smallest: float) -> MeshSpec:
        """Mesh for an edge of that relative width; lengths are rounded so that similar cases share a mesh.

        Also where its edge has the radius `smallest`, the mesh ends where the punch is `FAR_HEIGHT` high.
        """
        modulus, law = self.problem.solid.modulus, self.problem.law
        k = modulus.surface_exponent
        width = 2.0 ** math.floor(math.log2(min(max(width, NARROWEST), WIDEST)))
        depth = LAYER_DEPTH * width * min(1.0, 5.0 * k) if k > 0 else 0.3 * width
        if math.isfinite(modulus.surface_depth):
            depth = min(depth, 0.2 * modulus.surface_depth / size)
        C, m = law.decay
        height = FAR_HEIGHT ** max(1.0, 3.0 / m) if C != 0.0 else FAR_HEIGHT
        far = radius_at_height(self.problem.punch, height * law.length)
        extent = 2.0 ** math.ceil(math.log2(min(max(far / smallest, 50.0), LARGEST_EXTENT)))
        while exterior_error(scaled_modulus(modulus, size), extent) > EXTERIOR_ERROR and extent < LARGEST_EXTENT:
            extent *= 2.0
        scales = depth_scales(modulus, FINEST_SCALE * depth * size, extent * size).scaled(size)
        return MeshSpec(width, depth, extent, self.level.densities[0], self.level.order, APEX_WIDTH, scales)

    def first_width(self, radius: float) -> float:
        """Relative length over which traction and stiffness balance, at a contact of that radius."""
        law, solid = self.problem.law, self.problem.solid
        depth = np.array(radius)
        # E(l) length / l = traction, by a fixed point in log l; a root finder moves the last digit, and with it the
        # power of 2 to which `spec` rounds.
        for _ in range(40):
            E = float(solid.modulus(depth)) / (1.0 - solid.nu**2)
            depth = np.sqrt(depth * E * law.length**2 / (2.0 * law.work_of_adhesion))
        return 0.5 * float(depth) / radius

    def adapted(self, events: tuple[str, ...]) -> tuple[MeshSpec, float]:
        """Mesh whose edge width (and, if the solid does not scale, size) fits the computed gap.

        Parameters
        ----------
        events : tuple of str
            Events that are needed.  If the solid does not scale, the mesh is fine at the edge of the first.

        Returns
        -------
        spec : MeshSpec
            At the coarsest density of the accuracy.
        size : float
            Radius of the edge of the mesh, in the length unit of the input.

        Raises
        ------
        NoSuchEvent
            If the solid does not scale and the path has no such point.
        NotConverged
            If the edge is narrower than the mesh can resolve.
        """
        punch, law = self.problem.punch, self.problem.law
        scaling = isinstance(self.problem.solid.modulus, PowerLawModulus)
        size = 2.0 * radius_at_height(punch, law.length)
        width = self.first_width(size)
        smallest = radius_at_height(punch, EDGE_RISE * law.length)
        spec = self.spec(width, size, smallest)
        for _ in range(REFINEMENTS):
            try:
                path = self.traced(spec, size)
            except NotConverged:
                # An under-resolved edge is pinned to the elements, and its path may not be traceable.
                narrower = self.spec(0.25 * spec.edge_width, size, smallest)
                if narrower == spec:
                    raise
                spec = narrower
                continue
            points = path.samples
            if not any(beyond_pull_off(event) for event in events):
                # Beyond the pull-off the edge is sharper relative to its radius, but that part is not needed.
                deepest = min(range(len(points)), key=lambda i: points[i].state.load)
                points = points[: deepest + 2]
            widths = [edge_width(point) for point in points if point.branch.touching]
            if scaling:
                # Contact may begin on a spot much smaller than the punch, and the mesh shrinks with it.
                smallest = min(smallest, *(point.state.size for point in points))
            needed = self.spec(WIDTH_SHARE * min(widths, default=1.0), size, smallest)
            if needed.edge_width >= spec.edge_width and needed.extent <= spec.extent:
                if scaling:
                    return spec, size
                point = path.at(events[0])
                if not point.branch.touching or abs(point.edge_radius / size - 1.0) <= 0.5 * spec.edge_width:
                    return spec, size
                size = point.edge_radius
            spec = self.spec(min(needed.edge_width, spec.edge_width), size, smallest)
        raise NotConverged(
            "the width of the contact edge was not found; the edge is narrower than the mesh can resolve"
        )


def chosen(problem: Problem, events: tuple[str, ...], accuracy: float | str) -> tuple[MeshChoice, MeshSpec, float]:
    """Choose the coarsest meshes, from those of an accuracy on, on which the path of a problem can be traced.

    Under a flat punch contact begins on a spot so much smaller than the punch that coarse meshes lose the rim.

    Parameters
    ----------
    problem : Problem
    events : tuple of str
        As for `MeshChoice.adapted`.
    accuracy : float or str
        As for `fem_reference.accuracy.level_for`.

    Returns
    -------
    choice : MeshChoice
    spec, size
        As `MeshChoice.adapted` returns them.

    Raises
    ------
    ValueError
        For an unknown accuracy, or for an object that is not a Problem.
    NoSuchEvent
        As `MeshChoice.adapted`.
    NotConverged
        If the path cannot be traced on the finest meshes either, or is not known to end: on a punch with asperities.
    """
    if not isinstance(problem, Problem):
        raise ValueError(f"problem = {problem!r} is not a Problem; make one of a solid, a punch and a surface law")
    length = problem.law.length
    check_without_asperities(problem.punch, LOWEST * length, HIGHEST * length)
    *coarser, finest = finer_levels(accuracy)
    for level in coarser:
        choice = MeshChoice(problem, level)
        with suppress(NotConverged):
            return choice, *choice.adapted(events)
    choice = MeshChoice(problem, finest)
    return choice, *choice.adapted(events)


# The paths of one problem: three densities and the search for the width, on the meshes of two kinds of events.
@lru_cache(maxsize=12)
def _traced(choice: MeshChoice, spec: MeshSpec, size: float) -> PathEvents:
    return PathEvents(tuple(traced(choice.contact(spec, size))))
