"""Backends by name: processes of this machine, or a Dask cluster."""

from __future__ import annotations

from comparisons.runs.workers import Backend, processes

__all__ = ["BACKENDS", "backend_of"]

#: Names of the backends; the first is the default.
BACKENDS = ("processes", "dask")


def backend_of(name: str, scheduler: str | None = None) -> Backend:
    """Return the backend of a name.

    Parameters
    ----------
    name : str
        One of `BACKENDS`.
    scheduler : str, optional
        The address of the scheduler of a Dask cluster.

    Raises
    ------
    ValueError
        If there is no such backend, it has no scheduler, or its package is not installed.

    Examples
    --------
    >>> backend_of("processes") is processes
    True
    """
    if name == "dask":
        from comparisons.runs.dask_cluster import dask_cluster

        return dask_cluster(scheduler)
    if name not in BACKENDS:
        raise ValueError(f"unknown backend {name!r}: the backends are {', '.join(BACKENDS)}")
    if scheduler is not None:
        raise ValueError(f"the scheduler {scheduler} belongs to the backend 'dask', and the backend is {name!r}")
    return processes
