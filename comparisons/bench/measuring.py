"""Measurements of CPU time and memory, each in a process of its own."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children, get_context, resource_tracker
from multiprocessing.forkserver import ensure_running
from pathlib import Path
from typing import TypeVar

from comparisons.bench.part import Measurement, Part, Settings
from comparisons.runs.interrupts import blocked, handled_later
from comparisons.runs.workers import start_worker

__all__ = ["cpu_seconds", "made", "memory", "reset_peak"]

Output = TypeVar("Output")

#: Computations of one measurement: the least CPU time of them counts, because other programs only add to it.
_REPEATS = 3
#: A computation that takes so many seconds of CPU is not repeated: a disturbance is then a small part of it.
_LONG = 1.0

#: What the process from which the others are made imports before, so that no measurement contains the imports.
_PRELOADED = [
    "comparisons.bench.registry",
    "fscm.solve",
    "fscm.states",
    "fem_reference",
    "scipy.optimize",
    "scipy.linalg",
]

#: Environment variables by which libraries of linear algebra start with one thread.
_ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")

#: Why a measurement has no numbers if its process ended.
ENDED = "its process ended before it was finished, perhaps for lack of memory"


def made(part: Part, settings: Settings) -> Measurement:
    """Make a measurement, in a new process if the part wants that; one that fails has the reason."""
    if not part.own_process:
        return _made(part.name, part.measure, settings)
    context = get_context("forkserver")
    context.set_forkserver_preload(_PRELOADED)
    resource_tracker.ensure_running()  # which changes the mask of signals
    with _one_thread_at_start(), handled_later(signal.SIGINT), blocked(signal.SIGINT):
        # Processes inherit the mask: Ctrl-C reaches them and is left to this process, which ends them.
        ensure_running()
    others = active_children()
    pool = ProcessPoolExecutor(1, context, initializer=start_worker)
    try:
        # A process whose start is interrupted would end with a traceback.
        with handled_later(signal.SIGINT, signal.SIGTERM):
            future = pool.submit(_made, part.name, part.measure, settings)
        return future.result()
    except BrokenExecutor:
        return Measurement(part.name, settings, status="failed", reason=ENDED)
    except BaseException:
        for process in active_children():
            if process not in others:
                process.terminate()
        raise
    finally:
        pool.shutdown()


def _made(name: str, measure: Callable[[Settings], dict[str, object]], settings: Settings) -> Measurement:
    try:
        return Measurement(name, settings, measure(settings))
    except Exception as error:
        # A model that cannot compute a case costs this measurement and no other.
        return Measurement(name, settings, status="failed", reason=f"{type(error).__name__}: {error}")


@contextmanager
def _one_thread_at_start() -> Iterator[None]:
    """Let new processes start with one thread of linear algebra: one that forks must not have several."""
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def cpu_seconds(compute: Callable[[int], Output], repeats: int = _REPEATS) -> tuple[Output, float]:
    """Return the first output of a computation, and its least CPU time in several repetitions.

    Parameters
    ----------
    compute : callable
        Is called with the number of the repetition, by which it can change its problem a little: a solver that
        remembers a problem would be too fast the second time.
    repeats : int
        How often; a long computation is done once.

    Examples
    --------
    >>> output, seconds = cpu_seconds(lambda repetition: sum(range(1000)) + repetition)
    >>> output, seconds >= 0.0
    (499500, True)
    """
    outputs, times = [], []
    for repetition in range(repeats):
        begin = time.process_time()
        outputs.append(compute(repetition))
        times.append(time.process_time() - begin)
        if times[-1] > _LONG:
            break
    return outputs[0], min(times)


def memory(name: str = "VmRSS") -> float | None:
    """Return the resident memory of this process in MB (1e6 bytes), or its peak with "VmHWM".

    None where the system does not report it.
    """
    # Not getrusage: its maximum is inherited from the parent across exec.
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
    except OSError:
        return None
    return next((1024e-6 * float(line.split()[1]) for line in status.splitlines() if line.startswith(f"{name}:")), None)


def reset_peak() -> None:
    """Begin a new peak of the resident memory; where the system does not allow it, the old one goes on."""
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    except OSError:
        return
