"""Streams whose encoding is not UTF-8, as of a file or a pipe on Windows: they take every text."""

from __future__ import annotations

import codecs
import io
import unicodedata
from typing import TextIO

#: Name of the handler of errors, for `codecs`.
HANDLER = "comparisons-readable"

#: Characters of our texts that no rule below makes readable in ASCII.
_IN_ASCII = {
    "·": "*",
    "±": "+-",
    "≤": "<=",
    "≥": ">=",
    "≈": "~",
    "≠": "!=",
    "×": "x",
    "°": " deg",
    "√": "sqrt",
    "∞": "inf",
    "ß": "ss",
}
_IN_ASCII |= dict.fromkeys("−–—─", "-") | dict.fromkeys("‘’′", "'") | dict.fromkeys("“”", '"')
_IN_ASCII |= {"→": "->", "←": "<-", "↑": "^", "↓": "v"}


def readable(character: str) -> str:
    r"""Return a character in ASCII: its digit or letter, the name of a Greek one, a likeness, or its number.

    Examples
    --------
    >>> [readable(character) for character in "µ₀κΔ≤é山"]
    ['mu', '0', 'kappa', 'Delta', '<=', 'e', '\\u5c71']
    """
    if character in _IN_ASCII:
        return _IN_ASCII[character]
    plain = "".join(part for part in unicodedata.normalize("NFKD", character) if not unicodedata.combining(part))
    if plain and plain.isascii():
        return plain
    kind, _, letter = unicodedata.name(plain[:1] or character, "").partition(" LETTER ")
    if kind in ("GREEK SMALL", "GREEK CAPITAL") and " " not in letter:
        return letter.lower() if kind == "GREEK SMALL" else letter.capitalize()
    return ascii(character)[1:-1]


def take_every_text(stream: TextIO) -> None:
    """Let a stream write what its encoding lacks as `readable` has it, in place of an error."""
    if not isinstance(stream, io.TextIOWrapper) or codecs.lookup(stream.encoding).name == "utf-8":
        return
    codecs.register_error(HANDLER, _replaced)
    stream.reconfigure(errors=HANDLER)


def _replaced(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(readable, error.object[error.start : error.end])), error.end
