"""Study of the linear solver over sizes and materials, beside a direct solve."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.trace import trace_of
from fem_reference._linear.linear_solver import solve_cg, solve_direct
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._threads import one_thread
from fem_reference.solid import PowerLaw
from fem_reference.verification.load_vectors import smooth_load

__all__ = ["FULL_STUDY", "QUICK_STUDY", "SolverCase", "SolverRow", "solver_table"]

#: The load is p = exp(-(r / 0.3)^2), well inside the refined edge at r = 1.
LOAD_RADIUS = 0.3


_LOAD = smooth_load(lambda r: np.exp(-((r / LOAD_RADIUS) ** 2)))


@dataclass(frozen=True, slots=True)
class SolverCase:
    """A mesh and a material."""

    spec: MeshSpec
    k: float
    nu: float


@dataclass(frozen=True, slots=True)
class SolverRow:
    """One row of the table; times in seconds, memory in megabytes of stored factors, matrices and pyamg's hierarchy.

    `agreement` is the largest difference of the two solutions relative to the largest displacement.
    """

    unknowns: int
    k: float
    nu: float
    edge_width: float
    iterations: int
    residual: float
    setup_seconds: float
    solve_seconds: float
    megabytes: float
    direct_seconds: float
    direct_megabytes: float
    agreement: float


#: Width of the edge, depth of the surface layer and extent of the meshes: of a smooth load, and of one with an edge.
_SMOOTH = (0.5, 0.05, 32.0)
_EDGE = (1e-3, 1e-4, 128.0)


def _cases(
    shape: tuple[float, float, float], densities: Iterable[float], materials: Iterable[tuple[float, float]]
) -> list[SolverCase]:
    pairs = tuple(materials)
    return [SolverCase(MeshSpec(*shape, density, 4), k, nu) for density in densities for k, nu in pairs]


#: Four systems of about 1e4 unknowns.
QUICK_STUDY = _cases(_SMOOTH, (0.45,), ((0.0, 0.25), (0.8, 0.45))) + _cases(_EDGE, (0.9,), ((0.0, 0.25), (0.8, 0.45)))

#: Pairs of gradient exponent and Poisson's ratio.
_CORNERS = ((0.0, 0.0), (0.4, 0.25), (0.8, 0.45))

#: 1e4 to 3e5 unknowns, with and without an edge a thousandth of its radius wide.
FULL_STUDY = [
    *_cases(_SMOOTH, (0.42,), ((0.0, 0.0), (0.0, 0.45), (0.4, 0.25), (0.8, 0.0), (0.8, 0.45))),
    *_cases(_SMOOTH, (0.22, 0.12), _CORNERS),
    *_cases(_EDGE, (0.9,), ((0.0, 0.0), (0.0, 0.45), (0.4, 0.25), (0.8, 0.0), (0.8, 0.45))),
    *_cases(_EDGE, (0.45, 0.18), _CORNERS),
]


def solver_table(cases: Iterable[SolverCase] = QUICK_STUDY) -> list[SolverRow]:
    """Solve every case both ways.

    Raises
    ------
    NotConverged
        If a case misses the tolerance of the solver.

    Examples
    --------
    >>> row = solver_table([SolverCase(MeshSpec(0.5, 0.05, 32.0, 1.2, 4), 0.4, 0.25)])[0]
    >>> row.iterations < 20, row.agreement < 1e-8
    (True, True)
    """
    with one_thread:
        return [_row(case) for case in cases]


def _row(case: SolverCase) -> SolverRow:
    grid = case.spec.grid()
    half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, case.k, case.nu), case.spec.order)
    load = np.zeros(half_space.elements.size)
    load[half_space.surface] = _LOAD(trace_of(grid, case.spec.order))
    begin = time.perf_counter()
    preconditioner = ElasticPreconditioner(half_space)
    setup = time.perf_counter() - begin
    iterative = solve_cg(half_space, load, preconditioner)
    direct = solve_direct(half_space, load)
    return SolverRow(
        half_space.unknowns,
        case.k,
        case.nu,
        case.spec.edge_width,
        int(iterative.iterations.max()),
        iterative.residual,
        setup,
        iterative.seconds,
        preconditioner.storage / 1e6,
        direct.seconds,
        direct.storage / 1e6,
        float(np.abs(iterative.solution - direct.solution).max() / np.abs(direct.solution).max()),
    )
