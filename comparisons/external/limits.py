"""Limits of an external model: time, memory and size of files.

The limits are environment variables, so that they reach every process of a run:

    FSCM_BENCH_TIME_LIMIT     seconds for one evaluation, and for loading (60)
    FSCM_BENCH_MEMORY_LIMIT   MB of address space (4096)
"""

from __future__ import annotations

import os
from dataclasses import dataclass

__all__ = ["LARGEST_COUNT", "TIME_LIMIT", "Limits", "cpu_seconds_from_now", "limit_resources"]

#: Names of the environment variables.
TIME_LIMIT, _MEMORY = "FSCM_BENCH_TIME_LIMIT", "FSCM_BENCH_MEMORY_LIMIT"
_DEFAULT_SECONDS, _DEFAULT_MEGABYTES = 60.0, 4096.0

#: Bytes of one file in the scratch folder.
_LARGEST_FILE = 256_000_000

#: Counts (of unknowns, of iterations) are below it: tables store them with 64 bits and a sign.
LARGEST_COUNT = 2**63

#: The parent ends an evaluation by the clock; the limit of processor time is for a child whose parent was
#: killed.
_GRACE = 10.0


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one child process.

    Attributes
    ----------
    seconds : float
        Wall-clock time of one evaluation.
    megabytes : float
        Address space, 1e6 bytes.

    Raises
    ------
    ValueError
        If one is not a positive number.
    """

    seconds: float = _DEFAULT_SECONDS
    megabytes: float = _DEFAULT_MEGABYTES

    def __post_init__(self) -> None:
        for name, value in ((TIME_LIMIT, self.seconds), (_MEMORY, self.megabytes)):
            if not 0 < value < 1e9:
                raise ValueError(f"{name} = {value:g} is outside (0, 1e9): a limit is positive and finite")

    @classmethod
    def of_environment(cls) -> Limits:
        """Return the limits that the environment variables set."""
        return cls(_number(TIME_LIMIT, _DEFAULT_SECONDS), _number(_MEMORY, _DEFAULT_MEGABYTES))


def _number(name: str, default: float) -> float:
    text = os.environ.get(name, "")
    try:
        return float(text) if text else default
    except ValueError:
        raise ValueError(f"{name} = {text!r} is not a number") from None


def limit_resources(limits: Limits) -> None:
    """Bind this process, for good (a superuser could raise them again)."""
    import resource  # Not on Windows, where models that are code are refused before this.

    wanted = {
        resource.RLIMIT_AS: int(1e6 * limits.megabytes),
        resource.RLIMIT_FSIZE: _LARGEST_FILE,
        resource.RLIMIT_CORE: 0,
    }
    for kind, value in wanted.items():
        _, hard = resource.getrlimit(kind)
        value = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(kind, (value, value))


def cpu_seconds_from_now(limits: Limits) -> None:
    """Set the limit of processor time of this process far above the time of one evaluation from now on."""
    import resource

    used = resource.getrusage(resource.RUSAGE_SELF)
    allowed = used.ru_utime + used.ru_stime + (limits.seconds + _GRACE) * (os.cpu_count() or 1)
    _, hard = resource.getrlimit(resource.RLIMIT_CPU)
    soft = int(allowed) + 1
    soft = soft if hard == resource.RLIM_INFINITY else min(soft, hard)
    resource.setrlimit(resource.RLIMIT_CPU, (soft, hard))
