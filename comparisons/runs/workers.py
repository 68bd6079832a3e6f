"""Worker processes: one function for many items, in processes that end with their parent."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Generator, Hashable, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, ProcessPoolExecutor, wait
from contextlib import closing
from functools import partial
from importlib import import_module
from multiprocessing import get_context, parent_process
from multiprocessing.process import BaseProcess
from typing import Any, TypeVar

from threadpoolctl import threadpool_limits

from comparisons.console.progress import log
from comparisons.runs.interrupts import blocked, handled_later, unblock
from comparisons.runs.waiting import Waiting

__all__ = [
    "LOST",
    "Backend",
    "Processes",
    "each",
    "one_thread",
    "processes",
    "start_worker",
    "usable_cores",
]

Item = TypeVar("Item")
Output = TypeVar("Output")

#: Why an item has no output of its own; that may be the machine's fault and not the item's.
LOST = "its worker process ended twice before it was finished, perhaps for lack of memory"

#: Calls a function with every item, on a number of processes, and yields each item with its output, in any order; the
#: output is None if the process that worked on the item ended.
Backend = Callable[[Callable[[Any], Any], Sequence[Any], int], Generator[tuple[Any, Any]]]

#: Processes that may end one after the other without an output between them.  More are no fault of single items: the
#: processes cannot start, or the machine has no memory for any of them.
_DEATHS_IN_SEQUENCE = 10


def usable_cores() -> int:
    """Return the number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _whole(item: Item) -> Iterable[Item]:
    return [item]


def _all_alike(item: Any) -> Hashable:
    return None


class Processes:
    """Processes of this machine: a `Backend`.

    A process that ends is replaced.  With one job the function is called in this process.  In a block
    ``with Processes() as backend:`` one call after the other works on the same processes, which end with the block;
    without a block they end with each call.
    """

    def __init__(self) -> None:
        # An executor for each process: if the process ends, that tells on which item it worked, and the others go on.
        self._kept: list[ProcessPoolExecutor] | None = None

    def __enter__(self) -> Processes:
        self._kept = []
        return self

    def __exit__(self, *_: object) -> None:
        pools, self._kept = self._kept or [], None
        _end(pools)

    def __call__(
        self,
        function: Callable[[Item], Output],
        items: Sequence[Item],
        jobs: int,
        alike: Callable[[Item], Hashable] = _all_alike,
    ) -> Generator[tuple[Item, Output | None]]:
        """Yield each item with its output, as `Backend` states; items that are `alike` go to one process.

        Raises
        ------
        concurrent.futures.BrokenExecutor
            If many processes end one after the other.
        """
        if jobs == 1:
            for item in items:
                yield item, function(item)
            return
        count = min(jobs, len(items))
        kept, self._kept = self._kept, None if self._kept is None else []
        pools = [*(kept or [])]
        pools.extend(_pool() for _ in range(count - len(pools)))
        finished = False
        try:
            yield from _outputs(function, Waiting(items, alike), pools, count)
            finished = True
        finally:
            # What has not finished may still be at work.
            if finished and self._kept is not None:
                self._kept.extend(pools)
            else:
                _end(pools)


#: Processes that end with each call.
processes = Processes()


def _outputs(
    function: Callable[[Item], Output], waiting: Waiting[Item], pools: list[ProcessPoolExecutor], count: int
) -> Generator[tuple[Item, Output | None]]:
    """Work on the items by the first pools; a pool whose process ends is replaced in the list."""
    running: dict[Future[Output], tuple[int, Item]] = {}

    def begin(slot: int) -> None:
        item = waiting.take(slot)
        try:
            future = _submitted(pools[slot], function, item)
        except BrokenExecutor:  # the process ended between two items
            waiting.forget(slot)
            pools[slot] = _pool()
            future = _submitted(pools[slot], function, item)
        running[future] = slot, item

    deaths = 0
    for slot in range(count):
        begin(slot)
    while running:
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            slot, item = running.pop(future)
            try:
                output = future.result()
                deaths = 0
            except BrokenExecutor:
                output = None
                deaths += 1
                if deaths > _DEATHS_IN_SEQUENCE:
                    raise BrokenExecutor(
                        f"{deaths} worker processes one after the other ended early, perhaps for lack of memory"
                    ) from None
                pools[slot].shutdown(wait=False)
                waiting.forget(slot)
                pools[slot] = _pool()
            if waiting:
                begin(slot)
            yield item, output


def _end(pools: Sequence[ProcessPoolExecutor]) -> None:
    for pool in pools:
        pool.shutdown(cancel_futures=True)


def each(
    function: Callable[[Item], Output],
    items: Sequence[Item],
    jobs: int,
    *,
    lost: Callable[[Item], Output],
    split: Callable[[Item], Iterable[Item]] = _whole,
    alike: Callable[[Item], Hashable] = _all_alike,
    backend: Backend = processes,
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
    alike : callable
        Returns the same for items whose work shares tables: of the next items, a process of this machine gets those
        that are like its earlier ones.
    backend : Backend
        Where the function is called.

    Raises
    ------
    concurrent.futures.BrokenExecutor
        If the backend cannot work.

    Examples
    --------
    >>> sorted(each(abs, [-1, 2], 1, lost=lambda item: 0))
    [1, 2]
    """
    again: list[Item] = []
    called = partial(backend, alike=alike) if isinstance(backend, Processes) else backend
    with closing(called(function, items, jobs)) as outputs:
        for item, output in outputs:
            if output is None:
                again.extend(split(item))
            else:
                yield output
    if again:
        log(f"worker processes ended early: what they worked on ({len(again)}) is tried once more")
        with closing(called(function, again, jobs)) as outputs:
            for item, output in outputs:
                yield lost(item) if output is None else output


def one_thread() -> None:
    """Limit the linear algebra of this process to one thread: the processes share the cores."""
    # Only libraries that are loaded can be limited: this loads the linear algebra of both NumPy and SciPy.
    import_module("scipy.linalg")
    threadpool_limits(1)


def _pool() -> ProcessPoolExecutor:
    # "spawn": a fresh interpreter, the same on every platform, and safe beside the threads of a progress bar.
    return ProcessPoolExecutor(1, get_context("spawn"), initializer=_start_interruptible_worker)


def _submitted(pool: ProcessPoolExecutor, function: Callable[[Item], Output], item: Item) -> Future[Output]:
    # This may start the process.  Ctrl-C while it imports would be a traceback: the process receives it afterwards.
    with handled_later(signal.SIGINT, signal.SIGTERM), blocked(signal.SIGINT):
        return pool.submit(function, item)


def _start_interruptible_worker() -> None:
    start_worker()
    unblock(signal.SIGINT)


def start_worker() -> None:
    """Prepare a worker process: one thread, and an end as soon as the parent ends."""
    one_thread()
    # Ctrl-C reaches the whole process group: end at once, without a traceback; the parent writes the message.
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    parent = parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)
