"""Lines of a text for the columns of a terminal."""

from __future__ import annotations

import textwrap

__all__ = ["folded", "hanging"]


def folded(text: str, width: int, indent: str = "") -> list[str]:
    """Return the lines of a text, folded between words; a word that is longer than a line stays whole.

    Parameters
    ----------
    text : str
    width : int
        Columns of the terminal.
    indent : str
        Begins every line of a paragraph from the second on.

    Examples
    --------
    >>> folded("pull_off_force of md-improved", 14)
    ['pull_off_force', 'of md-improved']
    """
    wrapper = textwrap.TextWrapper(
        max(width, 1), subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
    return [part for line in text.split("\n") for part in wrapper.wrap(line) or [""]]


def hanging(text: str, width: int) -> list[str]:
    """Return the lines of a text with its own indent, and two columns more from the second line on.

    Examples
    --------
    >>> hanging("  a text of several words", 16)
    ['  a text of', '    several', '    words']
    """
    return folded(text, width, " " * (len(text) - len(text.lstrip()) + 2))
