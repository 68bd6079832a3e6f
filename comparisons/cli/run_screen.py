"""End of a command that computes rows: failures on stderr, the folder, and the exit status."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, note
from comparisons.output.summaries import failure_lines
from comparisons.runs.rows import Row

__all__ = ["print_end"]


class _Finished(Protocol):
    @property
    def folder(self) -> Path: ...
    @property
    def failures(self) -> tuple[Row, ...]: ...


def print_end(finished: _Finished, files: str = "results are") -> int:
    """Print the first failures and where the files are; return the exit status without gates."""
    for line in failure_lines(finished.failures):
        log(line)
    note(f"{files} in {finished.folder}")
    return FAILED if finished.failures else OK
