"""The choice of a model by its error: the simplest one that is certainly near enough."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

#: Errors for which a model is recommended.
LIMITS = (0.01, 0.05)

#: Order in which a closed form is recommended: limits, asymptote, models of the transition.  Every other one, a fit or
#: another cohesive stress, comes after them: it may be right in one problem because errors cancel.
SIMPLEST_FIRST = (
    "jkr",
    "jkr-sphere",
    "jkr-sphere-projected",
    "jkr-profile",
    "jkr-surface-tension",
    "dmt",
    "bradley",
    "semi-rigid",
    "md-improved",
    "md-original",
    "md-profile",
    "md-jin",
    "double-hertz-n-k",
)


def is_within(row: Mapping[str, Any], limit: float) -> bool:
    """Return whether an error, with its bound, is certainly within a limit, by ``at_most`` where the row has it.

    Examples
    --------
    >>> is_within({"error": -0.04, "u_num": 0.02}, 0.05)
    False
    >>> is_within({"error": 0.001, "u_num": 0.0, "at_most": 0.051}, 0.05)
    False
    """
    return float(row.get("at_most", size_of(row))) <= limit


def size_of(row: Mapping[str, Any]) -> float:
    """Return the size of an error with its bound."""
    return float(abs(row["error"]) + row["u_num"])


def by_size(*sizes: float) -> float:
    """Return what errors of these sizes make at most after each other.

    Errors of different causes that cancel in one problem do not in the next one.

    Examples
    --------
    >>> round(by_size(0.02, 0.03), 12)
    0.0506
    """
    return math.prod(1.0 + size for size in sizes) - 1.0


def simplest_within(errors: Sequence[Mapping[str, Any]], limit: float) -> str | None:
    """Return the simplest closed form whose error is certainly within a limit, in the order of `SIMPLEST_FIRST`.

    Examples
    --------
    >>> errors = [{"model": "schwarz", "error": 1e-4, "u_num": 0.0}, {"model": "jkr", "error": 0.02, "u_num": 0.0}]
    >>> simplest_within(errors, 0.05), simplest_within(errors, 0.01), simplest_within(errors, 1e-5)
    ('jkr', 'schwarz', None)
    """
    within = [row["model"] for row in errors if is_within(row, limit)]
    return next((name for name in (*SIMPLEST_FIRST, *within) if name in within), None)
