"""Process of an external model: one JSON line for another with a time limit, and the end of all that it started."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

from comparisons.data.folder_entries import TooMany, entries_below
from comparisons.external import cleaner
from comparisons.external.inherited import hidden_folders, seconds_left
from comparisons.external.start import MEMORY_LIMIT, TIME_LIMIT, limit_of_environment
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed

#: Seconds in which a fresh interpreter must have imported the worker, before any code of a model; 0.5 are usual.
_START = 120.0

#: Longest reply to each request, in bytes: thousands of files, a long reason, a curve of a million points and a few
#: columns.  As objects of Python a reply may have ten times its size.
_LONGEST_REPLY = {"describe": 4_000_000, "evaluate": 100_000, "curve": 100_000_000}
#: Longest line before the first request.
_LONGEST_START = 100

#: Most bytes and most files and folders in the scratch folder, and the seconds after which they are counted again.
_LARGEST_SCRATCH, _MOST_SCRATCH, _COUNTED_AGAIN = 1_000_000_000, 10_000, 1.0

#: A folder that was removed since it was listed.
_GONE = (FileNotFoundError, NotADirectoryError)

#: Seconds that a process may take to end after its pipe has closed; a loaded machine took more than one.
_END_SECONDS = 10.0

#: Seconds in which a program may write a second line for one request.
_AFTER_REPLY = 0.005

#: Bytes of a block, in which the system states what a file takes of a disk.
_BLOCK = 512

#: Bytes of the end of stderr that are read for a message.
_LAST_WORDS = 1000

#: The only variables of our environment that a child gets: enough to find libraries, no token and no path of ours.
_ENVIRONMENT = ("PATH", "LANG", "LC_ALL", "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "VIRTUAL_ENV", "CONDA_PREFIX")
#: Which kernels OpenBLAS takes decides the last digits: those of the child are those of the references here.
_KERNELS = "OPENBLAS_"
_ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")

_PROGRAM = """
import json, sys
sys.dont_write_bytecode = True
order = json.loads(sys.argv[1])
sys.path[:] = order["path"]
from comparisons.external.start import start
start(order)
"""


class Overdue(ComputationFailed):
    """There was no reply in time."""


class Overfull(Overdue):
    """There was none before the scratch folder was too large."""


class TimeIsOver(ComputationFailed):
    """The models of a submission have used their time."""


class Child:
    """A process that loads one model. After a failure of the process it is ended.

    Parameters
    ----------
    source : dict
        How the process finds the model.

    Raises
    ------
    comparisons.model.ComputationFailed
        If the process does not start.
    """

    def __init__(self, source: dict[str, Any]) -> None:
        self._seconds, megabytes = limit_of_environment(TIME_LIMIT), limit_of_environment(MEMORY_LIMIT)
        self._is_program = source["kind"] == "program"
        self._resources = contextlib.ExitStack()
        with self._ended_on_failure():
            self._launch({"source": source, "megabytes": megabytes, "hidden": hidden_folders()})
            try:
                self._line(_START, _LONGEST_START)
            except Overdue:
                raise ComputationFailed(f"its process did not start within {_START:g} s") from None

    def exchange(self, request: dict[str, Any]) -> bytes:
        """Return the line that the process writes for a request.

        Raises
        ------
        Overdue
            If there is none in time, or before the scratch folder is too large.
        TimeIsOver
            If the time of all models of a submission is over.
        comparisons.model.ComputationFailed
            If the process ends or writes anything else.
        """
        with self._ended_on_failure():
            # A process that has ended is noticed where its reply is read.
            with contextlib.suppress(OSError):
                self._requests.write(json.dumps(request, allow_nan=False).encode() + b"\n")
            line = self._line(self._seconds, _LONGEST_REPLY[request["request"]])
            # What a program writes besides is then there before the next request, which notices it.
            if self._is_program:
                self._is_readable(_AFTER_REPLY)
            return line

    def has_ended(self) -> bool:
        """Whether the process was ended, or has ended after its last reply.

        Raises
        ------
        comparisons.model.ComputationFailed
            If it has written something without a request.
        """
        with self._ended_on_failure():
            if self._replies.closed:
                return True
            if not self._is_readable(0.0):
                return False
            if os.read(self._replies.fileno(), 1):
                raise ComputationFailed("its process wrote more than one line for one request")
            return True

    def close(self) -> None:
        """End the process and whatever it started in its process group, and remove its scratch folder."""
        self._resources.close()

    @contextlib.contextmanager
    def _ended_on_failure(self) -> Iterator[None]:
        """Also after Ctrl-C: a late reply would be taken for that to the next request."""
        try:
            yield
        except BaseException:
            self.close()
            raise

    def _launch(self, order: dict[str, Any]) -> None:
        names = [name for name in os.environ if name in _ENVIRONMENT or name.startswith(_KERNELS)]
        environment = {name: os.environ[name] for name in names}
        self._errors = self._resources.enter_context(tempfile.TemporaryFile())  # noqa: SIM115  # the stack closes it
        command = [sys.executable, "-I", "-S", cleaner.__file__, tempfile.gettempdir()]
        _, orders, answers = self._popen(command, "/", environment)
        if not (scratch := answers.readline().decode().rstrip("\n")):
            raise ComputationFailed(f"there is no scratch folder for it{self._last_words()}")
        self._scratch = Path(scratch)
        path = [str(Path(__file__).resolve().parents[2]), *(entry or str(Path.cwd()) for entry in sys.path)]
        command = [sys.executable, "-c", _PROGRAM, json.dumps(order | {"path": path, "scratch": scratch})]
        environment |= _ONE_THREAD | {"HOME": scratch, "TMPDIR": scratch}
        self._process, self._requests, self._replies = self._popen(command, scratch, environment)
        self._resources.callback(_kill, self._process)
        orders.write(b"%d\n" % self._process.pid)

    def _popen(
        self, command: list[str], folder: str, environment: dict[str, str]
    ) -> tuple[subprocess.Popen[bytes], IO[bytes], IO[bytes]]:
        """Return a new process, its standard input and its standard output; its end closes them and waits."""
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": self._errors}
        process = subprocess.Popen(command, bufsize=0, **pipes, cwd=folder, env=environment, start_new_session=True)
        assert process.stdin
        assert process.stdout
        self._resources.enter_context(process)
        return process, process.stdin, process.stdout

    def _is_readable(self, seconds: float) -> bool:
        return bool(select.select([self._replies], [], [], max(seconds, 0.0))[0])

    def _line(self, seconds: float, longest: int) -> bytes:
        """Return the line that the process writes."""
        line, chunk = bytearray(), b""
        end = time.monotonic() + seconds
        while b"\n" not in chunk:
            self._await(end, seconds)
            chunk = os.read(self._replies.fileno(), 1 << 16)
            line += chunk
            if not chunk:
                raise ComputationFailed(f"its process {self._end_of_process()} instead of a reply{self._last_words()}")
            if len(line) > longest:
                raise ComputationFailed(f"its process wrote {longest} bytes without the end of a line")
        if b"\n" in line.strip():
            raise ComputationFailed("its process wrote more than one line for one request")
        self._check_scratch()
        return bytes(line)

    def _await(self, end: float, seconds: float) -> None:
        """Wait until there is something to read, while there is time and the scratch folder is small."""
        while not self._is_readable(min(end - time.monotonic(), seconds_left(), _COUNTED_AGAIN)):
            self._check_scratch()
            if seconds_left() <= 0.0:
                raise TimeIsOver("the time that a submission has for all its evaluations is over")
            if time.monotonic() >= end:
                flush = "; a program must flush its standard output after every line" if self._is_program else ""
                raise Overdue(f"it gave no result within {seconds:g} s and was ended ({TIME_LIMIT}){flush}")

    def _check_scratch(self) -> None:
        """Refuse a scratch folder that is too large; a file that has no name any more is not counted."""
        size = 0
        try:
            for entry in entries_below(self._scratch, _MOST_SCRATCH, skipped=_GONE):
                with contextlib.suppress(OSError):
                    size += entry.stat(follow_symlinks=False).st_blocks * _BLOCK
        except TooMany:
            raise Overfull(f"it has more than {_MOST_SCRATCH} files in its scratch folder") from None
        except OSError as error:
            # What is below cannot be counted: the path is too long, or there is no right to read.
            raise Overfull(f"it has a folder in its scratch folder that cannot be read ({error.strerror})") from None
        if size > _LARGEST_SCRATCH:
            raise Overfull(f"its files in the scratch folder have {size} bytes, more than {_LARGEST_SCRATCH}")

    def _end_of_process(self) -> str:
        # The pipe may close a moment before the process is gone.
        try:
            code = self._process.wait(_END_SECONDS)
        except subprocess.TimeoutExpired:
            return "closed its standard output"
        if code < 0:
            return f"was killed by signal {-code} ({signal.strsignal(-code)})"
        return f"ended with exit status {code}"

    def _last_words(self) -> str:
        """Return the last line of standard error, for a sentence."""
        size = os.fstat(self._errors.fileno()).st_size
        text = os.pread(self._errors.fileno(), _LAST_WORDS, max(size - _LAST_WORDS, 0)).decode(errors="replace")
        lines = [line for line in text.splitlines() if line.strip()]
        return f"; the last line of its stderr: {one_line(lines[-1], 200)}" if lines else ""


def _kill(process: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
