"""Contact equations that are not condensed to the surface: the whole mesh, with the traction as facet forms.

On a mesh in units of the size c the equations are K u / factor(c) = F(u, delta, c), with K the stiffness and the load
vector assembled by scikit-fem on the surface facets at the gap H = -delta + f(c s) + u_z.  Functions inside an element
carry no load: they are eliminated from K, and u has zeros in their rows.  An elastic punch has the same equations on
its own mesh, and u_z in the gap is the sum of both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from skfem import FacetBasis, LinearForm
from skfem.mapping import MappingIsoparametric

from fem_reference._contact.bodies import MeshedBody
from fem_reference._elastic.assembly import HalfSpace
from fem_reference._elastic.gauss import unit_gauss
from fem_reference._linear.linear_solver import LinearResult, relative_residual
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._typing import Array
from fem_reference.interaction import Interaction

__all__ = ["FullSystem"]


@LinearForm
def _pressure(v: Any, w: Any) -> Any:
    return w.pressure * w.x[0] * v


class _RectangleMapping(MappingIsoparametric):
    """Map of rectangles whose inverse is a division.

    scikit-fem inverts by Newton's method to 1e-12 of an element, which is below rounding where an element has a
    millionth of its radius.
    """

    def invF(self, x: Array, tind: Any = None, *_: Any, **__: Any) -> Array:
        """Reference coordinates of points in their elements."""
        t = self.mesh.t if tind is None else self.mesh.t[:, tind]
        corner, along_first, _, along_second = self.mesh.p[:, t].transpose(1, 0, 2)
        sides = np.stack([along_first - corner, along_second - corner])
        along = np.einsum("kij,ijq->kjq", sides, x - corner[:, :, None])
        return np.clip(along / np.einsum("kij,kij->kj", sides, sides)[:, :, None], 0.0, 1.0)


class FullSystem:
    """Surface force of a punch and the whole meshed half-space, or both of two bodies.

    Parameters
    ----------
    half_space : HalfSpace
        On a mesh in units of the size c.
    force : Interaction
        Surface force.
    preconditioner : ElasticPreconditioner, optional
        Of this half-space; built when absent.
    others : sequence of MeshedBody
        Bodies whose displacement is added, on meshes with the same radial nodes.

    Attributes
    ----------
    bodies : tuple of MeshedBody
        All, the half-space first.
    """

    def __init__(
        self,
        half_space: HalfSpace,
        force: Interaction,
        preconditioner: ElasticPreconditioner | None = None,
        others: Sequence[MeshedBody] = (),
    ) -> None:
        self.half_space, self.force = half_space, force
        self.preconditioner = ElasticPreconditioner(half_space) if preconditioner is None else preconditioner
        self.bodies = (MeshedBody(half_space, self.preconditioner), *others)
        dofs = half_space.dofs
        mesh = dofs.topo
        straight = mesh.mapping()
        mapping = _RectangleMapping(mesh, straight.elem, straight.bndelem)
        x, w = unit_gauss(2 * half_space.body.order + 2)
        top = np.flatnonzero((mesh.p[1][mesh.facets] == 0).all(axis=0))
        rule = x[None, :], w
        self.facets = FacetBasis(mesh, dofs.element, mapping, facets=top, quadrature=rule)
        self.s: Array = np.asarray(self.facets.global_coordinates())[0]
        # scikit-fem's interpolation sorts the numbers of all functions of the mesh, each time.
        self._functions: Array = np.stack([np.asarray(function) for function, *_ in self.facets.basis])

    def gap(self, u: Array, delta: float, c: float) -> Array:
        """H at the facet Gauss points."""
        return -delta + self.force.punch.height(c * self.s) + self._raised(u)

    def _raised(self, u: Array) -> Array:
        """u_z at the facet Gauss points."""
        return np.einsum("ieq,ie->eq", self._functions, u[1::2][self.facets.element_dofs])

    def vector(self, pressure: Array) -> Array:
        """Return the load vector of a pressure at the facet Gauss points, shape (2 N,)."""
        load = np.zeros(self.half_space.elements.size)
        load[1::2] = np.asarray(_pressure.assemble(self.facets, pressure=pressure))
        return load

    def on_surface(self, w: Array) -> Array:
        """Return the displacement with the values w along the surface and zero elsewhere, shape (2 N,)."""
        u = np.zeros(self.half_space.elements.size)
        u[self.half_space.surface] = w
        return u

    def pressure(self, u: Array, delta: float, c: float) -> Array:
        """p at the facet Gauss points."""
        return self.force.traction(c * self.s, self.gap(u, delta, c))

    def load_vector(self, y: Array) -> Array:
        """F at y = (w, delta, c), shape (2 N,)."""
        return self.vector(self.pressure(self.on_surface(y[:-2]), y[-2], y[-1]))

    def load_vector_rate(self, y: Array, rate: Array) -> Array:
        """Derivative of F at y along `rate`, shape (2 N,)."""
        r = y[-1] * self.s
        by_radius, by_gap = self.force.slopes(r, self.gap(self.on_surface(y[:-2]), y[-2], y[-1]))
        rise = self._raised(self.on_surface(rate[:-2])) - rate[-2] + rate[-1] * self.s * self.force.punch.slope(r)
        return self.vector(by_gap * rise + rate[-1] * self.s * by_radius)

    def on_body(self, load: Array, body: MeshedBody) -> Array:
        """Return loads on the surface of the half-space, shape (2 N, q), as those on the surface of a body."""
        if body.half_space is self.half_space:
            return load
        on_body = np.zeros((body.half_space.elements.size, load.shape[1]))
        on_body[body.half_space.surface] = load[self.half_space.surface]
        return on_body

    def residuals(self, results: Sequence[LinearResult], loads: Array, w: Array, deltas: Array, sizes: Array) -> Array:
        """Residuals of whole nonlinear systems, one for each displacement, relative to their loads.

        The displacement leaves a residual of the load it was solved under, and makes another load.

        Parameters
        ----------
        results : sequence of LinearResult
            Of each body under `loads`.
        loads : ndarray, shape (2 N, q)
        w : ndarray, shape (m, e)
            Displacement of the surface, of all bodies together, for each of the first loads.
        deltas, sizes : ndarray, shape (e,)

        Returns
        -------
        ndarray, shape (e,)
            The largest of all bodies.
        """
        columns = zip(w.T, deltas, sizes, strict=True)
        made = [self.vector(self.pressure(self.on_surface(u), delta, c)) for u, delta, c in columns]
        count = deltas.size
        change = np.stack(made, axis=1) - loads[:, :count]
        relative = [
            relative_residual(
                body.half_space,
                self.on_body(change, body) + result.remainder[:, :count],
                result.norm[:count],
                body.preconditioner,
            )
            for body, result in zip(self.bodies, results, strict=True)
        ]
        return np.asarray(np.max(relative, axis=0))

    def steepness(self, u: Array, delta: float, c: float) -> float:
        """Size of the slope of the traction relative to the traction, per length, in the norm of `residuals`."""
        by_gap = self.force.slopes(c * self.s, self.gap(u, delta, c))[1]
        loads = np.stack([self.vector(np.abs(by_gap)), self.vector(self.pressure(u, delta, c))], axis=1)
        slope, traction = (self.preconditioner.scale[:, None] * loads[self.half_space.free]).T
        left = self.preconditioner(np.stack([slope, traction], axis=1)).T
        return math.sqrt(abs(float(slope @ left[0])) / abs(float(traction @ left[1])))

    def load(self, u: Array, delta: float, c: float) -> float:
        """P on the mesh (compression positive)."""
        p = self.pressure(u, delta, c)
        return 2.0 * math.pi * c**2 * float(np.sum(p * self.s * self.facets.dx))
