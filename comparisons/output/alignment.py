"""Columns of texts that are numbers with their uncertainties: every format aligns these."""

from __future__ import annotations

import re
from collections.abc import Iterable

__all__ = ["aligned", "number_parts"]

#: What siunitx reads as a number: sign and digits, decimals, uncertainty, power of ten.
_NUMBER = re.compile(r"-?([0-9]+)(?:\.([0-9]+))?(?:\(([0-9]+)\))?(?:e([+-]?[0-9]+))?")


def number_parts(text: str) -> re.Match[str] | None:
    """Return the parts of a number with its uncertainty: digits, decimals, uncertainty, power of ten.

    Examples
    --------
    >>> number_parts("-1.79(2)e-7").groups()
    ('1', '79', '2', '-7')
    """
    return _NUMBER.fullmatch(text)


def aligned(texts: Iterable[str]) -> bool:
    """Whether a column of texts is one of numbers: at least half of those that are not empty.

    Examples
    --------
    >>> aligned(["-5.0(3)", "failed", ""]), aligned(["jkr", "2"]), aligned([])
    (True, True, False)
    """
    filled = [text for text in texts if text]
    return 2 * sum(number_parts(text) is not None for text in filled) >= max(len(filled), 1)
