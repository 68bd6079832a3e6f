"""The number by which a statement is judged, and the factors by which it must change for another verdict."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from comparisons.paper.statements.evidence import (
    READING,
    REFERENCES,
    UNDECIDED,
    Evidence,
    Number,
    clauses,
    verdict,
)

__all__ = ["NO_FLIP", "flips", "flips_text", "read_number", "with_number"]

#: The value is zero within its bound: no number above that bound changes the verdict.
NO_FLIP = "none above the bounds"

#: Factor of the range beyond the largest and below the smallest number at which a comparison changes.
_FAR = 2.0
#: A factor below this has an exponent.
_SMALL = 1e-3


def read_number(evidence: Iterable[Evidence]) -> float | None:
    """Return the number that reads a word of the statement, or None if every comparison is of two computed numbers.

    Raises
    ------
    ValueError
        If there are several: a factor would not say which of them must change.
    """
    numbers = {row.limit.value for row in evidence if row.limit.what == READING}
    if len(numbers) > 1:
        raise ValueError(f"a statement is judged by {sorted(numbers)}; it must be judged by one number")
    return numbers.pop() if numbers else None


def with_number(evidence: Iterable[Evidence], number: float) -> list[Evidence]:
    """Return the comparisons with another number that reads the word.

    Both references are given what only one of them computes: nothing is left open for lack of the other.
    """
    rows = [replace(row, limit=Number(number, 0.0, READING)) if row.limit.what == READING else row for row in evidence]
    return [replace(row, model=model) for row in rows for model in (REFERENCES if _alone(row, rows) else (row.model,))]


def _alone(row: Evidence, rows: Sequence[Evidence]) -> bool:
    return row.model in REFERENCES and {other.model for other in rows if other.clause == row.clause} == {row.model}


def flips(evidence: Sequence[Evidence]) -> dict[str, float]:
    """Return the other verdicts, each with the factor nearest to 1 by which the number must change for it.

    Examples
    --------
    >>> rows = [Evidence(f"mu = {x}", "fscm", Number(x, 0.0, ""), "<", Number(2.0, 0.0, READING)) for x in (3.0, 5.0)]
    >>> flips(rows)
    {'true in part': 1.5, 'true': 2.5}
    """
    number = read_number(evidence)
    if number is None:
        return {}
    now = _verdict(evidence, number)
    nearest: dict[str, float] = {}
    for low, high in _ranges(evidence):
        other = _verdict(evidence, 0.5 * (low + high))
        if other in (now, UNDECIDED) or low <= number <= high:
            continue
        factor = (low if low > number else high) / number
        if other not in nearest or _distance(factor) < _distance(nearest[other]):
            nearest[other] = factor
    return dict(sorted(nearest.items(), key=lambda item: _distance(item[1])))


def _verdict(evidence: Sequence[Evidence], number: float) -> str:
    return verdict(clauses(with_number(evidence, number)).values())


def _ranges(evidence: Sequence[Evidence]) -> Iterator[tuple[float, float]]:
    """Ranges of the number in which no comparison changes its outcome."""
    ends = {row.value.value + u for row in evidence if row.limit.what == READING for u in (-row.value.u, row.value.u)}
    positive = sorted(end for end in ends if end > 0.0)
    if positive:
        yield from pairwise([0.0, *positive, _FAR * positive[-1]])


def _distance(factor: float) -> float:
    return max(factor, 1.0 / factor) if factor > 0.0 else float("inf")


def flips_text(evidence: Sequence[Evidence]) -> str:
    """Return the factors as a text, the nearest first; empty where there is no number.

    Examples
    --------
    >>> row = Evidence("n = 2", "formula", Number(0.1000341, 0.0, ""), "<", Number(0.1, 0.0, READING))
    >>> flips_text([row])
    'true above x 1.00035'
    """
    if read_number(evidence) is None:
        return ""
    texts = [
        f"{other} {'above' if factor > 1.0 else 'below'} x {_factor_text(factor)}"
        for other, factor in flips(evidence).items()
    ]
    return "; ".join(texts) or NO_FLIP


def _factor_text(factor: float) -> str:
    """Three digits, or those that tell the factor from 1 to a part in ten, rounded away from 1: it is enough."""
    decimals = max(2 - math.floor(math.log10(factor)), 1 - math.floor(math.log10(abs(factor - 1.0))))
    step = 10.0**-decimals
    steps = math.ceil(factor / step) if factor > 1.0 else math.floor(factor / step)
    return f"{steps * step:.3g}" if factor < _SMALL else f"{steps * step:.{max(decimals, 0)}f}"
