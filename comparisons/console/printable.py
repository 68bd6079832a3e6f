"""Texts of files and folders as they may reach a terminal: without control characters."""

from __future__ import annotations


def printable(text: str) -> str:
    r"""Return a text with all that is not printable by its number; line feeds stay.

    A terminal would obey them: they hide lines, change its title or turn the direction of writing.

    Examples
    --------
    >>> print(printable("failed\x1b[2K"))
    failed\x1b[2K
    """
    if text.isprintable():
        return text
    return "".join(
        character if character.isprintable() or character == "\n" else ascii(character)[1:-1] for character in text
    )
