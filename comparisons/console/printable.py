"""Texts of files and folders as they may reach a terminal: without control characters."""

from __future__ import annotations

import unicodedata

__all__ = ["printable"]


def printable(text: str) -> str:
    r"""Return a text with its control characters by their numbers; line feeds stay.

    A terminal would obey them: they hide lines, change its title or turn the direction of writing.

    Examples
    --------
    >>> print(printable("failed\x1b[2K"))
    failed\x1b[2K
    """
    if text.isprintable():
        return text
    return "".join(
        ascii(character)[1:-1] if character != "\n" and _is_control(character) else character for character in text
    )


def _is_control(character: str) -> bool:
    # "C": control, format, surrogate, private; lines and paragraphs of Unicode.
    category = unicodedata.category(character)
    return category[0] == "C" or category in ("Zl", "Zp")
