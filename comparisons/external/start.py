"""Start of the process of an external model: no writing elsewhere, the limits, and then the worker or the program.

Nothing but the standard library is imported before the restriction of writing.
"""

from __future__ import annotations

import os
import signal
import sys
from typing import Any

from comparisons.external.landlock import write_only_in
from comparisons.external.limits import limit_memory_and_files

__all__ = ["start"]

#: What the process writes before it reads its first request.
_READY = b"ready\n"


def start(order: dict[str, Any]) -> None:
    """Run a model in this process until there are no more requests.

    Parameters
    ----------
    order : dict
        ``source`` of the model, ``scratch`` folder and ``megabytes``.
    """
    source, megabytes = order["source"], order["megabytes"]
    # Landlock binds the calling thread and those this thread starts later: it comes before NumPy's libraries.
    write_only_in(order["scratch"])
    if source["kind"] == "program":
        limit_memory_and_files(megabytes)
        os.write(1, _READY)
        _become(source["file"])
    from comparisons.external.worker import serve

    limit_memory_and_files(megabytes)
    os.write(1, _READY)
    serve(source, megabytes)


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
