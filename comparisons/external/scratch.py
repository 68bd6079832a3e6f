"""Scratch folder of a child process, and the process that removes it when the parent has ended.

This file is also a program (``python -I -S scratch.py PATH DEVICE INODE``).  It runs beside the child, not in
it: no code of a model can change what it does.  The parent writes the child's process id to its standard
input and closes that when it ends, however it ends.  The program then ends the child's process group and
removes the folder.  It uses the standard library alone and starts in some 20 ms.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import stat
import sys
import tempfile
import time
from dataclasses import dataclass

__all__ = ["PREFIX", "Scratch", "make_scratch", "remove_scratch"]

#: How the name of every scratch folder begins.
PREFIX = "fscm-bench-"

#: A process that was killed may still finish what it is doing: so often, and so long (s), a removal is repeated.
_TRIES, _PAUSE = 100, 0.05


@dataclass(frozen=True, slots=True)
class Scratch:
    """A folder that was made for one child.

    Attributes
    ----------
    path : str
        Absolute.
    device, inode : int
        They tell the folder that was made from another one of its name.
    """

    path: str
    device: int
    inode: int


def make_scratch() -> Scratch:
    """Make a folder in the system's folder for temporary files.

    Examples
    --------
    >>> scratch = make_scratch()
    >>> os.path.isdir(scratch.path), remove_scratch(scratch), os.path.isdir(scratch.path)
    (True, True, False)
    """
    path = os.path.abspath(tempfile.mkdtemp(prefix=PREFIX))
    made = os.lstat(path)
    return Scratch(path, made.st_dev, made.st_ino)


def remove_scratch(scratch: Scratch) -> bool:
    """Remove the folder that was made, and nothing else: no other folder of its path, no target of a link.

    Returns
    -------
    bool
        Whether it is gone.
    """
    if not _is_the_one(scratch):
        return not os.path.lexists(scratch.path)
    with contextlib.suppress(OSError):
        os.chmod(scratch.path, stat.S_IRWXU)
    # A model may have taken the right to enter from a folder of its own.
    for folder, inner, _ in os.walk(scratch.path):
        for name in inner:
            path = os.path.join(folder, name)
            if not os.path.islink(path):
                with contextlib.suppress(OSError):
                    os.chmod(path, stat.S_IRWXU)
    shutil.rmtree(scratch.path, ignore_errors=True)
    return not os.path.lexists(scratch.path)


def _is_the_one(scratch: Scratch) -> bool:
    try:
        found = os.lstat(scratch.path)
    except OSError:
        return False
    return (
        os.path.basename(scratch.path).startswith(PREFIX)
        and stat.S_ISDIR(found.st_mode)
        and (found.st_dev, found.st_ino) == (scratch.device, scratch.inode)
    )


def _wait_and_remove(scratch: Scratch) -> None:
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        # They are meant for the parent; this process ends after it.
        signal.signal(number, signal.SIG_IGN)
    line = sys.stdin.buffer.readline()
    sys.stdin.buffer.read()
    if line.endswith(b"\n"):
        with contextlib.suppress(OSError):
            os.killpg(int(line), signal.SIGKILL)
    for _ in range(_TRIES):
        if remove_scratch(scratch):
            return
        time.sleep(_PAUSE)


if __name__ == "__main__":
    _wait_and_remove(Scratch(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
