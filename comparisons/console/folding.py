"""Lines of texts and of commands for the columns of a terminal."""

from __future__ import annotations

import shlex
import textwrap

__all__ = ["hanging", "wrapped_command"]


def hanging(text: str, width: int) -> list[str]:
    """Return the lines of a text with its own indent, and two columns more from the second line on.

    A word that is longer than a line stays whole.

    Examples
    --------
    >>> hanging("  a text of several words", 16)
    ['  a text of', '    several', '    words']
    """
    indent = " " * (len(text) - len(text.lstrip()) + 2)
    options = {"subsequent_indent": indent, "break_long_words": False, "break_on_hyphens": False}
    return [
        line
        for paragraph in text.split("\n")
        for line in textwrap.wrap(paragraph, max(width, 1), **options) or [""]  # type: ignore[arg-type]
    ]


def wrapped_command(line: str, width: int) -> list[str]:
    r"""Return a command in lines that a shell reads as one, indented by two columns.

    Parameters
    ----------
    line : str
        As a shell reads it.
    width : int
        Columns of the terminal; a line is longer only where one option with its values is.

    Examples
    --------
    >>> print("\n".join(wrapped_command("fscm-bench solve --model jkr --n 2 --k 0", 30)))
      fscm-bench solve \
        --model jkr --n 2 --k 0
    """
    groups: list[str] = []
    for word in shlex.split(line):
        quoted = shlex.quote(word)
        if groups and not word.startswith("--"):
            groups[-1] += f" {quoted}"
        else:
            groups.append(quoted)
    lines = [f"  {groups[0]}"]
    for group in groups[1:]:
        # Two columns for the blank and the backslash.
        if len(lines[-1]) + 1 + len(group) + 2 > width:
            lines[-1] += " \\"
            lines.append(f"    {group}")
        else:
            lines[-1] += f" {group}"
    return lines
