"""Meshes of a problem at an accuracy, and the problem discretised on them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fem_reference._contact.bodies import compliance_of
from fem_reference._contact.contact import Contact
from fem_reference._contact.mesh_lengths import (
    EDGE_RISE,
    FORCE_HEIGHT,
    balance_length,
    check_width,
    expected_spot,
    extent_for,
    mesh_spec,
    scales,
    spot_length,
)
from fem_reference._contact.states import NARROWER
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import Level
from fem_reference.problem import Problem
from fem_reference.punch import radius_at_height

__all__ = ["Meshes"]

#: Share of the density far beyond the edge, where contact begins on a spot much smaller than the punch and the tension
#: falls within an element otherwise: on the meshes of "quick" the path of n = 6.2, k = 0.53, mu = 2.9 stops there with
#: 1, and with 0.5 it is that of 0.3 to 1e-6 (measured).
FAR_SHARE = 0.5

#: Radius on which contact begins, relative to that where the punch rises by `EDGE_RISE`, below which it is small.
SMALL_SPOT = 0.25


#: Least depth, in units of the edge radius, at which the mesh of a pull-off force ends if that of the path extends
#: farther (see `fem_reference._elastic.mesh.ended`): its bound grows by at most 3 % (measured on 70 problems).
#: That of a displacement, which the solid at the end moves, would be up to twice as large.
NEAREST_END = 128.0


@dataclass(frozen=True, slots=True)
class Meshes:
    """The meshes of a problem at an accuracy.

    Parameters
    ----------
    problem : Problem
    level : Level
        Degree and density of the meshes.
    spot : float
        Radius on which contact begins, where it is known and the meshes scale: they extend as far from there.
    failures : int
        Meshes on which the path could not be followed to there: each makes them finer at the edge and far from it.
    """

    problem: Problem
    level: Level
    spot: float = math.inf
    failures: int = 0

    @property
    def scale(self) -> bool:
        """Whether the meshes scale: the compliance of one size is that of every size, but for a factor."""
        return scales(self.problem)

    def contact(self, spec: MeshSpec, size: float, whole: bool = False) -> Contact:
        """Discretise the problem on a mesh with its edge at the radius `size`, for its whole system as well or not."""
        return Contact(self.problem.force, compliance_of(self.problem.solids, spec, size, self.scale, whole))

    def lower_contact(self, spec: MeshSpec, size: float) -> Contact:
        """Discretise the problem with the degree below.

        If the meshes do not scale, the edge is half an element further out, too.
        """
        below = replace(spec, order=spec.order - 1)
        if self.scale:
            return self.contact(below, size)
        # Another placement needs another mesh: the one for the other degree serves both.
        r = spec.grid().r
        other_size = size * (0.5 + 0.5 * float(r[np.argmin(abs(r - 1.0)) + 1]))
        return self.contact(below.moved(other_size / size), other_size)

    def spec_at(self, width: float, radius: float) -> MeshSpec:
        """Mesh of one radius of the edge, for an edge of that relative width; of every radius if the meshes scale."""
        if self.scale:
            smallest = min(self.spot, self._rise)
            far_share = FAR_SHARE ** max(self.failures, int(smallest < SMALL_SPOT * self._rise))
            return mesh_spec(self.problem, self.level, width, self._size, smallest, far_share)
        apex = spot_length(self.problem, self._size)
        return mesh_spec(self.problem, self.level, width, radius, min(radius, self._rise), apex=apex)

    def ended(self, spec: MeshSpec, radius: float) -> MeshSpec:
        """The same mesh up to where the pull-off force needs it, with the edge at that radius."""
        return replace(spec, end=max(extent_for(self.problem, radius, FORCE_HEIGHT), NEAREST_END))

    @property
    def expected(self) -> Meshes:
        """Those that extend as far from the spot on which contact is expected to begin."""
        return replace(self, spot=expected_spot(self.problem, self._size, self._rise))

    @property
    def _rise(self) -> float:
        """Radius at which the punch rises by `EDGE_RISE`."""
        return radius_at_height(self.problem.punch, EDGE_RISE * self.problem.law.z0)

    @property
    def _size(self) -> float:
        """Radius of the edge on the mesh on which a path begins."""
        return 2.0 * radius_at_height(self.problem.punch, self.problem.law.z0)

    def first(self) -> tuple[MeshSpec, float]:
        """Mesh on which a path begins, and the radius of its edge."""
        size = self._size
        width = 0.5 * balance_length(self.problem, size) / size * NARROWER**self.failures
        check_width(width)
        return self.spec_at(width, size), size
