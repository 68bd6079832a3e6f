"""Worker processes: one function for many items, in processes that end with their parent."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from multiprocessing import get_context, parent_process
from multiprocessing.process import BaseProcess
from typing import TypeVar

from threadpoolctl import threadpool_limits

__all__ = ["each", "usable_cores"]

Item = TypeVar("Item")
Output = TypeVar("Output")


def usable_cores() -> int:
    """Return the number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def each(function: Callable[[Item], Output], items: Sequence[Item], jobs: int) -> Generator[Output]:
    """Yield `function(item)` for every item, as each is finished, on `jobs` processes.

    Closing the generator (`contextlib.closing`) before its end drops what has not begun.

    Parameters
    ----------
    function : callable
        Importable by its name.
    items : sequence
        What it is called with, the longest work first: if it starts last, the other cores wait for it.
    jobs : int
        Number of processes; 1 works in this one.

    Raises
    ------
    RuntimeError
        If a worker process dies (`concurrent.futures.BrokenExecutor`), as one short of memory does.
    """
    if jobs == 1 or len(items) <= 1:
        yield from map(function, items)
        return
    # "spawn": a fresh interpreter, the same on every platform, and safe beside the threads of a progress bar.
    with ProcessPoolExecutor(min(jobs, len(items)), get_context("spawn"), initializer=_start_worker) as pool:
        pending = [pool.submit(function, item) for item in items]
        try:
            for future in as_completed(pending):
                yield future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _start_worker() -> None:
    """Prepare a worker: one thread, since the workers use all cores, and an end as soon as the parent ends."""
    # Only libraries that are loaded can be limited: this loads the linear algebra of both NumPy and SciPy.
    import_module("scipy.linalg")
    threadpool_limits(1)
    # Ctrl-C reaches the whole process group: end at once, without a traceback; the parent writes the message.
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    parent = parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)
