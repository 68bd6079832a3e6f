"""Measurements of CPU time and memory, each in a process of its own."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TypeVar

from comparisons.bench.part import Measurement, Numbers, Part, Settings
from comparisons.runs.workers import processes

Output = TypeVar("Output")

#: Computations of one measurement: the least CPU time of them counts, because other programs only add to it.
_REPEATS = 3
#: A computation that takes so many seconds of CPU is not repeated: a disturbance is then a small part of it.
_LONG = 1.0

#: Why a measurement has no numbers if its process ended.
ENDED = "its process ended before it was finished, perhaps for lack of memory"


def _attempt(measure: Callable[[Settings], Numbers], settings: Settings) -> tuple[Numbers, str]:
    """Make a measurement, or state why there is none."""
    try:
        return measure(settings), ""
    except Exception as error:
        # A model that cannot compute a case costs this measurement and no other.
        return {}, f"{type(error).__name__}: {error}"


def measured(part: Part, settings: Settings) -> Measurement:
    """Make a measurement, in a new process if the part wants that; one that fails has the reason."""
    # With one job the function is called in this process.
    ((_, output),) = processes(partial(_attempt, part.measure), [settings], 2 if part.own_process else 1)
    numbers, reason = output or ({}, ENDED)
    status = "failed" if reason else "ok"
    return {"part": part.name, "settings": settings, "numbers": numbers, "status": status, "reason": reason}


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
