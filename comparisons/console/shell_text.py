"""Commands as texts for a terminal."""

from __future__ import annotations

import shlex

__all__ = ["wrapped_command"]


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
