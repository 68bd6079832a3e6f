"""Response of the half-space to the pressure at the nodes of a mesh: of a power law, or of other bodies.

The half-space of a power law has no length of its own, so that one matrix W serves every scale c of the mesh:
w(c s) = M (1-k) c^{1-k} (W p)(s).  Other bodies have lengths, and a matrix for each scale.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from fscm._surface.deformation import axis_row, response_matrix
from fscm._surface.kernel import kernel_of
from fscm._surface.mesh import PanelMesh
from fscm._surface.response import response_of
from fscm._surface.response.panels import Remainder
from fscm._typing import Array
from fscm.problem import Problem

__all__ = ["BodiesOnMesh", "PowerLawOnMesh", "on_mesh"]


class PowerLawOnMesh:
    """The response of a power law.

    Parameters
    ----------
    problem : Problem
    mesh : PanelMesh
    previous : PowerLawOnMesh, optional
        On another mesh; its blocks for common panels are reused.
    """

    def __init__(self, problem: Problem, mesh: PanelMesh, previous: PowerLawOnMesh | None = None) -> None:
        self.problem, self.mesh = problem, mesh
        self._previous = previous

    @cached_property
    def _matrix(self) -> Array:
        """W; on demand, because on some meshes nothing is solved."""
        previous, self._previous = self._previous, None
        while previous is not None and previous._previous is not None:
            previous = previous._previous  # on a mesh on which nothing was solved
        reusable = None
        if previous is not None and previous.problem.k == self.problem.k and "_matrix" in previous.__dict__:
            reusable = previous.mesh, previous._matrix
        return response_matrix(kernel_of(self.problem.k), self.mesh, reusable)

    @cached_property
    def _axis(self) -> Array:
        return axis_row(kernel_of(self.problem.k), self.mesh)

    def matrix(self, c: float) -> Array:
        """W at a scale, shape (N, N)."""
        return self._matrix

    def axis(self, c: float) -> Array:
        """The row of W for the axis at a scale, shape (N,)."""
        return self._axis

    def growth(self, c: float, pressure: Array) -> tuple[Array | float, float]:
        """Derivative of W p by log c at the nodes and on the axis, without that of the factor of W."""
        return 0.0, 0.0


class BodiesOnMesh(PowerLawOnMesh):
    """The response of bodies that are not one power law: power laws, and a remainder by images."""

    def __init__(self, problem: Problem, mesh: PanelMesh, previous: PowerLawOnMesh | None = None) -> None:
        super().__init__(problem, mesh, previous)
        assert problem.graded is not None  # see `on_mesh`
        self._response = response_of(problem.graded)
        # Matrices, and rows for the axis, of the other exponents.
        self._others: dict[float, tuple[Array, Array]] = {}
        self._at: tuple[float, Remainder | None, Array] | None = None
        # On the previous mesh, at the same scale: reused for common panels.
        self._before: tuple[PanelMesh, float, Remainder] | None = None
        if isinstance(previous, BodiesOnMesh) and previous._at is not None and previous._response is self._response:
            scale, remainder, _ = previous._at
            if previous.mesh is mesh:
                self._at = previous._at
            elif remainder is not None:
                self._before = previous.mesh, scale, remainder

    def _power_law(self, k: float) -> tuple[Array, Array]:
        """The matrix W of an exponent, and its row for the axis."""
        if k == self.problem.k:
            return self._matrix, self._axis
        if k not in self._others:
            self._others[k] = response_matrix(kernel_of(k), self.mesh), axis_row(kernel_of(k), self.mesh)
        return self._others[k]

    def _factors(self, c: float) -> dict[float, float]:
        """Factors of the matrices of all exponents at a scale."""
        k = self.problem.k
        return {k_i: weight * c ** (k - k_i) for k_i, weight in self._response.singular_parts.items()}

    def _at_scale(self, c: float) -> tuple[Remainder | None, Array]:
        """Response of the images at a scale, and the whole response."""
        if self._at is None or self._at[0] != c:
            self._at = None  # frees its memory first
            remainder = self._response.remainder(self.mesh, c, self._before)
            self._before = None
            terms = [(factor, self._power_law(k)[0]) for k, factor in self._factors(c).items()]
            if remainder is not None:
                terms.append((-self._response.weight * c**self.problem.k, remainder.matrix))
            matrices = [matrix if factor == 1.0 else factor * matrix for factor, matrix in terms]
            self._at = c, remainder, sum(matrices[1:], matrices[0])
        return self._at[1:]

    def matrix(self, c: float) -> Array:
        """W at a scale."""
        return self._at_scale(c)[1]

    def axis(self, c: float) -> Array:
        """The row of W for the axis at a scale."""
        rows = [factor * self._power_law(k)[1] for k, factor in self._factors(c).items()]
        remainder = self._at_scale(c)[0]
        if remainder is not None:
            rows.append(-self._response.weight * c**self.problem.k * remainder.axis)
        return np.asarray(np.sum(rows, axis=0))

    def growth(self, c: float, pressure: Array) -> tuple[Array | float, float]:
        """Derivative of W p by log c at the nodes and on the axis, without that of the factor of W."""
        k = self.problem.k
        nodes, axis = np.zeros(self.mesh.size), 0.0
        for k_i, factor in self._factors(c).items():
            if k_i != k:
                matrix, row = self._power_law(k_i)
                nodes = nodes + (k - k_i) * factor * (matrix @ pressure)
                axis += (k - k_i) * factor * float(row @ pressure)
        remainder = self._at_scale(c)[0]
        if remainder is not None:
            factor = self._response.weight * c**k
            nodes = nodes - factor * (remainder.rate @ pressure + k * (remainder.matrix @ pressure))
            axis -= factor * float(remainder.axis_rate @ pressure + k * (remainder.axis @ pressure))
        return nodes, axis


def on_mesh(problem: Problem, mesh: PanelMesh, previous: PowerLawOnMesh | None = None) -> PowerLawOnMesh:
    """The response of the bodies of a problem."""
    return (PowerLawOnMesh if problem.graded is None else BodiesOnMesh)(problem, mesh, previous)
