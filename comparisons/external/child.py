"""The parent's side of a child process: start it, ask it with a clock running, end it and all it started."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import IO, Any

from comparisons.external import scratch
from comparisons.external.identity import contradiction, said
from comparisons.external.limits import Limits
from comparisons.external.scratch import Scratch, make_scratch, remove_scratch

__all__ = ["Child"]


#: Questions in a row that may run out of time before the model is not asked any more: a run of hundreds
#: must end.
PATIENCE = 3

#: Seconds in which a fresh interpreter must have imported the worker, before any foreign code; 0.5 are usual.
_START = 120.0

#: Longest answer, in bytes: a curve of a million points and a few columns.
_LONGEST_ANSWER = 200_000_000

#: What a child learns of our environment: enough to find libraries, no token and no path of ours.
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

#: Landlock binds the thread that asks for it and those this thread starts later: it comes before NumPy's libraries,
#: our own thread and the model.
_PROGRAM = """
import sys
sys.dont_write_bytecode = True
sys.path[:] = sys.argv[3:]
from comparisons.external.landlock import write_only_in
write_only_in(sys.argv[2])
from comparisons.external.worker import main
main(int(sys.argv[1]))
"""


class Child:
    """A process that has loaded one model; started when first asked, and again after it had to be ended.

    Parameters
    ----------
    door : dict
        How the worker finds the model.
    limits : Limits
    """

    def __init__(self, door: dict[str, Any], limits: Limits) -> None:
        self._door = door
        self._limits = limits
        self._process: subprocess.Popen[bytes] | None = None
        self._scratch: Scratch | None = None
        self._cleaner: subprocess.Popen[bytes] | None = None
        self._answers = -1
        self._first: dict[str, Any] = {}
        self._contradiction = ""
        self._overdue = 0

    def ask(self, **request: Any) -> dict[str, Any]:
        """Return ``status`` and, for a failure, a ``reason``; nothing a model does raises an exception."""
        if self._overdue >= PATIENCE:
            return _failed(f"not asked: it ran out of time {PATIENCE} times in a row")
        if self._contradiction:
            return _failed(self._contradiction)
        if self._process is None:
            opened = self._start()
            if opened["status"] != "ok" or request["ask"] == "open":
                return opened
        overdue = self._overdue
        answer = self._exchange(request)
        # Only an answer to a question shows that it can be in time; loading again does not.
        self._overdue = self._overdue if self._overdue > overdue else 0
        return answer

    def close(self) -> None:
        """End the process and whatever it started in its process group, and remove its scratch folder."""
        if self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
            _close(self._process.stdin)
            os.close(self._answers)
        if self._scratch is not None:
            remove_scratch(self._scratch)
        if self._cleaner is not None:
            self._cleaner.kill()
            self._cleaner.wait()
            _close(self._cleaner.stdin)
        self._process = self._scratch = self._cleaner = None

    def _start(self) -> dict[str, Any]:
        here = str(Path(__file__).resolve().parent.parent.parent)
        path = [here, *(entry or str(Path.cwd()) for entry in sys.path)]
        self._start_processes(path)
        ready = self._exchange({"ask": "ready", "limits": asdict(self._limits), "path": path}, _START)
        door = self._door | {"skip": _output_files()}
        opened = self._exchange({"ask": "open", "door": door}) if ready["status"] == "ok" else ready
        if opened["status"] != "ok":
            self.close()
            return opened
        return self._compared(opened)

    def _compared(self, opened: dict[str, Any]) -> dict[str, Any]:
        """Return what a new process says, or a failure if the first said another name, version or state of files."""
        self._first = self._first or opened
        for what in ("name", "version", "digest"):
            if opened.get(what) != self._first.get(what):
                self.close()
                self._contradiction = contradiction(said(self._first), said(opened))
                return _failed(self._contradiction)
        return opened

    def _start_processes(self, path: list[str]) -> None:
        """Start the process that removes the scratch folder, then the child; or raise OSError and leave nothing."""
        environment = {name: os.environ[name] for name in _ENVIRONMENT if name in os.environ}
        answers, theirs = os.pipe()
        try:
            folder = self._scratch = make_scratch()
            self._cleaner = subprocess.Popen(
                [sys.executable, "-I", "-S", scratch.__file__, folder.path, str(folder.device), str(folder.inode)],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                cwd="/",
                env=environment,
                start_new_session=True,
            )
            self._process = subprocess.Popen(
                [sys.executable, "-c", _PROGRAM, str(theirs), folder.path, *path],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                pass_fds=[theirs],
                cwd=folder.path,
                env=environment | _ONE_THREAD | {"HOME": folder.path, "TMPDIR": folder.path},
                start_new_session=True,
            )
            self._answers = answers
        except BaseException:
            os.close(answers)
            self.close()
            raise
        finally:
            os.close(theirs)
        with contextlib.suppress(OSError):
            _tell(self._cleaner, f"{self._process.pid}\n".encode())

    def _exchange(self, request: dict[str, Any], seconds: float | None = None) -> dict[str, Any]:
        seconds = seconds or self._limits.seconds
        process = self._process
        if process is None:
            return _failed("its process has ended")
        started = time.monotonic()
        try:
            _tell(process, json.dumps(request, allow_nan=False).encode() + b"\n")
        except OSError:
            return self._ended()
        line = self._line(started + seconds)
        if line is None:
            self.close()
            self._overdue += 1
            return _failed(f"it had no answer after {seconds:g} s and was ended")
        if not line:
            return self._ended()
        try:
            answer = json.loads(line)
            if answer["status"] in {"ok", "not-applicable", "failed"}:
                return dict(answer)
        except (ValueError, KeyError, TypeError, RecursionError):
            pass
        self.close()
        return _failed("its process wrote something that is not an answer")

    def _line(self, deadline: float) -> bytes | None:
        """Return a line, b"" when there will be none, None when time is up."""
        parts: list[bytes] = []
        length = 0
        while (left := deadline - time.monotonic()) > 0:
            if not select.select([self._answers], [], [], left)[0]:
                break
            part = os.read(self._answers, 1 << 16)
            parts.append(part)
            length += len(part)
            if part.endswith(b"\n"):
                return b"".join(parts)
            if not part:
                return b""
            if length > _LONGEST_ANSWER:
                return b"too long"
        return None

    def _ended(self) -> dict[str, Any]:
        process = self._process
        # The pipe may close a moment before the process is gone; one that closed it by itself is ended.
        code = None
        if process is not None:
            with contextlib.suppress(subprocess.TimeoutExpired):
                code = process.wait(1.0)
        self.close()
        if code is None:
            return _failed("its process closed the pipe for its answers")
        if code < 0:
            return _failed(f"its process was killed by {_signal_name(-code)}")
        return _failed(f"it ended its process with exit status {code}, as os._exit does")


def _output_files() -> list[tuple[int, int]]:
    """Return device and inode of the files that take our output: they grow, and are no files of a model."""
    found = []
    for descriptor in (1, 2):
        with contextlib.suppress(OSError):
            status = os.fstat(descriptor)
            found.append((status.st_dev, status.st_ino))
    return found


def _tell(process: subprocess.Popen[bytes], line: bytes) -> None:
    if process.stdin is not None:
        process.stdin.write(line)
        process.stdin.flush()


def _close(pipe: IO[bytes] | None) -> None:
    if pipe is not None:
        with contextlib.suppress(OSError):
            pipe.close()


def _signal_name(number: int) -> str:
    """Return e.g. SIGKILL; most real-time signals have a number only."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def _failed(reason: str) -> dict[str, Any]:
    return {"status": "failed", "reason": reason, "seconds": 0.0}
