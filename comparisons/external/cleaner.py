"""Process that removes the scratch folder of a model's process, and ends that process when the parent has ended.

This file is a program (``python -I -S cleaner.py PATH``).  It runs beside the process of the model, not in it: no
code of a model can change what it does.  The parent writes the process id of the model to its standard input and
another line when it has ended the model itself; it closes the input when it ends, however it ends.  The program uses
the standard library alone and starts in some 20 ms.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import stat
import sys
import time

__all__ = ["PREFIX", "remove"]

#: How the name of every scratch folder begins.
PREFIX = "fscm-bench-"

#: A process that was killed may still finish what it is doing: so often, and so long (s), a removal is repeated.
_TRIES, _PAUSE = 100, 0.05


def remove(path: str) -> bool:
    """Remove a folder and return whether it is gone; a link in its place stays, with its target."""
    if os.path.islink(path):
        return True
    # A model may have taken the right to enter from its folders.
    _allow(path)
    for folder, inner, _ in os.walk(path):
        for name in inner:
            _allow(os.path.join(folder, name))
    shutil.rmtree(path, ignore_errors=True)
    return not os.path.exists(path)


def _allow(folder: str) -> None:
    if not os.path.islink(folder):
        with contextlib.suppress(OSError):
            os.chmod(folder, stat.S_IRWXU)


def _wait_and_remove(path: str) -> None:
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        # They are meant for the parent; this process ends after it.
        signal.signal(number, signal.SIG_IGN)
    process = sys.stdin.buffer.readline()
    if process.endswith(b"\n") and not sys.stdin.buffer.readline():
        with contextlib.suppress(OSError):
            os.killpg(int(process), signal.SIGKILL)
    for _ in range(_TRIES):
        if remove(path):
            return
        time.sleep(_PAUSE)


if __name__ == "__main__":
    _wait_and_remove(sys.argv[1])
