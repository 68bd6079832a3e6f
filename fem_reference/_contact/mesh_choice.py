"""The choice of the mesh: three densities an accuracy, and an edge as fine as the computed profile asks.

The first width of the contact edge is the length over which the surface law and the solid balance; walking the
path on that mesh tells how wide the edge really is, and the mesh is made anew until it is fine enough.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.events import LOSSES, QUANTITIES, locate, walk
from fem_reference._contact.path import EDGE_RISE, Point, edge_width
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.errors import NotConverged
from fem_reference.laws import LennardJones
from fem_reference.modulus import PowerLaw
from fem_reference.punch import Punch, radius_at_height
from fem_reference.solid import CustomSolid, Solid

__all__ = ["ACCURACIES", "Accuracy", "MeshChoice", "chosen"]


@dataclass(frozen=True, slots=True)
class Accuracy:
    """Element order and the three mesh densities, coarse to fine.

    Examples
    --------
    >>> ACCURACIES["quick"].densities[0] > ACCURACIES["fine"].densities[0]
    True
    """

    order: int
    densities: tuple[float, float, float]


ACCURACIES = {
    "quick": Accuracy(6, (1.4, 1.15, 0.95)),
    "default": Accuracy(6, (1.05, 0.85, 0.69)),
    "fine": Accuracy(6, (0.75, 0.61, 0.5)),
}
"""From coarse to fine.  Measured on n = 2, 9-3 law: pull-off forces to 1e-6, 1e-7 and 1e-8 of their value."""

APEX_WIDTH = 0.05
"""Radial length resolved at r = 0, relative to the edge radius: a cone then has its pull-off force to
3e-10."""

LAYER_DEPTH = 0.02
"""Depth resolved under the surface relative to the edge width, times min(1, 5 k): the first layer's error is
linear in its thickness for 0 < k < 0.2, where z^(1-k) and z are hard to tell apart."""

WIDTH_SHARE = 0.18
"""Resolved edge width relative to the length over which the gap rises by z0 at the edge."""

NARROWEST, WIDEST = 1e-6, 0.25
"""Relative width of an edge: the smallest that is meshed (it costs an element for each factor of two), and the
largest, which resolves a surface without one."""

FAR_HEIGHT = 1e4
"""Height of the punch, in z0, at the end of the mesh: beyond it the traction enters P in closed form and its
displacement (below 1e-8 z0 even for a cone) is dropped."""

LARGEST_EXTENT = 1e8
"""Of a mesh, in units of its edge radius.  It costs an element for each factor of two."""

HOMOGENEOUS_DEPTH = 64.0
"""End of the mesh relative to the depth over which the modulus leaves its surface law: the exterior beyond takes
it for the power law of great depth (measured: four times as far changes displacements by 1.3e-7 z0 at most)."""

REFINEMENTS = 8
"""Attempts to find the edge width before the search is given up."""


@dataclass(frozen=True, slots=True)
class MeshChoice:
    """The mesh for a solid, a punch and a surface law at an accuracy.

    Parameters
    ----------
    solid : Solid or CustomSolid
    punch : Punch
    law : LennardJones
        The problem, in consistent units.
    level : Accuracy
        Order and densities of the meshes.
    """

    solid: Solid | CustomSolid
    punch: Punch
    law: LennardJones
    level: Accuracy

    def contact(self, spec: MeshSpec, size: float) -> Contact:
        """Discretise the problem on a mesh with its edge at the radius `size`."""
        return Contact(self.punch, self.law, compliance_for(self.solid.modulus, self.solid.nu, spec, size))

    def walked(self, spec: MeshSpec, size: float) -> tuple[Point, ...]:
        """The path on that mesh, walked once however many quantities are read from it."""
        return _walked(self, spec, size)

    def spec(self, width: float, size: float, smallest: float) -> MeshSpec:
        """Mesh for an edge of that relative width; lengths are rounded so that similar cases share a mesh.

        Also where its edge has the radius `smallest`, the mesh ends where the punch is `FAR_HEIGHT` high.
        """
        modulus = self.solid.modulus
        k = modulus.surface_exponent
        width = 2.0 ** math.floor(math.log2(min(max(width, NARROWEST), WIDEST)))
        depth = LAYER_DEPTH * width * min(1.0, 5.0 * k) if k > 0 else 0.3 * width
        if math.isfinite(modulus.surface_depth):
            depth = min(depth, 0.2 * modulus.surface_depth / size)
        far = radius_at_height(self.punch, FAR_HEIGHT * self.law.z0)
        deep = HOMOGENEOUS_DEPTH * modulus.surface_depth / size if math.isfinite(modulus.surface_depth) else 0.0
        extent = 2.0 ** math.ceil(math.log2(min(max(far / smallest, 50.0, deep), LARGEST_EXTENT)))
        return MeshSpec(width, depth, extent, self.level.densities[0], self.level.order, APEX_WIDTH)

    def first_width(self, radius: float) -> float:
        """Relative length over which traction and stiffness balance, at a contact of that radius."""
        law = self.law
        depth = np.array(radius)
        for _ in range(40):
            # E(l) z0 / l = traction: solved by fixed point in log l.
            E = float(self.solid.modulus(depth)) / (1.0 - self.solid.nu**2)
            depth = np.sqrt(depth * E * law.z0**2 / (2.0 * law.work_of_adhesion))
        return 0.5 * float(depth) / radius

    def adapted(self, quantity: str) -> tuple[MeshSpec, float]:
        """Mesh whose edge width (and, if the solid does not scale, size) fits the computed profile.

        Parameters
        ----------
        quantity : str
            What is asked: beyond the pull-off the edge is resolved only if it needs that part of the path.

        Returns
        -------
        spec : MeshSpec
            At the coarsest density of the accuracy.
        size : float
            Radius of the edge of the mesh, in the length unit of the input.

        Raises
        ------
        NotConverged
            If the edge is finer than the mesh can follow.
        """
        scaling = isinstance(self.solid.modulus, PowerLaw)
        size = 2.0 * radius_at_height(self.punch, self.law.z0)
        width = self.first_width(size)
        smallest = radius_at_height(self.punch, EDGE_RISE * self.law.z0)
        spec = self.spec(width, size, smallest)
        for _ in range(REFINEMENTS):
            try:
                points = self.walked(spec, size)
            except NotConverged:
                # An under-resolved edge is pinned to the elements, and its path may not be traversable.
                narrower = self.spec(0.25 * spec.edge_width, size, smallest)
                if narrower == spec:
                    raise
                spec = narrower
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
            needed = self.spec(WIDTH_SHARE * min(widths, default=1.0), size, smallest)
            if needed.edge_width >= spec.edge_width and needed.extent <= spec.extent:
                if scaling:
                    return spec, size
                point = locate(points, quantity)[1]
                if not point.leg.touching or abs(point.contact_radius / size - 1.0) <= 0.5 * spec.edge_width:
                    return spec, size
                size = point.contact_radius
            spec = self.spec(min(needed.edge_width, spec.edge_width), size, smallest)
        raise NotConverged("the width of the contact edge was not found; the edge is finer than the mesh can follow")


def chosen(
    solid: Solid | CustomSolid, punch: Punch, law: LennardJones, quantities: Sequence[str], accuracy: str
) -> tuple[MeshChoice, MeshSpec, float]:
    """Choose the coarsest meshes, from those of an accuracy on, on which the path of a problem can be walked.

    Under a flat punch contact begins on a spot so much smaller than the punch that coarse meshes lose the rim.

    Parameters
    ----------
    solid, punch, law
        The problem, in consistent units.
    quantities : sequence of str
        Of `QUANTITIES` and `LOSSES`, at least one; the mesh suits the first.
    accuracy : str
        Of `ACCURACIES`.

    Returns
    -------
    choice : MeshChoice
    spec, size
        As `MeshChoice.adapted` returns them.

    Raises
    ------
    ValueError
        For no quantity, an unknown one, or an unknown accuracy.
    NotConverged
        If the path cannot be walked on the finest meshes either.
    """
    if not quantities:
        raise ValueError(f"no quantity is asked for; choose at least one of {', '.join(QUANTITIES + LOSSES)}")
    for quantity in quantities:
        if quantity not in QUANTITIES + LOSSES:
            raise ValueError(f"quantity {quantity!r} is unknown; choose one of {', '.join(QUANTITIES + LOSSES)}")
    if accuracy not in ACCURACIES:
        raise ValueError(f"accuracy {accuracy!r} is unknown; choose one of {', '.join(ACCURACIES)}")
    names = list(ACCURACIES)
    for name in names[names.index(accuracy) : -1]:
        choice = MeshChoice(solid, punch, law, ACCURACIES[name])
        with suppress(NotConverged):
            return choice, *choice.adapted(quantities[0])
    choice = MeshChoice(solid, punch, law, ACCURACIES[names[-1]])
    return choice, *choice.adapted(quantities[0])


# The paths of one problem: three densities and the search for the width, on the meshes of two kinds of questions.
@lru_cache(maxsize=12)
def _walked(choice: MeshChoice, spec: MeshSpec, size: float) -> tuple[Point, ...]:
    return tuple(walk(choice.contact(spec, size)))
