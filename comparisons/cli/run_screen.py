"""End of a command that computes rows: failures on stderr, the folder, and the exit status."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, note
from comparisons.output.summaries import failure_lines
from comparisons.runs.rows import Row

__all__ = ["print_end"]


def print_end(failures: Sequence[Row], folder: Path, files: str = "results are") -> int:
    """Print the first failures and where the files are; return the exit status without gates."""
    for line in failure_lines(failures):
        log(line)
    note(f"{files} in {folder}")
    return FAILED if failures else OK
