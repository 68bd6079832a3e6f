"""Worker processes: one function for many items, in processes that end with their parent."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from contextlib import closing, contextmanager
from importlib import import_module
from multiprocessing import active_children, get_context, parent_process, resource_tracker
from multiprocessing.process import BaseProcess
from types import FrameType
from typing import TypeVar

from threadpoolctl import threadpool_limits

from comparisons.console.progress import log

Item = TypeVar("Item")
Output = TypeVar("Output")

#: Why an item has no output of its own; that may be the machine's fault and not the item's.
LOST = "its worker process ended twice before it was finished, perhaps for lack of memory"

#: Items in sequence whose process ends.  More are no fault of single items: the processes cannot start, or the machine
#: has no memory for any of them.
_DEATHS_IN_SEQUENCE = 10


def processes(
    function: Callable[[Item], Output], items: Sequence[Item], jobs: int
) -> Generator[tuple[Item, Output | None]]:
    """Yield every item with its output, in any order; None if the process that worked on it ended.

    With one job the function is called in this process.
    """
    if jobs == 1 or not items:
        for item in items:
            yield item, function(item)
        return
    workers = _Workers(min(jobs, len(items)))
    finished = 0
    try:
        for future in workers.submit(function, items):
            finished += 1
            yield future.result()
    finally:
        workers.end(at_once=finished < len(items))


class _Workers:
    """Threads that have a process each.

    If a process ends, its thread tells on which item it worked and starts another one; the others go on.  The threads
    start the processes, so that Ctrl-C, which Python handles in the main thread, does not interrupt a start.
    """

    def __init__(self, count: int) -> None:
        if sys.platform != "win32":
            # Its start changes the mask of signals of the thread that starts it.
            resource_tracker.ensure_running()
        self._threads = ThreadPoolExecutor(count, initializer=_block_interrupts)
        self._own = threading.local()
        self._pools: list[ProcessPoolExecutor] = []
        self._lock = threading.Lock()
        self._ended = False

    def submit(
        self, function: Callable[[Item], Output], items: Iterable[Item]
    ) -> Iterator[Future[tuple[Item, Output | None]]]:
        """Yield a future for each item as it is finished."""
        # An interruption within a lock of the queue, which Python can leave locked, would hang the end of the threads.
        with _interrupts_later():
            futures = [self._threads.submit(self._call, function, item) for item in items]
        yield from as_completed(futures)

    def _call(self, function: Callable[[Item], Output], item: Item) -> tuple[Item, Output | None]:
        try:
            with self._lock:
                future = self._pool().submit(function, item)
            return item, future.result()
        except BrokenExecutor:
            self._own.pool = None
            return item, None

    def _pool(self) -> ProcessPoolExecutor:
        """Return the process of this thread."""
        if self._ended:
            raise BrokenExecutor
        pool: ProcessPoolExecutor | None = getattr(self._own, "pool", None)
        if pool is None:
            # "spawn": a fresh interpreter, the same on every platform, and safe beside threads.
            pool = self._own.pool = ProcessPoolExecutor(1, get_context("spawn"), initializer=_start_worker)
            self._pools.append(pool)
        return pool

    def end(self, at_once: bool) -> None:
        """End the processes, also those that are at work if `at_once`."""
        with self._lock:
            self._ended = True
            for process in active_children() if at_once else ():
                process.terminate()
        self._threads.shutdown(cancel_futures=True)
        for pool in self._pools:
            pool.shutdown()


@contextmanager
def _interrupts_later() -> Iterator[None]:
    """Let Ctrl-C, and the signal that ends a process, wait for the end of the block."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    arrived: list[tuple[int, FrameType | None]] = []
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    waiting = {number: handler for number, handler in handlers.items() if callable(handler)}
    for number in waiting:
        signal.signal(number, lambda *details: arrived.append(details))
    try:
        yield
    finally:
        for number, handler in waiting.items():
            signal.signal(number, handler)
        for first, frame in arrived[:1]:
            waiting[signal.Signals(first)](first, frame)


def _block_interrupts() -> None:
    # The processes that a thread starts inherit its mask: Ctrl-C is left to their parent, which ends them.
    if sys.platform != "win32":
        signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])


def _whole(item: Item) -> Iterable[Item]:
    return [item]


def each(
    function: Callable[[Item], Output],
    items: Sequence[Item],
    jobs: int,
    *,
    lost: Callable[[Item], Output],
    split: Callable[[Item], Iterable[Item]] = _whole,
) -> Generator[Output]:
    """Yield `function(item)` for every item, as each is finished.

    An item whose process ends is tried once more.  Closing the generator (`contextlib.closing`) before its end drops
    what has not begun.

    Parameters
    ----------
    function : callable
        Importable by its name; returns no None.
    items : sequence
        What it is called with, the longest work first: if it starts last, the other cores wait for it.
    jobs : int
        Number of processes.
    lost : callable
        Returns the output for an item that has ended its process twice.
    split : callable
        Returns the items that are tried in place of one whose process ended.

    Raises
    ------
    concurrent.futures.BrokenExecutor
        If the processes cannot work.

    Examples
    --------
    >>> sorted(each(abs, [-1, 2], 1, lost=lambda item: 0))
    [1, 2]
    """
    again: list[Item] = []
    deaths = 0
    with closing(processes(function, items, jobs)) as outputs:
        for item, output in outputs:
            if output is not None:
                deaths = 0
                yield output
                continue
            again.extend(split(item))
            deaths += 1
            if deaths > _DEATHS_IN_SEQUENCE:
                raise BrokenExecutor(
                    f"{deaths} worker processes one after the other ended early, perhaps for lack of memory"
                )
    if again:
        log(f"worker processes ended early: what they worked on ({len(again)}) is tried once more")
        with closing(processes(function, again, jobs)) as outputs:
            for item, output in outputs:
                yield lost(item) if output is None else output


def one_thread() -> None:
    """Limit the linear algebra of this process to one thread: the processes share the cores."""
    # Only libraries that are loaded can be limited: this loads the linear algebra of both NumPy and SciPy.
    import_module("scipy.linalg")
    threadpool_limits(1)


def _start_worker() -> None:
    """Prepare a worker process: one thread, and an end as soon as the parent ends."""
    one_thread()
    if sys.platform == "win32":  # which has no mask to inherit
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    if parent := parent_process():
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)
