"""Limits of an external model: time, memory and size of files.

The limits are environment variables, so that they reach every process of a run:

    FSCM_BENCH_TIME_LIMIT     seconds for one evaluation, and for loading (60)
    FSCM_BENCH_MEMORY_LIMIT   MB of address space (4096)
"""

from __future__ import annotations

import os
import time

__all__ = ["MEMORY_LIMIT", "TIME_LIMIT", "cpu_seconds_from_now", "limit_memory_and_files", "limit_of_environment"]

#: Names of the environment variables.
TIME_LIMIT, MEMORY_LIMIT = "FSCM_BENCH_TIME_LIMIT", "FSCM_BENCH_MEMORY_LIMIT"
_DEFAULTS = {TIME_LIMIT: 60.0, MEMORY_LIMIT: 4096.0}

#: Bytes of one file in the scratch folder.
_LARGEST_FILE = 256_000_000

#: The parent ends an evaluation by the clock; the limit of processor time is for what survives the parent.
_GRACE = 10.0


def limit_of_environment(name: str) -> float:
    """Return the limit that an environment variable sets.

    Raises
    ------
    ValueError
        If it is not a positive number.

    Examples
    --------
    >>> limit_of_environment("FSCM_BENCH_MEMORY_LIMIT")
    4096.0
    """
    text = os.environ.get(name) or _DEFAULTS[name]
    try:
        value = float(text)
    except ValueError:
        raise ValueError(f"{name} = {text!r} is not a number") from None
    if not 0 < value < 1e9:
        raise ValueError(f"{name} = {value:g} is outside (0, 1e9): a limit is positive and finite")
    return value


def limit_memory_and_files(megabytes: float) -> None:
    """Bind this process, for good (a superuser could raise the limits again)."""
    import resource  # Not on Windows, where models that are code are refused before this.

    for kind, value in (
        (resource.RLIMIT_AS, int(1e6 * megabytes)),
        (resource.RLIMIT_FSIZE, _LARGEST_FILE),
        (resource.RLIMIT_CORE, 0),
    ):
        value = _at_most(value, resource.getrlimit(kind)[1])
        resource.setrlimit(kind, (value, value))


def cpu_seconds_from_now(seconds: float) -> None:
    """Set the limit of processor time of this process far above the time of one evaluation from now on."""
    import resource

    allowed = int(time.process_time() + (seconds + _GRACE) * (os.cpu_count() or 1)) + 1
    _, hard = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (_at_most(allowed, hard), hard))


def _at_most(value: int, hard: int) -> int:
    return value if hard < 0 else min(value, hard)
