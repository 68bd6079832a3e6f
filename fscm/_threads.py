"""Limit of the linear algebra to one thread.

The matrices of this package have some hundred rows.  More threads gain little on an idle machine, and on a busy one
they wait for each other: a computation then takes many times longer.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from threadpoolctl import ThreadpoolController

__all__ = ["one_thread"]


@cache
def _blas(with_scipy: bool) -> ThreadpoolController:
    """The BLAS libraries of NumPy and SciPy; found once each, because the search takes milliseconds."""
    return ThreadpoolController().select(user_api="blas")


@contextmanager
def one_thread() -> Iterator[None]:
    """Limit BLAS to one thread; also a decorator.  What was set before is restored, after an exception as well.

    The limit holds for the whole process, and for the libraries that are loaded: a module that computes with those of
    SciPy imports `scipy.linalg`.  Where a library has it already (in a nested call, in another Python thread) nothing
    is done, and nothing is restored: that is left to the call that set it.

    Examples
    --------
    >>> from threadpoolctl import threadpool_info
    >>> with one_thread():
    ...     {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}
    {1}
    """
    blas = _blas("scipy.linalg" in sys.modules)
    free = [library.filepath for library in blas.lib_controllers if library.num_threads > 1]
    if not free:
        yield
    else:
        with blas.select(filepath=free).limit(limits=1):
            yield
