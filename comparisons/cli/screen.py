"""Output of the commands: lines and tables, and the end of a command that computes rows."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comparisons.console.exit_status import FAILED, OK, writing_stdout
from comparisons.console.printable import WIDTH, printable, wrapped
from comparisons.console.progress import log, note
from comparisons.console.safe_console import SafeConsole

if TYPE_CHECKING:
    from comparisons.runs.rows import Row


class _Output(SafeConsole):
    def print(self, *objects: Any, **options: Any) -> None:
        # A word that is longer than a line, as a path, continues in the next one; rich would cut it.
        with writing_stdout():
            super().print(*objects, **{"crop": False, **options})


def output() -> SafeConsole:
    """Return the console for results: stdout with the columns of the terminal, or 80 where it is none."""
    return _Output(width=None if sys.stdout.isatty() else WIDTH, highlight=False, markup=False)


def print_text(lines: Iterable[str]) -> None:
    """Print lines of words, numbers and commands, as `wrapped` has them."""
    for line in lines:
        for piece in wrapped(line):
            print(printable(piece))


def print_end(failures: Sequence[Row], folder: Path, files: str = "results are") -> int:
    """Print the first failures and where the files are; return the exit status without gates."""
    # Imported here: what prints no table does not need its library.
    from comparisons.output.summaries import failure_lines

    for line in failure_lines(failures):
        log(line)
    note(f"{files} in {folder}")
    return FAILED if failures else OK
