"""Program beside the process of a model: it ends that process and removes its scratch folder when the parent ends.

``python -I -S cleaner.py FOLDER`` makes a scratch folder in FOLDER and writes its path. It reads the id of the model's
process, and waits for the end of its standard input, which the system closes however the parent ends. It is a process
of its own, so that no code of a model can change what it does.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import signal
import stat
import sys
import tempfile
import time
from collections.abc import Iterator

#: How the name of every scratch folder begins.
PREFIX = "fscm-bench-"

#: A process that was killed may still finish a write: so often, and so long (s), a removal is repeated.
_TRIES, _PAUSE = 100, 0.05


def main() -> None:
    """Make a scratch folder, wait for the end of the parent, and clean up."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        # They are meant for the parent; this process ends after it.
        signal.signal(number, signal.SIG_IGN)
    scratch = tempfile.mkdtemp(prefix=PREFIX, dir=sys.argv[1])
    print(scratch, flush=True)
    process, *_ = sys.stdin.read().splitlines() or [""]
    if process:
        with contextlib.suppress(OSError):
            os.killpg(int(process), signal.SIGKILL)
    for _ in range(_TRIES):
        # A link in its place is not followed, and stays.
        if os.path.islink(scratch) or not os.path.exists(scratch):
            break
        with contextlib.suppress(OSError):
            _remove(scratch)
        time.sleep(_PAUSE)


def _remove(folder: str) -> None:
    """Remove a folder, as deep as it may be: folders in its folders move up to it before they are removed."""
    os.chmod(folder, stat.S_IRWXU)
    top, numbers = _opened(folder), itertools.count()
    try:
        pending = os.listdir(top)
        while pending:
            name = pending.pop()
            # What cannot be removed does not keep the rest.
            with contextlib.suppress(OSError):
                if _is_folder(name, top):
                    pending.extend(_moved_up(name, top, numbers))
                    os.rmdir(name, dir_fd=top)
                else:
                    os.unlink(name, dir_fd=top)
    finally:
        os.close(top)
    os.rmdir(folder)


def _moved_up(name: str, top: int, numbers: Iterator[int]) -> list[str]:
    """Move the folders in a folder up to the one that it is in; return their new names, and remove its files."""
    # The right to read or to write in it may have been taken away.
    os.chmod(name, stat.S_IRWXU, dir_fd=top)
    folder, moved = _opened(name, top), []
    try:
        for entry in os.listdir(folder):
            with contextlib.suppress(OSError):
                if _is_folder(entry, folder):
                    os.chmod(entry, stat.S_IRWXU, dir_fd=folder)
                    new = f"{os.getpid()}-{next(numbers)}"
                    os.rename(entry, new, src_dir_fd=folder, dst_dir_fd=top)
                    moved.append(new)
                else:
                    os.unlink(entry, dir_fd=folder)
    finally:
        os.close(folder)
    return moved


def _opened(folder: str, above: int | None = None) -> int:
    """Open a folder; a link in its place is not followed."""
    return os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=above)


def _is_folder(name: str, above: int) -> bool:
    return stat.S_ISDIR(os.lstat(name, dir_fd=above).st_mode)


if __name__ == "__main__":
    main()
