"""Text rules for external models: a name keeps a pattern, any other text is one short printable line."""

from __future__ import annotations

import re
import unicodedata

__all__ = ["TEXTS", "model_name", "one_line"]

#: Texts that every model states of itself.
TEXTS = ("name", "version", "citation", "domain")


#: Names become file names, table cells, HTML and command lines, and must be harmless in all of them.
_NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")

_MISSING = "is what programs that read CSV take for a missing value"
_TAKEN = {
    "given": "stands in gates for every model of --model",
    **dict.fromkeys(("nan", "na", "n-a", "null", "none", "nil"), _MISSING),
}
_LONGEST_TEXT = 500


def model_name(text: object) -> str:
    """Return the name of a model if it is admissible.

    Raises
    ------
    ValueError
        If it is not 1 to 64 letters, digits, dots, hyphens and underscores, the first a letter or a digit.

    Examples
    --------
    >>> model_name("double-hertz")
    'double-hertz'
    """
    if isinstance(text, str) and text.lower() in _TAKEN:
        raise ValueError(f"the model's name {text} {_TAKEN[text.lower()]}")
    if isinstance(text, str) and _NAME_PATTERN.fullmatch(text):
        return text
    raise ValueError(
        f"the model's name {one_line(repr(text), 60)} is not 1 to 64 letters, digits, '.', '_' and '-' beginning "
        "with a letter or a digit: it becomes a file name and a cell of tables"
    )


def one_line(text: str, longest: int = _LONGEST_TEXT) -> str:
    r"""Return a text as one line without control characters, cut to at most `longest` characters.

    Examples
    --------
    >>> one_line("two\nlines \x1b[31m")
    'two lines [31m'
    """
    # "C" are control, format (also those that turn the direction of writing), surrogate and private
    # characters.
    printable = "".join(
        " " if letter.isspace() else letter
        for letter in text[: 4 * longest]
        if letter.isspace() or unicodedata.category(letter)[0] != "C"
    )
    line = " ".join(printable.split())
    return line if len(line) <= longest else line[: longest - 3] + "..."
