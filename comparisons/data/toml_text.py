"""Reader of TOML text, with one sentence for an error that names the file."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

#: Most characters of a key or of a text; the longest of our files has 330.  The search for the known name nearest to an
#: unknown one, and the reading of a unit, take minutes for a megabyte.
LONGEST_WORD = 10_000

#: Most parts of a dotted key.  The deepest of our files has three; the parser needs time and memory of the square of
#: their number, 400 MB for a key of 300 kB.
_MOST_PARTS = 32
_PART = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\."""
#: A key, also of a table, with more of them.
_DEEP_KEY = re.compile(rf"(?<![A-Za-z0-9_-])(?:{_PART}[ \t]*+){{{_MOST_PARTS}}}")

#: A number with a unit that is not in quotes, and the line of which the parser speaks.
_BARE = re.compile(r"\s*+([\w.]{1,40})\s*+=\s*+([-+]?[0-9][0-9.eE+-]{0,20} ?[A-Za-zµ%][\w/^*. -]{0,20})\s*+(?:#.*)?+")
_LINE = re.compile(r"\(at line ([0-9]{1,6}),")

#: Most bits of an integer, which may be hexadecimal: Python writes none of more than 4300 digits, 14000 bits, into a
#: sentence.
_MOST_BITS = 4096


def shipped(name: str) -> dict[str, Any]:
    """Return the tables of a file in this folder.

    Examples
    --------
    >>> shipped("kinds.toml")["punch"]["ball"]["keys"]
    {'R': 'length'}
    """
    return tomllib.loads(files("comparisons.data").joinpath(name).read_text(encoding="utf-8"))


def _remedy(text: str, error: str) -> str:
    """What to write where a value with a unit is not in quotes, else nothing."""
    line = _LINE.search(error)
    bare = _BARE.fullmatch(text.split("\n")[int(line[1]) - 1].rstrip("\r")) if line else None
    return f'; a value with a unit is in quotes, as {bare[1]} = "{bare[2].strip()}"' if bare else ""


def parse(text: str, source: str) -> dict[str, Any]:
    """Return the tables of a TOML text.

    Parameters
    ----------
    text : str
    source : str
        What the text is of, for the sentence.

    Raises
    ------
    ValueError
        If it is not TOML, nested too deeply for the parser, or has a key or a text longer than `LONGEST_WORD` or an
        integer of more than `_MOST_BITS`.

    Examples
    --------
    >>> parse("n = [", "mine.toml")
    Traceback (most recent call last):
    ValueError: mine.toml is not TOML: Invalid value (at end of document)
    """
    too_deep = f"{source} is not TOML that can be read: its keys or brackets are nested too deeply"
    if _DEEP_KEY.search(text):
        raise ValueError(too_deep)
    try:
        tables = tomllib.loads(text)
    except ValueError as error:
        # What Python says of a number of thousands of digits has another remedy.
        reason = "a number has too many digits" if "set_int_max_str_digits" in str(error) else error
        raise ValueError(f"{source} is not TOML: {reason}{_remedy(text, str(error))}") from None
    except RecursionError:
        raise ValueError(too_deep) from None
    for value in _values(tables):
        if isinstance(value, str) and len(value) > LONGEST_WORD:
            raise ValueError(
                f"{source} has a key or a text of {len(value)} characters; they have at most {LONGEST_WORD}"
            )
        if isinstance(value, int) and value.bit_length() > _MOST_BITS:
            raise ValueError(f"{source} has an integer of {value.bit_length()} bits; they have at most {_MOST_BITS}")
    return tables


def _values(tables: dict[str, Any]) -> Iterator[object]:
    """Yield the keys of all tables, and the values that are neither a table nor a list."""
    pending: list[Any] = [tables]
    while pending:
        value = pending.pop()
        if isinstance(value, dict):
            yield from value
            pending.extend(value.values())
        elif isinstance(value, list):
            pending.extend(value)
        else:
            yield value


def is_real(value: object) -> bool:
    """Whether a value is a number that a double holds, perhaps infinite; true and false are none.

    Examples
    --------
    >>> [is_real(value) for value in (1, 0.5, float("inf"), True, "1", 10**400)]
    [True, True, True, False, False, False]
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return isinstance(value, float) or abs(value) <= sys.float_info.max
