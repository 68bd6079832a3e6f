"""Program beside the process of a model: it ends that process and removes its scratch folder when the parent ends.

``python -I -S cleaner.py FOLDER`` makes a scratch folder in FOLDER and writes its path. It reads the id of the model's
process, and waits for the end of its standard input, which the system closes however the parent ends. It is a process
of its own, so that no code of a model can change what it does.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import tempfile
import time

#: How the name of every scratch folder begins.
PREFIX = "fscm-bench-"

#: A process that was killed may still finish a write: so often, and so long (s), a removal is repeated.
_TRIES, _PAUSE = 100, 0.05


def main() -> None:
    """Make a scratch folder, wait for the end of the parent, and clean up."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        # They are meant for the parent; this process ends after it.
        signal.signal(number, signal.SIG_IGN)
    scratch = tempfile.TemporaryDirectory(prefix=PREFIX, dir=sys.argv[1], ignore_cleanup_errors=True)
    print(scratch.name, flush=True)
    process, *_ = sys.stdin.read().splitlines() or [""]
    if process:
        with contextlib.suppress(OSError):
            os.killpg(int(process), signal.SIGKILL)
    for _ in range(_TRIES):
        # A link in its place is not followed, and stays.
        if os.path.islink(scratch.name) or not os.path.exists(scratch.name):
            break
        scratch.cleanup()
        time.sleep(_PAUSE)


if __name__ == "__main__":
    main()
