"""One BLAS thread for the duration of a computation.

The matrices here are small: several threads gain nothing, and on a busy machine they wait for each other (a solve then
takes about ten times as long).
"""

from __future__ import annotations

import threading
from functools import lru_cache
from types import TracebackType

import scipy.linalg  # noqa: F401  # only loaded libraries can be limited
from threadpoolctl import ThreadpoolController

__all__ = ["one_thread"]


@lru_cache(maxsize=1)
def _controller() -> ThreadpoolController:
    return ThreadpoolController()


class _OneThread:
    """Reentrant context: BLAS has one thread inside, and as many as before after it.

    The limit belongs to the process.  The Python thread that set it restores it; another that enters meanwhile
    changes nothing.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._owner: int | None = None
        self._depth = 0

    def __enter__(self) -> None:
        me = threading.get_ident()
        with self._lock:
            if self._owner is None:
                self._limiter = _controller().limit(limits=1, user_api="blas")
                self._limiter.__enter__()
                self._owner = me
            if self._owner == me:
                self._depth += 1

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        with self._lock:
            if self._owner == threading.get_ident():
                self._depth -= 1
                if self._depth == 0:
                    self._owner = None
                    self._limiter.__exit__(kind, error, at)


#: Use as ``with one_thread:`` around a computation.
one_thread = _OneThread()
