"""Meshes of a problem at an accuracy, and the problem discretised on them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem_reference._contact.bodies import compliance_of
from fem_reference._contact.contact import Contact
from fem_reference._contact.mesh_lengths import balance_length, check_width, mesh_spec, scales, spot_length
from fem_reference._contact.path import EDGE_RISE
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.variants import VariantSpec
from fem_reference.accuracy import Level
from fem_reference.problem import Problem
from fem_reference.punch import radius_at_height

__all__ = ["Meshes"]


@dataclass(frozen=True, slots=True)
class Meshes:
    """The meshes of a problem at an accuracy.

    Parameters
    ----------
    problem : Problem
    level : Level
        Degree and density of the meshes.
    """

    problem: Problem
    level: Level

    @property
    def one_for_all(self) -> bool:
        """Whether one mesh carries the path: the compliance of one size is that of every size, but for a factor."""
        return scales(self.problem)

    def contact(self, spec: MeshSpec, size: float) -> Contact:
        """Discretise the problem on a mesh with its edge at the radius `size`."""
        # The whole system is solved on meshes of the accuracy itself, not on those that differ in one thing.
        whole = spec.order == self.level.order and not isinstance(spec, VariantSpec)
        return Contact(self.problem.force, compliance_of(self.problem, spec, size, self.one_for_all, whole))

    def lower_contact(self, spec: MeshSpec, size: float) -> Contact:
        """Discretise the problem with the degree below.

        If each size has a mesh of its own, the edge is half an element further out, too.
        """
        below = replace(spec, order=spec.order - 1)
        if self.one_for_all:
            return self.contact(below, size)
        # Another placement needs another mesh: the one for the other degree serves both.
        r = spec.grid().r
        other_size = size * (0.5 + 0.5 * float(r[np.argmin(abs(r - 1.0)) + 1]))
        return self.contact(below.moved(other_size / size), other_size)

    def spec_at(self, width: float, radius: float) -> MeshSpec:
        """Mesh of one radius of the edge, for an edge of that relative width."""
        law, punch = self.problem.law, self.problem.punch
        smallest = min(radius, radius_at_height(punch, EDGE_RISE * law.z0))
        apex = spot_length(self.problem, 2.0 * radius_at_height(punch, law.z0))
        return mesh_spec(self.problem, self.level, width, radius, smallest, apex=apex)

    def first(self) -> tuple[MeshSpec, float]:
        """Mesh on which a path over meshes for each radius begins, and the radius of its edge."""
        size = 2.0 * radius_at_height(self.problem.punch, self.problem.law.z0)
        width = 0.5 * balance_length(self.problem, size) / size
        check_width(width)
        return self.spec_at(width, size), size
