"""Reader of TOML text, with one sentence for an error that names the file."""

from __future__ import annotations

import sys
import tomllib
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

#: Most characters of a key or of a text; the longest of our files has 330.  The search for the known name nearest to an
#: unknown one, and the reading of a unit, take minutes for a megabyte.
LONGEST_WORD = 10_000


def shipped(name: str) -> dict[str, Any]:
    """Return the tables of a file in this folder.

    Examples
    --------
    >>> shipped("kinds.toml")["punch"]["sphere"]["keys"]
    {'R': 'length'}
    """
    return tomllib.loads(files("comparisons.data").joinpath(name).read_text(encoding="utf-8"))


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
        If it is not TOML, nested too deeply for the parser, or has a key or a text longer than `LONGEST_WORD`.

    Examples
    --------
    >>> parse("n = [", "mine.toml")
    Traceback (most recent call last):
    ValueError: mine.toml is not TOML: Invalid value (at end of document)
    """
    try:
        tables = tomllib.loads(text)
    except ValueError as error:
        # What Python says of a number of thousands of digits has another remedy.
        reason = "a number has too many digits" if "set_int_max_str_digits" in str(error) else error
        raise ValueError(f"{source} is not TOML: {reason}") from None
    except RecursionError:
        raise ValueError(f"{source} is not TOML that can be read: its brackets are nested too deeply") from None
    if (length := max(map(len, _words(tables)), default=0)) > LONGEST_WORD:
        raise ValueError(f"{source} has a key or a text of {length} characters; they have at most {LONGEST_WORD}")
    return tables


def _words(tables: dict[str, Any]) -> Iterator[str]:
    """Yield the keys and the texts of all tables."""
    pending: list[Any] = [tables]
    while pending:
        value = pending.pop()
        if isinstance(value, dict):
            yield from value
            pending.extend(value.values())
        elif isinstance(value, list):
            pending.extend(value)
        elif isinstance(value, str):
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
