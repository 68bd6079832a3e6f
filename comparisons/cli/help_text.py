"""Help of the commands: descriptions without markup, and examples that can be copied."""

from __future__ import annotations

import argparse
import re
import textwrap
from collections.abc import Sequence

from comparisons.console.shell_text import wrapped_command

__all__ = ["HelpFormatter", "description_of", "examples_text"]

#: Column where the help of an option starts, at most; lines are no longer than so many columns.
_START, _WIDEST = 26, 100

#: Starts a line that is printed as it is, as one of a command.
_KEPT = "  "


class HelpFormatter(argparse.HelpFormatter):
    """Formatter that folds sentences to the terminal and keeps the lines of examples."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=_START)
        self._width = min(self._width, _WIDEST)

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        lines: list[str] = []
        for line in text.split("\n"):
            if line.startswith(_KEPT):
                lines += wrapped_command(line, width)
            else:
                lines += textwrap.wrap(line, width, break_long_words=False, break_on_hyphens=False) or [""]
        return "\n".join(lines)

    def _split_lines(self, text: str, width: int) -> list[str]:
        return textwrap.wrap(" ".join(text.split()), width, break_long_words=False, break_on_hyphens=False)


def description_of(docstring: str | None) -> str:
    """Return the first line of the docstring of a command, without its name and without markup.

    Examples
    --------
    >>> description_of("``fscm-bench judge``: a new judgement of stored results.")
    'A new judgement of stored results.'
    """
    line = (docstring or "").strip().partition("\n")[0].replace("`", "")
    line = re.sub(r"^fscm-bench [a-z-]+: ", "", line)
    return line[:1].upper() + line[1:]


def examples_text(examples: Sequence[str]) -> str:
    """Return the end of the help of a command.

    Examples
    --------
    >>> print(examples_text(["fscm-bench run"]))
    example:
      fscm-bench run
    """
    title = "example" if len(examples) == 1 else "examples"
    return "\n".join([f"{title}:", *(f"{_KEPT}{line}" for line in examples)])
