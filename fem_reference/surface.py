"""The surface of the half-space: trace functions, quadrature, and its compliance at every size.

Radii on the surface mesh are s = r / c, with the contact edge kept at s = 1.  Scaling lengths by c turns a
solid E(z) into E(c s): the displacement under the load vector F = integral of p phi s ds is c X(c) F, with
X(c) the compliance of E(c s) on the fixed mesh.  For E = E0 (z/c0)^k this is c^(1-k) c0^k / E0 times one
matrix that depends on k, nu and the mesh only, and serves every size.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from fem_reference.assembly import assemble_half_space
from fem_reference.condensation import surface_stiffness
from fem_reference.mesh import Grid, graded_grid
from fem_reference.modulus import Modulus, PowerLaw

__all__ = [
    "Compliance",
    "FixedCompliance",
    "MeshSpec",
    "ScalingCompliance",
    "Trace",
    "compliance_for",
    "trace_of",
]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MeshSpec:
    """What a mesh in units of the edge radius is made of (see `graded_grid`), hashable.

    Attributes
    ----------
    edge_width, surface_depth, extent, apex_width : float
        Lengths in units of the edge radius.
    density : float
        Growth of element size with distance.
    order : int
        Degree of the elements.

    Examples
    --------
    >>> spec = MeshSpec(edge_width=0.1, surface_depth=0.05, extent=16.0, density=1.0, order=4)
    >>> spec.grid().extent, round(float(spec.load_vector(lambda s: np.exp(-(s**2)))[: spec.grid().r.size].sum()), 6)
    (16.0, 0.5)
    """

    edge_width: float
    surface_depth: float
    extent: float
    density: float
    order: int
    apex_width: float | None = None

    def load_vector(self, pressure: Callable[[Array], Array]) -> Array:
        """Integrals of p(s) phi s ds along the surface, in chain order."""
        trace = trace_of(self.grid(), self.order)
        return np.asarray(trace.phi.T @ (trace.weight * trace.s * pressure(trace.s)))

    def grid(self) -> Grid:
        """Return the grid with its edge at s = 1."""
        return graded_grid(1.0, self.edge_width, self.surface_depth, self.extent, self.density, self.apex_width)


@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """Surface functions in chain order (vertices, then edge functions) at Gauss points.

    Attributes
    ----------
    nodes : ndarray, shape (e + 1,)
        Surface vertices.
    s : ndarray, shape (q,)
        Gauss points.
    weight : ndarray, shape (q,)
        Gauss weights of ds.
    phi : ndarray, shape (q, m)
        Function values.
    edge : int
        Index of the vertex at s = 1 (its function is 1 there and all others vanish).
    order : int
        Polynomial order.
    """

    nodes: Array
    s: Array
    weight: Array
    phi: Array
    edge: int
    order: int

    @property
    def extent(self) -> float:
        """Outer end of the surface mesh."""
        return float(self.nodes[-1])

    def evaluate(self, s: Array) -> Array:
        """Return function values at any radii inside the mesh, shape (len(s), m).

        Examples
        --------
        >>> trace = trace_of(graded_grid(extent=10.0), order=4)
        >>> bool(np.allclose(trace.evaluate(trace.s), trace.phi)), trace.extent
        (True, 10.0)
        """
        return _line_functions(self.nodes, self.order, np.asarray(s, float))


def _line_functions(nodes: Array, order: int, s: Array) -> Array:
    """Functions of scikit-fem's `ElementLinePp` in chain order, at radii `s`.

    Written out, because that class makes its polynomials anew in every call, and the path asks for one radius
    at a time.
    """
    element = np.clip(np.searchsorted(nodes, s, side="right") - 1, 0, nodes.size - 2)
    x = (s - nodes[element]) / np.diff(nodes)[element]
    legendre = np.polynomial.legendre.legvander(2.0 * x - 1.0, order)
    values = np.zeros((s.size, nodes.size + (nodes.size - 1) * (order - 1)))
    rows = np.arange(s.size)
    values[rows, element] = 1.0 - x
    values[rows, element + 1] = x
    for degree in range(2, order + 1):
        # The integral of the Legendre polynomial of one degree less, normalised.
        rise = legendre[:, degree] - legendre[:, degree - 2]
        values[rows, nodes.size + element * (order - 1) + degree - 2] = rise / np.sqrt(4.0 * degree - 2.0)
    return values


def trace_of(grid: Grid, order: int) -> Trace:
    """Return the trace space of a grid on its surface, with a Gauss rule that resolves the surface law.

    Examples
    --------
    >>> trace = trace_of(graded_grid(extent=10.0), order=4)
    >>> round(float(trace.weight.sum()), 12), float(trace.nodes[trace.edge])
    (10.0, 1.0)
    """
    nodes = grid.r
    x, w = np.polynomial.legendre.leggauss(2 * order + 2)
    h = np.diff(nodes)
    s = (nodes[:-1, None] + 0.5 * h[:, None] * (x + 1.0)).ravel()
    weight = (0.5 * h[:, None] * w).ravel()
    return Trace(nodes, s, weight, _line_functions(nodes, order, s), int(np.argmin(abs(nodes - 1.0))), order)


class Compliance(Protocol):
    """Surface compliance as a function of the size c of the mesh."""

    @property
    def trace(self) -> Trace:
        """The surface functions."""
        ...

    @property
    def unknowns(self) -> int:
        """Unknowns of the finite-element mesh behind it."""
        ...

    def factor(self, c: float) -> float:
        """Factor of `matrix` at size c."""
        ...

    def factor_slope(self, c: float) -> float:
        """Return the derivative of `factor` with respect to c."""
        ...

    @property
    def matrix(self) -> Array:
        """Normal displacement per load vector, shape (m, m), per unit factor."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class ScalingCompliance:
    """Compliance of E = E0 (z/c0)^k: one matrix for every size.

    Examples
    --------
    >>> spec = MeshSpec(edge_width=0.2, surface_depth=0.1, extent=8.0, density=1.2, order=3)
    >>> graded = compliance_for(PowerLaw(E0=2.0, c0=1.0, k=0.5), 0.3, spec, size=1.0)
    >>> graded.factor(4.0), graded.factor_slope(4.0)  # c^(1/2) / 2 and its derivative
    (1.0, 0.125)
    """

    trace: Trace
    matrix: Array
    modulus: PowerLaw
    unknowns: int

    def factor(self, c: float) -> float:
        """c^(1-k) c0^k / E0."""
        law = self.modulus
        return c ** (1.0 - law.k) * law.c0**law.k / law.E0

    def factor_slope(self, c: float) -> float:
        """(1 - k) factor / c."""
        return (1.0 - self.modulus.k) * self.factor(c) / c


