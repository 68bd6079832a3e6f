"""Process of an external model: JSON lines with a time limit, and the end of all that it started."""

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
from pathlib import Path
from typing import Any

from comparisons.external import cleaner
from comparisons.external.identity import contradiction
from comparisons.external.limits import MEMORY_LIMIT, TIME_LIMIT, limit_of_environment
from comparisons.external.replies import Description, described, parsed
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed

__all__ = ["PATIENCE", "Child"]

#: Requests in a row that may run out of time; later ones are not sent, because a run of hundreds must end.
PATIENCE = 3

#: Seconds in which a fresh interpreter must have imported the worker, before any code of a model; 0.5 are usual.
_START = 120.0

#: Longest reply, in bytes: a curve of a million points and a few columns.
_LONGEST_REPLY = 200_000_000

#: Seconds that a process may take to end after its pipe has closed; a loaded machine took more than one.
_END_SECONDS = 10.0

#: Seconds in which a second line of a program is noticed at once; a later one costs the next request.
_AFTER_REPLY = 0.005

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


class Child:
    """A process that has loaded one model; started again after it had to be ended.

    Parameters
    ----------
    source : dict
        How the process finds the model.

    Attributes
    ----------
    description : Description
        What the first process stated of the model.

    Raises
    ------
    comparisons.model.ComputationFailed
        If the model cannot be loaded.
    """

    def __init__(self, source: dict[str, Any]) -> None:
        self._source = source | {"skip": _output_files()}
        self._seconds, self._megabytes = limit_of_environment(TIME_LIMIT), limit_of_environment(MEMORY_LIMIT)
        self._process: subprocess.Popen[bytes] | None = None
        self._open = contextlib.ExitStack()
        self._refusal = ""
        self._overdue = 0
        self.description = self._start()

    def request(self, request: dict[str, Any]) -> dict[str, Any]:
        """Return the reply to a request.

        Raises
        ------
        comparisons.model.ComputationFailed
            If there is none; the sentence has the reason.
        """
        if self._refusal:
            raise ComputationFailed(self._refusal)
        if self._has_ended(0.0):
            self.close()
        if self._process is None:
            again, first = self._start(), self.description
            if (again.name, again.version) != (first.name, first.version):
                self.close()
                self._refusal = contradiction((first.name, first.version), (again.name, again.version))
                raise ComputationFailed(self._refusal)
        reply = self._exchange(request, {})
        # Only the reply to a case shows that the model can be in time; loading it again does not.
        self._overdue = 0
        if self._source["kind"] == "program" and self._has_ended(_AFTER_REPLY):
            self.close()
        return reply

    def close(self) -> None:
        """End the process and whatever it started in its process group, and remove its scratch folder."""
        self._process = None
        self._open.close()

    def _start(self) -> Description:
        try:
            self._process = self._launch()
            self._line(_START)
            return described(self._exchange({"request": "describe"}, {"status": "ok"}), self._source)
        except BaseException:
            self.close()
            raise

    def _launch(self) -> subprocess.Popen[bytes]:
        environment = {
            name: value for name, value in os.environ.items() if name in _ENVIRONMENT or name.startswith(_KERNELS)
        }
        scratch = os.path.abspath(tempfile.mkdtemp(prefix=cleaner.PREFIX))
        self._open.callback(cleaner.remove, scratch)
        remover = self._popen([sys.executable, "-I", "-S", cleaner.__file__, scratch], "/", environment)
        order = {
            "path": [str(Path(__file__).resolve().parents[2]), *(entry or str(Path.cwd()) for entry in sys.path)],
            "source": self._source,
            "scratch": scratch,
            "megabytes": self._megabytes,
            "seconds": self._seconds,
        }
        environment |= _ONE_THREAD | {"HOME": scratch, "TMPDIR": scratch}
        process = self._popen([sys.executable, "-c", _PROGRAM, json.dumps(order)], scratch, environment)
        _write(remover, str(process.pid))
        return process

    def _popen(self, command: list[str], folder: str, environment: dict[str, str]) -> subprocess.Popen[bytes]:
        self._errors = self._open.enter_context(tempfile.TemporaryFile())  # noqa: SIM115
        process = subprocess.Popen(
            command,
            bufsize=0,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            cwd=folder,
            env=environment,
            start_new_session=True,
        )
        self._open.callback(_end, process)
        return process

    def _has_ended(self, seconds: float) -> bool:
        """Whether the process has ended; a failure if it wrote something without a request."""
        output = self._output()
        if output < 0 or not select.select([output], [], [], seconds)[0]:
            return False
        if os.read(output, 1):
            self.close()
            raise ComputationFailed("its process wrote more than one line for one request")
        return True

    def _output(self) -> int:
        return self._process.stdout.fileno() if self._process and self._process.stdout else -1

    def _exchange(self, request: dict[str, Any], default: dict[str, Any]) -> dict[str, Any]:
        try:
            _write(self._process, json.dumps(request, allow_nan=False))
            return parsed(self._line(self._seconds), default)
        except BaseException:
            # Also after Ctrl-C: a late reply would be taken for that to the next request.
            self.close()
            raise

    def _line(self, seconds: float) -> bytes:
        """Return the line that the process writes."""
        line, part = bytearray(), b""
        end = time.monotonic() + seconds
        while b"\n" not in part:
            if not select.select([self._output()], [], [], max(end - time.monotonic(), 0.0))[0]:
                raise ComputationFailed(self._too_slow(seconds))
            part = os.read(self._output(), 1 << 16)
            line += part
            if not part:
                raise ComputationFailed(f"its process {self._end_of_process()} instead of a reply{self._last_words()}")
            if len(line) > _LONGEST_REPLY:
                raise ComputationFailed(f"its process wrote {_LONGEST_REPLY // 10**6} MB without the end of a line")
        if b"\n" in line.strip():
            raise ComputationFailed("its process wrote more than one line for one request")
        return bytes(line)

    def _too_slow(self, seconds: float) -> str:
        if seconds != self._seconds:
            return f"its process did not start within {seconds:g} s"
        self._overdue += 1
        if self._overdue >= PATIENCE:
            self._refusal = f"not evaluated: it ran out of time {PATIENCE} times in a row"
        program = self._source["kind"] == "program"
        flush = "; a program must flush its standard output after every line" if program else ""
        return f"it gave no result within {seconds:g} s ({TIME_LIMIT}) and was ended{flush}"

    def _end_of_process(self) -> str:
        # The pipe may close a moment before the process is gone.
        try:
            code = self._process.wait(_END_SECONDS) if self._process else 0
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


def _write(process: subprocess.Popen[bytes] | None, line: str) -> None:
    """Write a line to the standard input of a process; one that has ended is noticed where it is read."""
    if process and process.stdin:
        with contextlib.suppress(OSError):
            process.stdin.write(line.encode() + b"\n")


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process and its group."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    with process:
        pass


def _output_files() -> list[tuple[int, int]]:
    """Return device and inode of the files that take our output: they grow, and are no files of a model."""
    found = []
    for descriptor in (1, 2):
        with contextlib.suppress(OSError):
            status = os.fstat(descriptor)
            found.append((status.st_dev, status.st_ino))
    return found
