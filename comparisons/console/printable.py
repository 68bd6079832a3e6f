"""Texts as they may reach a terminal or a page: without control characters, and in lines of 80 characters."""

from __future__ import annotations

import textwrap
import unicodedata

#: Characters of a line, also where it is no terminal: the same text in every log and file.
WIDTH = 80

#: Most combining marks in sequence.  Languages use two; a pile of dozens covers the lines above and below.
_MOST_MARKS = 3


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


def wrapped(line: str) -> list[str]:
    """Return a line of words and numbers in pieces of `WIDTH` characters, indented after the first; a command is whole.

    Examples
    --------
    >>> wrapped("  " + 25 * "word ")[1]
    '    word word word word word word word word word word'
    >>> len(wrapped("  fscm-bench solve" + 25 * " word"))
    1
    """
    text = line.lstrip()
    if len(line) <= WIDTH or text.startswith("fscm-bench "):
        return [line]
    indent = " " * (len(line) - len(text) + 2)
    return textwrap.wrap(line, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def is_line(text: str) -> bool:
    r"""Whether a text is one printable line: no control characters, single spaces between words, no pile of marks.

    A character that turns the direction of writing is a control character, too.

    Examples
    --------
    >>> [is_line(text) for text in ("J. Müller", "two\nlines", "gnp\u202e.txt", " ", "a" + "\u0301" * 9)]
    [True, False, False, False, False]
    """
    return bool(text) and text == " ".join(text.split()) and text.isprintable() and text == without_piles(text)


def without_piles(text: str) -> str:
    r"""Return a text with at most three combining marks in sequence.

    Examples
    --------
    >>> len(without_piles("a" + "\u0301" * 9))
    4
    """
    if text.isascii():
        return text
    kept, marks = [], 0
    for character in text:
        marks = marks + 1 if unicodedata.category(character) in ("Mn", "Me") else 0
        if marks <= _MOST_MARKS:
            kept.append(character)
    return "".join(kept)
