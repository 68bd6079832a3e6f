"""Output of the commands on stdout: lines, tables and pages."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from comparisons.console.exit_status import writing_stdout
from comparisons.console.printable import printable
from comparisons.console.progress import log
from comparisons.console.safe_console import SafeConsole
from comparisons.runs.atomic_files import atomic

__all__ = ["output", "print_lines", "write_page"]

#: Columns of a table when stdout is no terminal: the same text in every log and file.
_WIDTH = 80


class _Output(SafeConsole):
    def print(self, *objects: Any, **options: Any) -> None:
        # A word that is longer than a line, as a path, continues in the next one; rich would cut it.
        with writing_stdout():
            super().print(*objects, **{"crop": False, **options})


def output() -> SafeConsole:
    """Return the console for results: stdout with the columns of the terminal, or 80 where it is none."""
    return _Output(width=None if sys.stdout.isatty() else _WIDTH, highlight=False, markup=False)


def print_lines(lines: Iterable[str]) -> None:
    """Print whole lines, so that a command in them can be copied."""
    print(printable("\n".join(lines)))


def write_page(text: str, path: Path, name: str) -> None:
    """Write a page and say where it is."""
    with atomic(path) as page:
        page.write(text.encode())
    log(f"the {name} is {path}")
