"""Total time of the models of a submission, which an environment variable states to every process of a run."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager

#: When the time is over, on the clock of the system that all its processes have.
_END = "FSCM_BENCH_END_OF_TIME"


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Let the models that are evaluated in the block, by any process, have so much time together.

    Examples
    --------
    >>> with at_most(10.0):
    ...     9.0 < seconds_left() <= 10.0
    True
    >>> seconds_left()
    inf
    """
    before = os.environ.get(_END)
    os.environ[_END] = repr(time.monotonic() + seconds)
    try:
        yield
    finally:
        del os.environ[_END]
        if before is not None:
            os.environ[_END] = before


def seconds_left() -> float:
    """Return the time that is left, negative after its end; infinite where it is not limited."""
    end = os.environ.get(_END)
    return math.inf if end is None else float(end) - time.monotonic()
