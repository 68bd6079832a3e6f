"""A problem on a mesh: everything that does not depend on the state."""

from __future__ import annotations

import numpy as np

from fscm._surface.bordered_factor import BorderedFactor
from fscm._surface.mesh import PanelMesh
from fscm._surface.response_on_mesh import PowerLawOnMesh, on_mesh
from fscm._typing import Array
from fscm.interaction import Derjaguin
from fscm.problem import Problem

__all__ = ["STEEP", "Discretisation"]

#: Growth of a punch above which its height is not linear in log c within a step, and so much larger than the
#: deformation that their difference loses digits (see `_surface.state`).
STEEP = 10.0
#: The same under the potential of the whole punch, which acts at the level delta - w of the surface: with gaps linear
#: in log c the surface far out moves by a part of the height.  Measured: of r^6 the path takes 25 points, not hundreds;
#: up to a paraboloid gaps keep more digits (a ball at mu = 464: 1.6e-8 of the force, not 8e-6).
_STEEP_AS_A_WHOLE = 2.0
#: Bound on the heights of a steep punch: the tension there is negligible, 1e-180 for the 9-3 law.
_HIGHEST = 1e60


class Discretisation:
    """A problem on a mesh.

    Parameters
    ----------
    problem : Problem
    mesh : PanelMesh
        In the scaled radius s; must have a break at s = 1.
    previous : Discretisation, optional
        Blocks of its response matrix are reused.
    """

    def __init__(self, problem: Problem, mesh: PanelMesh, previous: Discretisation | None = None) -> None:
        self.problem, self.mesh, self.force = problem, mesh, problem.force
        vertical = isinstance(self.force, Derjaguin)
        #: Whether the punch is steep, so that the unknowns are deformations.
        self.steep = problem.punch.growth > (STEEP if vertical else _STEEP_AS_A_WHOLE)
        self.elastic: PowerLawOnMesh = on_mesh(problem, mesh, None if previous is None else previous.elastic)
        self._power = 1.0 - problem.k
        self._stiffness = problem.compliance * self._power
        #: The latest factors of a tangent on this mesh, which serve neighbouring states.
        self.factor: BorderedFactor | None = None
        edge = int(np.searchsorted(mesh.offsets, 1.0 - mesh.origin))
        self.edge = mesh.row_at_end(max(edge - 1, 0), 1.0)

    def height(self, radius: Array) -> Array:
        """Height of the punch, bounded for a steep one."""
        f = self.problem.punch.height(radius)
        return np.minimum(f, _HIGHEST) if self.steep else f

    def rise(self, radius: Array) -> Array:
        """r df/dr, the change of the height with log c."""
        if self.steep:
            # Where the height is bounded it does not change.
            below_bound = self.problem.punch.height(radius) < _HIGHEST
            return np.where(below_bound, radius * self.problem.punch.slope(np.where(below_bound, radius, 0.0)), 0.0)
        return radius * self.problem.punch.slope(radius)

    def response(self, c: float) -> Array:
        """The matrix W at a scale, shape (N, N)."""
        return self.elastic.matrix(c)

    def axis_response(self, c: float) -> Array:
        """The row of W for the axis at a scale, shape (N,)."""
        return self.elastic.axis(c)

    def growth(self, c: float, pressure: Array) -> tuple[Array | float, float]:
        """Derivative of W p by log c at the nodes and on the axis, without that of the factor of W."""
        return self.elastic.growth(c, pressure)

    def stiffness_scale(self, c: float) -> float:
        """M (1-k) c^{1-k}, the factor of W."""
        return self._stiffness * c**self._power
