"""Reader of TOML text, with one sentence for an error that names the file."""

from __future__ import annotations

import sys
import tomllib
from typing import Any

__all__ = ["is_real", "parse"]


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
        If it is not TOML, or nested too deeply for the parser.

    Examples
    --------
    >>> parse("n = [", "mine.toml")
    Traceback (most recent call last):
    ValueError: mine.toml is not TOML: Invalid value (at end of document)
    """
    try:
        return tomllib.loads(text)
    except ValueError as error:
        raise ValueError(f"{source} is not TOML: {error}") from None
    except RecursionError:
        raise ValueError(f"{source} is not TOML that can be read: its brackets are nested too deeply") from None


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
