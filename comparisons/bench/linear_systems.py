"""One linear system of the finite elements, solved in one way, with CPU time and memory."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from scipy import linalg

from comparisons.bench.measuring import memory, reset_peak
from comparisons.bench.part import Numbers, Settings
from fem_reference._elastic.assembly import HalfSpace, assemble_half_space
from fem_reference._elastic.condensation import condensed
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.trace import trace_of
from fem_reference._linear.linear_solver import solve_cg, solve_direct
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._typing import Array
from fem_reference.modulus import PowerLawModulus
from fem_reference.verification.load_vectors import smooth_load
from fem_reference.verification.solver_study import LOAD_RADIUS

__all__ = ["METHODS", "measure"]

#: Width of the edge, depth of the first layer and extent of the mesh, in units of the edge radius, as in the study of
#: the linear solver; degree of the elements.
_EDGE, _ORDER = (1e-3, 1e-4, 128.0), 4


class _Clock:
    """CPU time between two readings."""

    def __init__(self) -> None:
        self._last = time.process_time()

    def read(self) -> float:
        """Return the seconds since the last reading."""
        before, self._last = self._last, time.process_time()
        return self._last - before


#: Solves under a load, with the clock that has just been read; returns the displacement of the surface, and numbers.
_Method = Callable[[HalfSpace, Array, _Clock], tuple[Array, Numbers]]


def measure(settings: Settings) -> Numbers:
    """Assemble a system, solve it, and return unknowns, iterations, CPU times and memory.

    ``megabytes`` is the peak of the memory while it is solved, less the memory that was in use before: matrix and mesh.

    Parameters
    ----------
    settings : dict
        ``method`` (of `METHODS`), ``density`` of the mesh, ``k`` and ``nu``; ``shape`` of the mesh where it is not
        that of the study.
    """
    edge_width, surface_depth, extent = settings.get("shape", _EDGE)
    method = METHODS[settings["method"]]
    # The first factorisation and the first set-up of pyamg import modules.
    _solve(method, MeshSpec(0.5, 0.05, 32.0, 1.5, _ORDER), settings)
    return _solve(method, MeshSpec(edge_width, surface_depth, extent, settings["density"], _ORDER), settings)


def _solve(method: _Method, spec: MeshSpec, settings: Settings) -> Numbers:
    clock = _Clock()
    grid = spec.grid()
    half_space = assemble_half_space(grid, PowerLawModulus(1.0, 1.0, settings["k"]), settings["nu"], _ORDER)
    load = np.zeros(half_space.matrix.shape[0])
    load[half_space.surface] = smooth_load(lambda r: np.exp(-((r / LOAD_RADIUS) ** 2)))(trace_of(grid, _ORDER))
    assembly = clock.read()
    before = memory()
    reset_peak()
    clock.read()
    surface, numbers = method(half_space, load, clock)
    peak = memory("VmHWM")
    return {
        "unknowns": half_space.unknowns,
        **numbers,
        "assembly_seconds": assembly,
        "megabytes": None if before is None or peak is None else peak - before,
        "displacement": float(surface[0]),
    }


def _by_pyamg(half_space: HalfSpace, load: Array, clock: _Clock) -> tuple[Array, Numbers]:
    preconditioner = ElasticPreconditioner(half_space)
    setup = clock.read()
    found = solve_cg(half_space, load, preconditioner)
    numbers = {"iterations": found.iterations, "residual": found.residual}
    return found.solution[half_space.surface], {**numbers, "setup_seconds": setup, "solve_seconds": clock.read()}


def _direct(half_space: HalfSpace, load: Array, clock: _Clock) -> tuple[Array, Numbers]:
    found = solve_direct(half_space, load)
    numbers = {"iterations": 0, "residual": found.residual}
    return found.solution[half_space.surface], {**numbers, "setup_seconds": 0.0, "solve_seconds": clock.read()}


def _condensed(half_space: HalfSpace, load: Array, clock: _Clock) -> tuple[Array, Numbers]:
    stiffness, _ = condensed(half_space)
    setup = clock.read()
    forces = load[half_space.surface]
    surface = linalg.cho_solve(linalg.cho_factor(stiffness), forces)
    residual = float(np.linalg.norm(stiffness @ surface - forces) / np.linalg.norm(forces))
    numbers = {"iterations": 0, "residual": residual}
    return surface, {**numbers, "setup_seconds": setup, "solve_seconds": clock.read()}


#: Name -> the method: "direct" factorises and solves at once, which is all in ``solve_seconds``.
METHODS: dict[str, _Method] = {"pyamg": _by_pyamg, "direct": _direct, "condensed": _condensed}