@dataclass(frozen=True, slots=True, eq=False)
class FixedCompliance:
    """Compliance of a solid that does not scale, on a mesh of one size.

    Raises
    ------
    ValueError
        From `factor`, at any size but that of the mesh.

    Examples
    --------
    >>> from fem_reference.modulus import OffsetPowerLaw
    >>> spec = MeshSpec(edge_width=0.2, surface_depth=0.1, extent=8.0, density=1.2, order=3)
    >>> skin = compliance_for(OffsetPowerLaw(E0=2.0, c0=1.0, k=0.5, z_s=1.0), 0.3, spec, size=2.0)
    >>> skin.factor(2.0), skin.factor_slope(2.0)
    (2.0, 0.0)
    """

    trace: Trace
    matrix: Array
    size: float
    unknowns: int

    def factor(self, c: float) -> float:
        """c, which must be the size of the mesh."""
        if abs(c / self.size - 1.0) > 1e-12:
            raise ValueError(f"this compliance holds at the size {self.size}, not {c}: the modulus is no power law")
        return self.size

    def factor_slope(self, c: float) -> float:
        """Zero: the size cannot change."""
        return 0.0


@lru_cache(maxsize=24)
def _unit_compliance(k: float, nu: float, spec: MeshSpec) -> tuple[Trace, Array, int]:
    grid = spec.grid()
    half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, k), nu, spec.order)
    matrix = _inverse(surface_stiffness(half_space))
    return trace_of(grid, spec.order), matrix, int(half_space.free.size)


def _inverse(S: Array) -> Array:
    X = linalg.cho_solve(linalg.cho_factor(S), np.eye(S.shape[0]))
    return 0.5 * (X + X.T)


@dataclass(frozen=True, slots=True)
class _Scaled:
    """E(c s) of a modulus E(z)."""

    base: Modulus
    c: float

    @property
    def surface_exponent(self) -> float:
        return self.base.surface_exponent

    @property
    def depth_exponent(self) -> float:
        return self.base.depth_exponent

    @property
    def surface_depth(self) -> float:
        return self.base.surface_depth / self.c

    def __call__(self, z: Array) -> Array:
        return self.base(np.asarray(z, float) * self.c)


def compliance_for(modulus: Modulus, nu: float, spec: MeshSpec, size: float) -> Compliance:
    """Return the surface compliance of a solid on a mesh whose edge is at the radius `size`.

    Parameters
    ----------
    modulus : Modulus
        E(z).
    nu : float
        Poisson ratio.
    spec : MeshSpec
        Mesh in units of `size`.
    size : float
        Edge radius; immaterial for a power law, whose compliance serves every size.

    Returns
    -------
    Compliance

    Raises
    ------
    NotConverged
        If the stiffness of the mesh is not positive definite.

    Examples
    --------
    The pressure exp(-r^2) on a uniform solid of E = 4 and nu = 0 displaces r = 0 by sqrt(pi) / 4:

    >>> spec = MeshSpec(edge_width=0.1, surface_depth=0.05, extent=16.0, density=1.0, order=4)
    >>> uniform = compliance_for(PowerLaw(4.0, 1.0, 0.0), 0.0, spec, size=1.0)
    >>> w = uniform.factor(1.0) * uniform.matrix @ spec.load_vector(lambda s: np.exp(-(s**2)))
    >>> bool(abs(4.0 * w[0] / np.sqrt(np.pi) - 1.0) < 1e-4)
    True
    """
    if isinstance(modulus, PowerLaw):
        trace, matrix, unknowns = _unit_compliance(modulus.k, nu, spec)
        return ScalingCompliance(trace, matrix, modulus, unknowns)
    grid = spec.grid()
    half_space = assemble_half_space(grid, scaled_modulus(modulus, size), nu, spec.order)
    matrix = _inverse(surface_stiffness(half_space))
    return FixedCompliance(trace_of(grid, spec.order), matrix, size, int(half_space.free.size))


def scaled_modulus(modulus: Modulus, size: float) -> Modulus:
    """Return the modulus in lengths of `size`: E(size s) as a function of s.

    Examples
    --------
    >>> float(scaled_modulus(PowerLaw(1.0, 1.0, 0.5), 4.0)(np.array(1.0)))
    2.0
    """
    if isinstance(modulus, PowerLaw):
        return PowerLaw(modulus.E0, modulus.c0 / size, modulus.k)
    return _Scaled(modulus, size)
