"""Workers of a Dask cluster, which may be on other machines.

Dask is an optional dependency (``pip install "fscm-bench[cluster]"``) and imported when it is used.
"""

from __future__ import annotations

import logging
import signal
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError
from contextlib import contextmanager
from functools import lru_cache, partial
from typing import Any, TypeVar

from comparisons.console.progress import note
from comparisons.runs.workers import Backend, one_thread

__all__ = ["dask_cluster"]

Item = TypeVar("Item")
Output = TypeVar("Output")

#: Seconds until a scheduler that does not respond is given up.
_TIMEOUT = 20


def dask_cluster(scheduler: str | None = None) -> Backend:
    """Return the backend that works on a Dask cluster (see `comparisons.runs.workers.Backend`).

    Parameters
    ----------
    scheduler : str, optional
        The address of the scheduler, as ``tcp://10.0.0.1:8786``; by default a cluster is started on this machine, with
        as many processes as there are jobs.

    Raises
    ------
    ValueError
        If Dask is not installed, or the address is not one.
    """
    try:
        from distributed.comm.addressing import parse_address, parse_host_port
    except ImportError:
        raise ValueError(
            "the backend 'dask' needs the package distributed, which is not installed: "
            "pip install 'fscm-bench[cluster]', or use the backend 'processes'"
        ) from None
    try:
        parse_host_port(parse_address(scheduler or "tcp://localhost:0")[1])
    except ValueError as error:
        raise ValueError(f"the scheduler {scheduler} is not an address such as tcp://10.0.0.1:8786 ({error})") from None
    return partial(_on_cluster, scheduler)


def _on_cluster(
    scheduler: str | None, function: Callable[[Item], Output], items: Sequence[Item], jobs: int
) -> Generator[tuple[Item, Output | None]]:
    from distributed import KilledWorker, as_completed

    with _client(scheduler, jobs) as client, client.as_current():
        futures = client.map(partial(_in_worker, function), list(items), pure=False)
        of_key = {future.key: item for future, item in zip(futures, items, strict=True)}
        finished = as_completed(futures)
        # The cluster keeps an output as long as there is a future of it.
        del futures
        for future in finished:
            try:
                output = future.result()
            except KilledWorker:
                output = None
            except (CancelledError, OSError) as error:
                raise BrokenExecutor(f"the connection to the Dask scheduler was lost ({error})") from None
            yield of_key[future.key], output


@contextmanager
def _client(scheduler: str | None, jobs: int) -> Iterator[Any]:
    import dask
    from distributed import Client, LocalCluster

    # Its messages about workers that end are not for users of the command line.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    if scheduler is not None:
        try:
            client = Client(scheduler, timeout=_TIMEOUT, set_as_default=False)
        except (OSError, ValueError) as error:
            raise ValueError(
                f"the Dask scheduler {scheduler} cannot be reached ({error}): "
                "start it with `dask scheduler` and give the address that it prints"
            ) from None
        with client:
            note(f"the Dask scheduler {scheduler} has {len(client.scheduler_info(n_workers=-1)['workers'])} workers")
            yield client
        return
    settings = {
        # An item whose worker ends is given back at once, and a worker holds no second one that would be suspected too.
        "distributed.scheduler.allowed-failures": 0,
        "distributed.scheduler.worker-saturation": 1.0,
        # Memory is left to the system, as with the backend of processes.
        "distributed.worker.memory.terminate": False,
        "distributed.worker.memory.pause": False,
    }
    with dask.config.set(settings):
        # The processes inherit that Ctrl-C is ignored: it reaches the whole group, and their parent ends them.
        handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            cluster = LocalCluster(
                n_workers=jobs,
                threads_per_worker=1,
                processes=True,
                memory_limit=0,
                dashboard_address=None,
                silence_logs=logging.CRITICAL,
            )
        finally:
            signal.signal(signal.SIGINT, handler)
        with cluster, Client(cluster, set_as_default=False) as client:
            yield client


def _in_worker(function: Callable[[Item], Output], item: Item) -> Output:
    _prepare()
    return function(item)


@lru_cache(maxsize=1)
def _prepare() -> None:
    """Limit the linear algebra of a worker to one thread; `ValueError` if it computes two items at once."""
    from distributed import get_worker

    worker = get_worker()
    threads = worker.state.nthreads
    if threads != 1:
        raise ValueError(
            f"the Dask worker {worker.address} has {threads} threads, and the solvers need processes of one thread: "
            "start it with `dask worker --nworkers N --nthreads 1`"
        )
    one_thread()
