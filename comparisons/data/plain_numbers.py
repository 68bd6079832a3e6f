"""Numbers as a user writes them: in digits of ASCII, without the underscores that Python reads as nothing."""

from __future__ import annotations


def plain_float(text: str) -> float:
    """Return a number; `ValueError` if the text is none.

    Examples
    --------
    >>> plain_float("4e2"), plain_float("inf")
    (400.0, inf)
    >>> plain_float("4_0_0")
    Traceback (most recent call last):
    ValueError: '4_0_0' is not a number
    """
    try:
        return float(_plain(text))
    except ValueError:
        raise ValueError(f"{text[:80]!a} is not a number") from None


def plain_int(text: str) -> int:
    """Return an integer; `ValueError` if the text is none.

    Examples
    --------
    >>> plain_int("40")
    40
    """
    try:
        return int(_plain(text))
    except ValueError:
        raise ValueError(f"{text[:80]!a} is not an integer") from None


def _plain(text: str) -> str:
    if "_" in text or not text.isascii():
        raise ValueError
    return text
