"""Start of the process of an external model: its confinement, the limits, and then the worker or the program.

Nothing but the standard library is imported before the restriction.  The limits are environment variables,
so that they reach every process of a run:

    FSCM_BENCH_TIME_LIMIT     seconds for one evaluation, and for loading (60)
    FSCM_BENCH_MEMORY_LIMIT   MB of address space (4096)
"""

from __future__ import annotations

import os
import signal
import sys
from typing import Any

from comparisons.data.plain_numbers import plain_float
from comparisons.external.landlock import confine

#: Names of the environment variables.
TIME_LIMIT, MEMORY_LIMIT = "FSCM_BENCH_TIME_LIMIT", "FSCM_BENCH_MEMORY_LIMIT"
_DEFAULTS = {TIME_LIMIT: "60", MEMORY_LIMIT: "4096"}

#: Bytes of one file in the scratch folder.
_LARGEST_FILE = 256_000_000

#: What the process writes before it reads its first request.
_READY = b"ready\n"


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
        value = plain_float(text)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
    if not 0 < value < 1e9:
        raise ValueError(f"{name} = {value:g} is outside (0, 1e9): a limit is positive and finite")
    return value


def start(order: dict[str, Any]) -> None:
    """Run a model in this process until there are no more requests.

    Parameters
    ----------
    order : dict
        ``source`` of the model, ``scratch`` folder, ``hidden`` folders and ``megabytes``.
    """
    source, megabytes = order["source"], order["megabytes"]
    # Landlock binds the calling thread and those this thread starts later: it comes before NumPy's libraries.
    confine(order["scratch"], order["hidden"])
    if source["kind"] != "program":
        from comparisons.external.worker import serve
    _limit(megabytes)
    os.write(1, _READY)
    if source["kind"] == "program":
        _become(source["file"])
    serve(source, megabytes)


def _limit(megabytes: float) -> None:
    """Limit memory and files of this process and its children, for good (a superuser could raise the limits again)."""
    import resource  # Not on Windows, where models that are code are refused before this.

    limits = {"RLIMIT_AS": int(1e6 * megabytes), "RLIMIT_FSIZE": _LARGEST_FILE, "RLIMIT_CORE": 0}
    for name, limit in limits.items():
        kind = getattr(resource, name)
        hard = resource.getrlimit(kind)[1]
        value = limit if hard < 0 else min(limit, hard)
        resource.setrlimit(kind, (value, value))


def _become(program: str) -> None:
    # Python ignores these two, and the program would inherit that.
    for number in (signal.SIGPIPE, signal.SIGXFSZ):
        signal.signal(number, signal.SIG_DFL)
    try:
        os.execv(program, [program])
    except OSError as error:
        sys.exit(
            f"the program cannot be started ({error.strerror}): it must be an executable of this machine, or a "
            "script whose first line is #! and its interpreter"
        )
