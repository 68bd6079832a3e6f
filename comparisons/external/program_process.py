"""A running program that exchanges JSON lines, and the meaning of its replies."""

from __future__ import annotations

import contextlib
import json
import os
import resource
import select
import subprocess
import tempfile
from pathlib import Path
from typing import IO, Any, NoReturn

from comparisons.external.reply_checks import kind
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed, NotApplicable

__all__ = ["TEXTS", "ProgramProcess", "outcome", "require"]

#: Longest line of a program, in bytes: a curve of a million points in three columns with all digits.
_LONGEST_LINE = 100_000_000

#: Seconds that a program may take to end after it has closed its standard output.
_END_SECONDS = 5.0

#: Bytes of the end of stderr that are read for a message.
_LAST_WORDS = 1000

#: What every program states of itself, and what it may state besides.
TEXTS = ("name", "version", "citation", "domain")
_DESCRIBED = {*TEXTS, "status", "limits", "applies_to", "files", "curve"}


class ProgramProcess:
    """The running program, with its standard error in a file of the scratch folder.

    Parameters
    ----------
    file : Path

    Raises
    ------
    comparisons.model.ComputationFailed
        If it cannot be started.
    """

    def __init__(self, file: Path) -> None:
        # Closed in `end`.
        self._errors: IO[bytes] = tempfile.TemporaryFile(dir=Path.cwd())  # noqa: SIM115
        try:
            self._process = subprocess.Popen(
                [str(file)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, bufsize=0
            )
        except OSError as error:
            self._errors.close()
            raise ComputationFailed(
                f"the program cannot be started ({error.strerror}): it must be an executable of this machine, or a "
                "script whose first line is #! and its interpreter"
            ) from None
        # The clock ends an evaluation.  The time of processor of this process is not that of the program.
        with contextlib.suppress(AttributeError, OSError, ValueError):
            _, hard = resource.getrlimit(resource.RLIMIT_CPU)
            resource.prlimit(self._process.pid, resource.RLIMIT_CPU, (hard, hard))

    def has_ended(self) -> bool:
        """Whether the program has ended; a failure if it wrote something without a request."""
        output = self._process.stdout
        if output is not None and select.select([output], [], [], 0)[0]:
            if os.read(output.fileno(), 1):
                raise ComputationFailed("the program wrote more than one line for the request before this one")
            return True
        return self._process.poll() is not None

    def described(self) -> dict[str, Any]:
        """Return what the program states of itself."""
        reply = outcome(self.exchange({"request": "describe"}), _DESCRIBED, needs_status=False)
        require(reply, TEXTS)
        for name in TEXTS:
            if not isinstance(reply[name], str):
                raise ComputationFailed(f"the program gave {kind(reply[name])} as {name}, which is not a text")
        for name in ("limits", "files"):
            listed = reply.get(name, [])
            if not isinstance(listed, list) or not all(isinstance(text, str) for text in listed):
                raise ComputationFailed(f"the program gave {kind(listed)} as {name}, which is not a list of texts")
        return reply

    def exchange(self, request: dict[str, Any]) -> dict[str, Any]:
        """Return the object that the program replies with."""
        try:
            if self._process.stdin is not None:
                self._process.stdin.write(json.dumps(request, allow_nan=False).encode() + b"\n")
        except OSError:
            self._raise_ended()
        return self._parsed(self._line())

    def end(self) -> None:
        """End the program."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout, self._errors):
            if pipe is not None:
                with contextlib.suppress(OSError):
                    pipe.close()

    def _line(self) -> bytes:
        parts: list[bytes] = []
        length = 0
        descriptor = self._process.stdout.fileno() if self._process.stdout else -1
        while part := os.read(descriptor, 1 << 16):
            line, end, rest = part.partition(b"\n")
            parts.append(line)
            length += len(line)
            if length > _LONGEST_LINE:
                raise ComputationFailed(
                    f"the program wrote {_LONGEST_LINE // 1_000_000} MB without the end of a line: a reply is one line"
                )
            if end and rest.strip():
                raise ComputationFailed("the program wrote more than one line for one request")
            if end:
                return b"".join(parts)
        self._raise_ended()

    def _parsed(self, line: bytes) -> dict[str, Any]:
        try:
            reply = json.loads(line.decode(), parse_constant=_refuse_constant)
        except (ValueError, RecursionError):
            reply = None
        if not isinstance(reply, dict):
            shown = one_line(repr(line[:200].decode(errors="replace")), 80)
            raise ComputationFailed(f"the program wrote {shown}, which is not one JSON object in one line")
        return reply

    def _raise_ended(self) -> NoReturn:
        code = None
        with contextlib.suppress(subprocess.TimeoutExpired):
            code = self._process.wait(_END_SECONDS)
        if code is None:
            how = "closed its standard output"
        elif code < 0:
            how = f"was killed by signal {-code}"
        else:
            how = f"ended with exit status {code}"
        raise ComputationFailed(f"the program {how} instead of a reply{self._last_words()}")

    def _last_words(self) -> str:
        """Return the last line of standard error, for a sentence."""
        with contextlib.suppress(OSError):
            size = os.fstat(self._errors.fileno()).st_size
            text = os.pread(self._errors.fileno(), _LAST_WORDS, max(size - _LAST_WORDS, 0)).decode(errors="replace")
            if lines := [line for line in text.splitlines() if line.strip()]:
                return f"; the last line of its stderr: {one_line(lines[-1], 120)}"
        return ""


def outcome(reply: dict[str, Any], known: set[str], *, needs_status: bool = True) -> dict[str, Any]:
    """Return a reply with a result; raise what another status means.

    Parameters
    ----------
    reply : dict
        Of the program.
    known : set of str
        The keys that it may have.
    needs_status : bool
        Whether a reply without a status is an error.

    Examples
    --------
    >>> outcome({"status": "not-applicable", "reason": "n is not 2"}, {"status"})
    Traceback (most recent call last):
    comparisons.model.NotApplicable: n is not 2
    """
    status = reply.get("status", None if needs_status else "ok")
    if status in ("not-applicable", "failed"):
        reason = reply.get("reason", "")
        text = one_line(reason) if isinstance(reason, str) else ""
        raise (NotApplicable if status == "not-applicable" else ComputationFailed)(text)
    if status != "ok":
        raise ComputationFailed(
            f'the program gave {kind(status)} as status, which is not "ok", "not-applicable" or "failed"'
        )
    if unknown := sorted(reply.keys() - known):
        raise ComputationFailed(f"the program gave the unknown key {one_line(repr(unknown[0]), 60)}")
    return reply


def require(reply: dict[str, Any], names: tuple[str, ...]) -> None:
    """Refuse a reply without some keys.

    Examples
    --------
    >>> require({"value": 1.7}, ("value", "u_num"))
    Traceback (most recent call last):
    comparisons.model.ComputationFailed: the reply of the program has no u_num
    """
    if missing := [name for name in names if name not in reply]:
        raise ComputationFailed(f"the reply of the program has no {', '.join(missing)}")


def _refuse_constant(name: str) -> NoReturn:
    """Refuse NaN and Infinity, which JSON does not have."""
    raise ComputationFailed(f"the program wrote {name}, which is not a finite number, and which JSON does not have")
