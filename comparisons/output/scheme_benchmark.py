"""Time, memory and error of the accurate solver beside the Stieltjes scheme, for the same task.

Each model is evaluated in a fresh process: start-up costs and memory are its own, and neither finds the results
of the other.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import pandas as pd
from threadpoolctl import threadpool_limits

from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task, evaluate_task

__all__ = ["Measurement", "compare", "measure"]


@dataclass(frozen=True, slots=True)
class Measurement:
    """A row and what it took.

    Attributes
    ----------
    row : Row
        The result, with the seconds of the computation alone.
    peak_memory : float or None
        Largest resident memory of the process in MB (1e6 bytes), Python and libraries included; None where
        the system does not report it.
    """

    row: Row
    peak_memory: float | None


def measure(task: Task) -> Measurement:
    """Evaluate a task in a process of its own."""
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        return pool.submit(_measured, task).result()


def _measured(task: Task) -> Measurement:
    with threadpool_limits(1):
        return Measurement(evaluate_task(task), _peak_memory())


def _peak_memory() -> float | None:
    # Not getrusage: its maximum is inherited from the parent across exec.
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
    except OSError:
        return None
    return next(1024e-6 * float(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM:"))


def compare(accurate: Measurement, baseline: Measurement) -> pd.DataFrame:
    """Return a table of both and of the ratios baseline / accurate.

    The error of the accurate model is its own bound `u_num`; that of the baseline is its distance from the
    accurate value, less that bound: so the ratio of errors is a lower bound.
    """
    value, bound = accurate.row.value, accurate.row.u_num
    other = baseline.row.value
    if value is None or bound is None or other is None:
        raise ValueError("both models must have a value for this task; one of them has none")
    error = max(abs(other - value) - bound, 0.0)
    lines = [
        ("value", value, other, None),
        ("error (bound for the accurate model)", bound, error, error / bound),
        ("seconds", accurate.row.seconds, baseline.row.seconds, baseline.row.seconds / accurate.row.seconds),
        ("unknowns", accurate.row.size, baseline.row.size, None),
        ("peak memory (MB)", accurate.peak_memory, baseline.peak_memory, None),
    ]
    return pd.DataFrame(lines, columns=["", accurate.row.model, baseline.row.model, "ratio"])
