"""Limits of an external model: time, memory and size of files.

The limits are environment variables, so that they reach every process of a run:

    FSCM_BENCH_TIME_LIMIT     seconds for one evaluation, and for loading (60)
    FSCM_BENCH_MEMORY_LIMIT   MB of address space (4096)
"""

from __future__ import annotations

import os

__all__ = ["MEMORY_LIMIT", "TIME_LIMIT", "limit_memory_and_files", "limit_of_environment"]

#: Names of the environment variables.
TIME_LIMIT, MEMORY_LIMIT = "FSCM_BENCH_TIME_LIMIT", "FSCM_BENCH_MEMORY_LIMIT"
_DEFAULTS = {TIME_LIMIT: 60.0, MEMORY_LIMIT: 4096.0}

#: Bytes of one file in the scratch folder.
_LARGEST_FILE = 256_000_000


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
    """Limit this process and its children, for good (a superuser could raise the limits again)."""
    import resource  # Not on Windows, where models that are code are refused before this.

    limits = {
        resource.RLIMIT_AS: int(1e6 * megabytes),
        resource.RLIMIT_FSIZE: _LARGEST_FILE,
        resource.RLIMIT_CORE: 0,
    }
    for kind, value in limits.items():
        hard = resource.getrlimit(kind)[1]
        value = value if hard < 0 else min(value, hard)
        resource.setrlimit(kind, (value, value))
