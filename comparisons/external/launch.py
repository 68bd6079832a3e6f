"""Start and end of a child process, with its scratch folder and the process that removes the folder."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from comparisons.external import scratch
from comparisons.external.scratch import Scratch, make_scratch, remove_scratch

__all__ = ["PROGRAM", "Launched", "end", "import_path", "launch", "write_line"]

#: The only variables of our environment that a child gets: enough to find libraries, no token and no path of ours.
_ENVIRONMENT = (
    "PATH",
    "LANG",
    "LC_ALL",
    "LD_LIBRARY_PATH",
    "DYLD_LIBRARY_PATH",
    "VIRTUAL_ENV",
    "CONDA_PREFIX",
)
_ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")

#: Landlock binds the calling thread and those this thread starts later: it comes before NumPy's libraries,
#: our own thread and the model.
PROGRAM = """
import sys
sys.dont_write_bytecode = True
sys.path[:] = sys.argv[3:]
from comparisons.external.landlock import write_only_in
write_only_in(sys.argv[2])
from comparisons.external.worker import main
main(int(sys.argv[1]))
"""


@dataclass(frozen=True, slots=True)
class Launched:
    """A child process and what belongs to it.

    Attributes
    ----------
    process : subprocess.Popen
        The child; requests go to its standard input.
    replies : int
        Descriptor from which its replies are read.
    scratch : Scratch
        Its working folder.
    cleaner : subprocess.Popen
        The process that removes the folder if this one is killed.
    """

    process: subprocess.Popen[bytes]
    replies: int
    scratch: Scratch
    cleaner: subprocess.Popen[bytes]


def import_path() -> list[str]:
    """Return the folders from which a child imports: that of this program first, then ours."""
    here = str(Path(__file__).resolve().parent.parent.parent)
    return [here, *(entry or str(Path.cwd()) for entry in sys.path)]


def launch(path: list[str]) -> Launched:
    """Start the process that removes the scratch folder, then the child; or raise OSError and leave nothing.

    Parameters
    ----------
    path : list of str
        Folders from which the child imports.
    """
    environment = {name: os.environ[name] for name in _ENVIRONMENT if name in os.environ}
    replies, child_end = os.pipe()
    with contextlib.ExitStack() as undo:
        undo.callback(os.close, replies)
        try:
            folder = make_scratch()
            undo.callback(remove_scratch, folder)
            cleaner = subprocess.Popen(
                [sys.executable, "-I", "-S", scratch.__file__, folder.path, str(folder.device), str(folder.inode)],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                cwd="/",
                env=environment,
                start_new_session=True,
            )
            undo.callback(_kill, cleaner)
            process = subprocess.Popen(
                [sys.executable, "-c", PROGRAM, str(child_end), folder.path, *path],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                pass_fds=[child_end],
                cwd=folder.path,
                env=environment | _ONE_THREAD | {"HOME": folder.path, "TMPDIR": folder.path},
                start_new_session=True,
            )
        finally:
            os.close(child_end)
        undo.pop_all()
    with contextlib.suppress(OSError):
        write_line(cleaner, str(process.pid).encode())
    return Launched(process, replies, folder, cleaner)


def end(launched: Launched) -> None:
    """End the child and whatever it started in its process group, and remove its scratch folder."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(launched.process.pid, signal.SIGKILL)
    launched.process.wait()
    _close(launched.process.stdin)
    os.close(launched.replies)
    remove_scratch(launched.scratch)
    _kill(launched.cleaner)


def write_line(process: subprocess.Popen[bytes], line: bytes) -> None:
    """Write a line to the standard input of a process.

    Raises
    ------
    OSError
        If the process has ended.
    """
    if process.stdin is not None:
        process.stdin.write(line + b"\n")
        process.stdin.flush()


def _kill(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()
    _close(process.stdin)


def _close(pipe: IO[bytes] | None) -> None:
    if pipe is not None:
        with contextlib.suppress(OSError):
            pipe.close()
