"""Child process of an external model: requests with a time limit, and the end of all that it started."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import time
from dataclasses import asdict
from typing import Any

from comparisons.external.identity import contradiction, identity_of
from comparisons.external.launch import Launched, end, import_path, launch, write_line
from comparisons.external.limits import TIME_LIMIT, Limits

__all__ = ["PATIENCE", "Child"]

#: Requests in a row that may run out of time; later ones are not sent, because a run of hundreds must end.
PATIENCE = 3

#: Seconds in which a fresh interpreter must have imported the worker, before any code of a model; 0.5 are usual.
_START = 120.0

#: Longest reply, in bytes: a curve of a million points and a few columns.
_LONGEST_REPLY = 200_000_000

# Time that a process may take to end after its pipe has closed; a loaded machine took more than a second.
_END_SECONDS = 20.0


class Child:
    """A process that has loaded one model; started at the first request, and again after it had to be ended.

    Parameters
    ----------
    source : dict
        How the worker finds the model.
    limits : Limits
    """

    def __init__(self, source: dict[str, Any], limits: Limits) -> None:
        self._source = source
        self._limits = limits
        self._launched: Launched | None = None
        self._first: dict[str, Any] = {}
        self._contradiction = ""
        self._overdue = 0

    @property
    def is_program(self) -> bool:
        """Whether the model is a program that is no Python."""
        return bool(self._source["kind"] == "program")

    def request(self, request: str, **arguments: Any) -> dict[str, Any]:
        """Return the reply to a request.

        Parameters
        ----------
        request : str
            ``"load"``, ``"evaluate"`` or ``"curve"``.
        **arguments
            What goes with it, as JSON has it.

        Returns
        -------
        dict
            ``status``, and for a failure a ``reason``; nothing a model does raises an exception.
        """
        if self._overdue >= PATIENCE:
            return _failed(f"not evaluated: it ran out of time {PATIENCE} times in a row")
        if self._contradiction:
            return _failed(self._contradiction)
        if self._launched is None:
            loaded = self._start()
            if loaded["status"] != "ok" or request == "load":
                return loaded
        overdue = self._overdue
        reply = self._exchange({"request": request, **arguments})
        # Only the reply to a case shows that the model can be in time; loading it again does not.
        self._overdue = self._overdue if self._overdue > overdue else 0
        return reply

    def close(self) -> None:
        """End the process and whatever it started in its process group, and remove its scratch folder."""
        if self._launched is not None:
            end(self._launched)
        self._launched = None

    def _start(self) -> dict[str, Any]:
        path = import_path()
        self._launched = launch(path)
        reply = self._exchange({"request": "ready", "limits": asdict(self._limits), "path": path}, _START)
        if reply["status"] == "ok":
            reply = self._exchange({"request": "load", "source": self._source | {"skip": _output_files()}})
        if reply["status"] != "ok":
            self.close()
            return reply
        return self._compared(reply)

    def _compared(self, loaded: dict[str, Any]) -> dict[str, Any]:
        """Return the reply of a new process, or a failure if name, version or files are not those of the first."""
        self._first = self._first or loaded
        if any(loaded.get(key) != self._first.get(key) for key in ("name", "version", "digest")):
            self.close()
            self._contradiction = contradiction(identity_of(self._first), identity_of(loaded))
            return _failed(self._contradiction)
        return loaded

    def _exchange(self, request: dict[str, Any], seconds: float | None = None) -> dict[str, Any]:
        seconds = seconds or self._limits.seconds
        launched = self._launched
        if launched is None:
            return _failed("its process has ended")
        started = time.monotonic()
        try:
            write_line(launched.process, json.dumps(request, allow_nan=False).encode())
        except OSError:
            return self._ended(launched)
        line = _line(launched.replies, started + seconds)
        if line is None:
            self.close()
            self._overdue += 1
            flush = "; a program must flush its standard output after every line" if self.is_program else ""
            limit = f" ({TIME_LIMIT})" if request["request"] != "ready" else ""
            return _failed(f"it gave no result within {seconds:g} s{limit} and was ended{flush}")
        if not line:
            return self._ended(launched)
        try:
            reply = json.loads(line)
            if reply["status"] in {"ok", "not-applicable", "failed"}:
                return dict(reply)
        except (ValueError, KeyError, TypeError, RecursionError):
            pass
        self.close()
        return _failed("its process wrote something that is not a result")

    def _ended(self, launched: Launched) -> dict[str, Any]:
        # The pipe may close a moment before the process is gone; one that closed it by itself is ended.
        code = None
        with contextlib.suppress(subprocess.TimeoutExpired):
            code = launched.process.wait(_END_SECONDS)
        self.close()
        if code is None:
            return _failed("its process closed the pipe for its results")
        if code < 0:
            return _failed(f"its process was killed by {_signal_name(-code)}")
        return _failed(f"it ended its process with exit status {code}, as os._exit does")


def _line(replies: int, deadline: float) -> bytes | None:
    """Return a line, b"" when there will be none, None when time is up."""
    parts: list[bytes] = []
    length = 0
    while (left := deadline - time.monotonic()) > 0:
        if not select.select([replies], [], [], left)[0]:
            break
        part = os.read(replies, 1 << 16)
        parts.append(part)
        length += len(part)
        if part.endswith(b"\n"):
            return b"".join(parts)
        if not part:
            return b""
        if length > _LONGEST_REPLY:
            return b"too long"
    return None


def _output_files() -> list[tuple[int, int]]:
    """Return device and inode of the files that take our output: they grow, and are no files of a model."""
    found = []
    for descriptor in (1, 2):
        with contextlib.suppress(OSError):
            status = os.fstat(descriptor)
            found.append((status.st_dev, status.st_ino))
    return found


def _signal_name(number: int) -> str:
    """Return e.g. SIGKILL; most real-time signals have a number only."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def _failed(reason: str) -> dict[str, Any]:
    return {"status": "failed", "reason": reason, "seconds": 0.0}
