"""Exit statuses, and the sentence on stderr for each way in which a command can end early.

Only the standard library is imported here, so that the first module of the program can use it.
"""

from __future__ import annotations

import errno
import io
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import chain
from typing import TextIO

from comparisons.console.printable import printable, wrapped
from comparisons.console.readable import take_every_text

#: Exit statuses: 0 done, and all gates pass; 1 a gate fails; 2 wrong input; 3 a gate is inconclusive; 4 a computation
#: or an output failed, a gate is in error, or there was nothing to judge.
OK, FAILS, WRONG_INPUT, INCONCLUSIVE, FAILED = 0, 1, 2, 3, 4

#: 128 and the number of the signal, as shells have it.
_INTERRUPTED, _BROKEN_PIPE, _TERMINATED = 130, 141, 143

#: Module -> the extra of fscm-bench that installs it.
EXTRAS = {"bokeh": "report"}

#: The packages of this project, in which an import that fails is an error of ours.
OWN = ("comparisons", "fem_reference", "fscm", "fscm_bench")

#: The environment variable that shows the traceback of an error.
TRACEBACK = "FSCM_BENCH_TRACEBACK"


class Terminated(KeyboardInterrupt):
    """SIGTERM; what Ctrl-C cleans up is cleaned up then, too."""


def full_disk(error: OSError) -> bool:
    """Whether the device or the user's quota is full, which no other file name of the same folder repairs.

    Examples
    --------
    >>> full_disk(OSError(errno.ENOSPC, "No space left on device"))
    True
    >>> full_disk(PermissionError(errno.EACCES, "Permission denied"))
    False
    """
    return error.errno in {errno.ENOSPC, errno.EDQUOT}


def guarded(command: Callable[[], int], program: str = "fscm-bench") -> int:
    """Call a command and return its exit status; an exception becomes one sentence on stderr.

    Parameters
    ----------
    command : callable
        Returns the exit status.
    program : str
        Starts the sentence.

    Returns
    -------
    int
        What the command returned; 2 after a `ValueError` (wrong input) or if the extra that a command needs is not
        installed, 130 after Ctrl-C, 141 when the reader of a pipe has left, 143 after SIGTERM, and 4 after any other
        exception, as that of a full disk or of a package that is missing though it belongs to the installation.

    Examples
    --------
    >>> guarded(lambda: 3)
    3
    """
    if sys.stderr is None:
        # Closed by the parent process (2>&-): messages need a place, and no file may get descriptor 2.
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  # open to the end
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            take_every_text(stream)
    status = _status(command, program)
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            _flush_or_discard(stream)
    return status


def _status(command: Callable[[], int], program: str) -> int:
    if sys.stdout is None:
        _say(program, "the standard output is closed, so results cannot be written; use > /dev/null to drop them")
        return FAILED
    _obey_sigterm()
    try:
        try:
            status = command()
        except SystemExit as end:  # argparse, after --help and --version
            status = FAILED if end.code else OK
        with writing_stdout():
            sys.stdout.flush()
        return status
    except KeyboardInterrupt as error:
        terminated = isinstance(error, Terminated)
        _say(program, "terminated" if terminated else "interrupted")
        return _TERMINATED if terminated else _INTERRUPTED
    except BrokenPipeError:
        return _BROKEN_PIPE
    except Exception as error:
        status, sentence = _explained(error)
        if os.environ.get(TRACEBACK):
            sentence += "\n" + "".join(traceback.format_exception(error)).rstrip("\n")
        _say(program, sentence)
        return status


@contextmanager
def writing_stdout() -> Iterator[None]:
    """Name the standard output in the error of the system when it cannot be written.

    Raises
    ------
    OSError
        One sentence with the system's reason; a pipe without a reader stays a `BrokenPipeError`.
    """
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        raise OSError(f"the standard output cannot be written ({error.strerror or error})") from error


def _explained(error: Exception) -> tuple[int, str]:
    """Return the exit status of an exception and its sentence."""
    if isinstance(error, ValueError):
        return WRONG_INPUT, str(error)
    if isinstance(error, ModuleNotFoundError) and (extra := EXTRAS.get((error.name or "").partition(".")[0])):
        package = f"the package {error.name} is not installed, which this command needs"
        return WRONG_INPUT, f"{package}: pip install 'fscm-bench[{extra}]'"
    if isinstance(error, ImportError) and (name := (error.name or "").partition(".")[0]) not in ("", *OWN):
        return FAILED, f"the package {name} of the installation is missing or cannot be loaded: pip install {name}"
    if isinstance(error, OSError):
        if error.strerror is None:  # a sentence of ours
            return FAILED, str(error)
        if error.filename is None:
            return FAILED, f"the standard output or a file cannot be written ({error.strerror})"
        return FAILED, f"{os.fsdecode(error.filename)} cannot be read or written ({error.strerror})"
    text = " ".join(str(error).split())
    return FAILED, (
        f"internal error: {type(error).__name__}: {text}; please report it with the command; "
        f"{TRACEBACK}=1 in the environment shows the traceback"
    )


def _obey_sigterm() -> None:
    """Let SIGTERM raise `Terminated`, unless this process ignores it or handles it already."""
    main = threading.current_thread() is threading.main_thread()
    if main and signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        signal.signal(signal.SIGTERM, _terminate)


def _terminate(number: int, frame: object) -> None:
    raise Terminated


def _say(program: str, sentence: str) -> None:
    """Write on stderr as `log` does, without rich; if that fails too, only the exit status is left."""
    with suppress(OSError):
        lines = f"{program}: {printable(sentence)}".split("\n")
        for line in chain.from_iterable(map(wrapped, lines)) if sys.stderr.isatty() else lines:
            print(line, file=sys.stderr, flush=True)


def _flush_or_discard(stream: TextIO) -> None:
    """Write what a stream still holds, or point it at nothing: Python's own flush would change the exit status."""
    try:
        stream.flush()
    except OSError:
        with suppress(io.UnsupportedOperation):  # a stream in memory has no descriptor
            descriptor = stream.fileno()
            nothing = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nothing, descriptor)
            os.close(nothing)
