"""Lines of a text for the columns of a terminal."""

from __future__ import annotations

from rich.cells import cell_len

__all__ = ["folded", "hanging"]


def folded(text: str, width: int) -> list[str]:
    """Return the lines of a text, folded between words; a word that is longer than a line stays whole.

    Examples
    --------
    >>> folded("pull_off_force of md-improved", 14)
    ['pull_off_force', 'of md-improved']
    """
    lines = []
    for line in text.split("\n"):
        current = ""
        for word in line.split(" "):
            joined = f"{current} {word}" if current else word
            if current and cell_len(joined) > width:
                lines.append(current)
                joined = word
            current = joined
        lines.append(current)
    return lines


def hanging(text: str, width: int) -> list[str]:
    """Return the lines of a text with its own indent, and two columns more from the second line on.

    Examples
    --------
    >>> hanging("  a text of several words", 16)
    ['  a text of', '    several', '    words']
    """
    start = text[: len(text) - len(text.lstrip())]
    first, *others = folded(text.strip(), width - len(start) - 2)
    return [start + first, *(f"{start}  {line}" for line in others)]
