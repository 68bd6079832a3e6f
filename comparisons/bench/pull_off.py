"""Pull-off force of one problem by each solver: CPU time of the first of a process and of a further one, memory."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import fem_reference
import fscm
from comparisons.bench.part import Numbers
from comparisons.models.fem_model import FiniteElements
from comparisons.problem import Problem
from fscm.stieltjes import StieltjesScheme, find_event

Output = TypeVar("Output")

#: Computations of one measurement: the least CPU time of them counts, because other programs only add to it.
_REPEATS = 3
#: A computation that takes so many seconds of CPU is not repeated: a disturbance is then a small part of it.
_LONG = 1.0

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


def cost_of_pull_off(n: float, k: float, mu: float, model: str, setting: str) -> Numbers:
    """Return the pull-off force of a problem by a solver, with its bound, unknowns, CPU times and memory.

    ``cold_seconds`` is the CPU time of the first pull-off force of the process, with the imports that it needs, and
    ``megabytes`` the peak of the memory of the process after it; ``cpu_seconds`` is the CPU time of a further one.

    Parameters
    ----------
    n, k, mu : float
    model : str
        fscm, fem or fscm-stieltjes.
    setting : str
        An accuracy (fscm, fem), or how many segments (fscm-stieltjes).
    """

    def solved(factor: float) -> _Solved:
        return _SOLVERS[model](fscm.Problem(n, k, factor * mu), setting)

    begin = time.process_time()
    solved(_NEIGHBOUR)
    cold, peak = time.process_time() - begin, peak_memory()
    (value, u_num, unknowns), seconds = cpu_seconds(lambda repetition: solved(1.0 + _APART * repetition))
    numbers = {"value": value, "u_num": u_num, "unknowns": unknowns}
    return {**numbers, "cpu_seconds": seconds, "cold_seconds": cold, "megabytes": peak}


def cpu_seconds(compute: Callable[[int], Output]) -> tuple[Output, float]:
    """Return the first output of a computation, and its least CPU time in several repetitions.

    Parameters
    ----------
    compute : callable
        Is called with the number of the repetition, by which it can change its problem a little: a solver that
        remembers a problem would be too fast the second time.

    Examples
    --------
    >>> output, seconds = cpu_seconds(lambda repetition: sum(range(1000)) + repetition)
    >>> output, seconds >= 0.0
    (499500, True)
    """
    outputs, times = [], []
    for repetition in range(_REPEATS):
        begin = time.process_time()
        outputs.append(compute(repetition))
        times.append(time.process_time() - begin)
        if times[-1] > _LONG:
            break
    return outputs[0], min(times)


def peak_memory() -> float | None:
    """Return the peak of the resident memory of this process in MB (1e6 bytes); None where no /proc tells it."""
    # Not getrusage: its maximum is inherited from the parent across exec.
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
    except OSError:
        return None
    fields = dict(line.split(":", 1) for line in status.splitlines())
    return 1024e-6 * float(fields["VmHWM"].split()[0])
