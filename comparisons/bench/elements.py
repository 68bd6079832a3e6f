"""Linear systems of the finite elements: three ways to solve them, from 1e4 to 5e5 unknowns.

"pyamg" solves the whole system by conjugate gradients with the two-level preconditioner whose coarse level is pyamg's;
"direct" factorises the whole system; "condensed" eliminates all but the surface by nested dissection and solves there.
"""

from __future__ import annotations

import time

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy import linalg

from comparisons.bench.drawing import Panel, lines
from comparisons.bench.measuring import memory, reset_peak
from comparisons.bench.part import Numbers, Part, Settings
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

__all__ = ["ELEMENTS", "METHODS"]

#: Mesh densities, from 1e4 to 2e5 unknowns; the last, 5e5, with `full` only.
_DENSITIES = (0.9, 0.45, 0.3, 0.22, 0.14)
#: k and nu; the first in every run.
_MATERIALS = ((0.4, 0.25), (0.0, 0.0), (0.8, 0.45))

#: Width of the edge, depth of the first layer and extent of the mesh, in units of the edge radius, as in the study of
#: the linear solver; degree of the elements.
_EDGE, _ORDER = (1e-3, 1e-4, 128.0), 4


def plan(full: bool) -> list[Settings]:
    """Return all methods at every size; with `full` up to 5e5 unknowns and for three materials."""
    return [
        {"method": method, "density": density, "k": k, "nu": nu}
        for k, nu in (_MATERIALS if full else _MATERIALS[:1])
        for density in (_DENSITIES if full else _DENSITIES[:-1])
        for method in METHODS
    ]


def measure(settings: Settings) -> Numbers:
    """Assemble a system, solve it, and return unknowns, iterations, CPU times and memory.

    ``megabytes`` is the peak of the memory while it is solved, less the memory that was in use before: matrix and mesh.

    Parameters
    ----------
    settings : dict
        ``method`` (of `METHODS`), ``density`` of the mesh, ``k`` and ``nu``; ``shape`` of the mesh where it is not
        that of the study.
    """
    # The first factorisation and the first set-up of pyamg import modules.
    _solve(MeshSpec(0.5, 0.05, 32.0, 1.5, _ORDER), settings)
    edge_width, surface_depth, extent = settings.get("shape", _EDGE)
    return _solve(MeshSpec(edge_width, surface_depth, extent, settings["density"], _ORDER), settings)


def _solve(spec: MeshSpec, settings: Settings) -> Numbers:
    begin = time.process_time()
    grid = spec.grid()
    half_space = assemble_half_space(grid, PowerLawModulus(1.0, 1.0, settings["k"]), settings["nu"], _ORDER)
    load = np.zeros(half_space.matrix.shape[0])
    load[half_space.surface] = smooth_load(lambda r: np.exp(-((r / LOAD_RADIUS) ** 2)))(trace_of(grid, _ORDER))
    assembled = time.process_time()
    before = memory()
    reset_peak()
    start = time.process_time()
    ready, surface, iterations, residual = METHODS[settings["method"]](half_space, load)
    end = time.process_time()
    peak = memory("VmHWM")
    return {
        "unknowns": half_space.unknowns,
        "iterations": iterations,
        "residual": residual,
        "setup_seconds": ready - start,
        "solve_seconds": end - ready,
        "assembly_seconds": assembled - begin,
        "megabytes": None if before is None or peak is None else peak - before,
        "displacement": float(surface[0]),
    }


#: Of the clock after the set-up, the displacement of the surface under a load, the iterations and the residual.
_Solved = tuple[float, Array, int, float]


def _by_pyamg(half_space: HalfSpace, load: Array) -> _Solved:
    preconditioner = ElasticPreconditioner(half_space)
    ready = time.process_time()
    solution = solve_cg(half_space, load, preconditioner)
    return ready, solution.solution[half_space.surface], solution.iterations, solution.residual


def _direct(half_space: HalfSpace, load: Array) -> _Solved:
    ready = time.process_time()
    solution = solve_direct(half_space, load)
    return ready, solution.solution[half_space.surface], 0, solution.residual


def _condensed(half_space: HalfSpace, load: Array) -> _Solved:
    stiffness, _ = condensed(half_space)
    ready = time.process_time()
    forces = load[half_space.surface]
    surface = linalg.cho_solve(linalg.cho_factor(stiffness), forces)
    return ready, surface, 0, float(np.linalg.norm(stiffness @ surface - forces) / np.linalg.norm(forces))


#: Name -> the method: "direct" factorises and solves at once, which is all in ``solve_seconds``.
METHODS = {"pyamg": _by_pyamg, "direct": _direct, "condensed": _condensed}


def ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the whole time, its ratio and that of memory to those of "pyamg", and the disagreement with "direct".

    The disagreement is the relative difference of the displacements under the centre of the load.
    """
    rows = rows.assign(seconds=rows["setup_seconds"] + rows["solve_seconds"])
    system = ["density", "k", "nu"]

    def of(method: str, name: str) -> Array:
        values = rows[(rows["method"] == method) & (rows["status"] == "ok")].set_index(system)[name]
        return np.asarray(values.reindex(pd.MultiIndex.from_frame(rows[system])), float)

    direct = of("direct", "displacement")
    return rows.assign(
        ratio=rows["seconds"] / of("pyamg", "seconds"),
        memory_ratio=rows["megabytes"] / of("pyamg", "megabytes"),
        disagreement=np.abs(rows["displacement"] - direct) / np.abs(direct),
    )


def _of_every_run(rows: pd.DataFrame) -> pd.DataFrame:
    """Rows of the material that every run has."""
    k, nu = _MATERIALS[0]
    return rows[(rows["k"] == k) & (rows["nu"] == nu)].sort_values("unknowns")


def draw(rows: pd.DataFrame) -> Figure:
    """Draw iterations, time and memory against unknowns, for the material that every run has."""
    labels = {
        "iterations": "iterations to a residual of 1e-10",
        "seconds": "CPU time: set-up and solution (s)",
        "megabytes": "memory beside the matrix, peak (MB)",
    }
    of_material, scales = _of_every_run(rows), {"iterations": "x"}
    panels = [
        Panel(of_material, "unknowns", name, "method", ("unknowns", label), scales.get(name, "xy"))
        for name, label in labels.items()
    ]
    k, nu = _MATERIALS[0]
    return lines(panels, rf"Linear systems of the finite elements, $k$ = {k:g}, $\nu$ = {nu:g}", len(panels))


def summary(rows: pd.DataFrame) -> list[str]:
    """Return time and memory of the other methods over those of "pyamg", and the iterations of that."""
    other_methods = _of_every_run(rows[rows["method"] != "pyamg"])
    table = other_methods.pivot_table(index="unknowns", columns="method", values=["ratio", "memory_ratio"])
    table.columns = pd.Index([f"{name.removesuffix('_ratio')} {method}" for name, method in table.columns])
    iterations = rows.loc[rows["method"] == "pyamg", "iterations"].max()
    text = table.to_string(float_format="%.2f").splitlines() if len(table) else []
    return ["time and memory over those of pyamg:", *text, f"  iterations of pyamg: at most {iterations:.0f}"]


ELEMENTS = Part("elements", "time and memory of the linear solvers of fem", plan, measure, ratios, draw, summary)
