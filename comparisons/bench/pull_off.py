"""Pull-off force of one problem by each solver: CPU time of the first of a process and of a further one, memory."""

from __future__ import annotations

import time
from collections.abc import Callable

import fem_reference
import fscm
from comparisons.bench.measuring import cpu_seconds, peak_memory
from comparisons.bench.part import Numbers, Settings
from comparisons.models.fem_model import FiniteElements
from comparisons.problem import Problem
from fscm.stieltjes import StieltjesScheme, find_event

#: The first problem of a process is a neighbouring one: its Tabor number differs by this factor.
_NEIGHBOUR = 1.1
#: Repetitions have Tabor numbers that differ by this much, so that no stored solution serves them.
_APART = 1e-6

#: Value and bound in units of the pull-off force, and unknowns.
_Solved = tuple[float, float | None, int]


def _by_fscm(problem: fscm.Problem, accuracy: str) -> _Solved:
    solution = fscm.solve(problem, "pull_off_force", float(accuracy))
    return solution.value, solution.u_num, solution.size


def _by_elements(problem: fscm.Problem, accuracy: str) -> _Solved:
    """Solve the physical problem; its load is in the unit of the pull-off force."""
    units, body = FiniteElements().physical(Problem.dimensionless(problem.n, problem.k, problem.mu))
    solution, unit = fem_reference.solve(body, "pull_off_force", accuracy), units["load"]
    return solution.value / unit, solution.u_num / unit, solution.size


def _by_stieltjes(problem: fscm.Problem, segments: str) -> _Solved:
    event = find_event(StieltjesScheme(problem, int(segments)), "pull_off")
    return -event.load, None, int(segments)


_SOLVERS: dict[str, Callable[[fscm.Problem, str], _Solved]] = {
    "fscm": _by_fscm,
    "fem": _by_elements,
    "fscm-stieltjes": _by_stieltjes,
}


def _solve(settings: Settings, factor: float = 1.0) -> Numbers:
    """Solve a problem whose Tabor number has a factor."""
    problem = fscm.Problem(settings["n"], settings["k"], factor * settings["mu"])
    value, u_num, unknowns = _SOLVERS[settings["model"]](problem, settings["setting"])
    return {"value": value, "u_num": u_num, "unknowns": unknowns}


def measure(settings: Settings) -> Numbers:
    """Return the pull-off force of a problem by a solver, with its bound, unknowns, CPU times and memory.

    ``cold_seconds`` is the CPU time of the first pull-off force of the process, with the imports that it needs, and
    ``megabytes`` the peak of the memory of the process after it; ``cpu_seconds`` is the CPU time of a further one.

    Parameters
    ----------
    settings : dict
        ``n``, ``k``, ``mu``, ``model`` and ``setting``: an accuracy (fscm, fem), or how many segments
        (fscm-stieltjes).
    """
    begin = time.process_time()
    _solve(settings, _NEIGHBOUR)
    cold, peak = time.process_time() - begin, peak_memory()
    numbers, seconds = cpu_seconds(lambda repetition: _solve(settings, 1.0 + _APART * repetition))
    return {**numbers, "cpu_seconds": seconds, "cold_seconds": cold, "megabytes": peak}
