"""Wells of a surface law: with a barrier between them a law has several equilibrium gaps.

The paths of such laws have more folds than those of a law with one well, and their states may return from compression
to tension when a barrier has been passed.  In a liquid the double layer or layers of molecules are such barriers.
"""

from __future__ import annotations

from collections.abc import Hashable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fscm._typing import Array
from fscm.laws import LennardJones, Mie, SurfaceLaw

__all__ = ["has_one_well", "outermost_turn", "tension_beyond"]

#: Gaps at which a law is looked at: distances from the singular gap in units of that of the largest tension.  Between
#: two of them, 0.5 % apart, a turn of the law is not seen.
_DISTANCES = np.geomspace(1e-2, 1e6, 4000)
#: Turns of the traction below this share of the largest tension are rounding, or noise of a table.
_SMALLEST_TURN = 1e-9
#: Factor of the largest tension at the samples that covers a maximum between two of them: its second order is 1e-5.
_BETWEEN = 1.001


class _Shape(NamedTuple):
    """Sampled gaps with the largest tension beyond each, the outermost turn, and whether there is one well."""

    gaps: Array
    tension: Array
    outermost: float
    has_one_well: bool


@lru_cache(maxsize=64)
def _sampled(law: SurfaceLaw) -> _Shape:
    gaps = law.singular_gap + (law.peak_gap - law.singular_gap) * _DISTANCES
    p = np.asarray(law.traction(gaps))
    least, smallest = int(np.argmin(p)), -_SMALLEST_TURN * float(np.min(p))
    beyond = np.maximum.accumulate(-p[::-1])[::-1]
    growing = np.flatnonzero(beyond[least:] > smallest - p[least:])
    # The sample next to the largest tension may lie beyond it.
    outermost = max(float(gaps[least + growing[-1] + 1]), law.peak_gap) if growing.size else law.peak_gap
    falls = bool(np.all(p[: least + 1] - np.minimum.accumulate(p[: least + 1]) <= smallest))
    return _Shape(gaps, _BETWEEN * np.maximum(beyond, 0.0), outermost, falls and not growing.size)


def _shape(law: SurfaceLaw) -> _Shape:
    return _sampled(law) if isinstance(law, Hashable) else _sampled.__wrapped__(law)


def has_one_well(law: SurfaceLaw) -> bool:
    """Whether the traction falls to the largest tension and rises beyond it, without another turn.

    Examples
    --------
    >>> has_one_well(LennardJones())
    True
    """
    return isinstance(law, LennardJones | Mie) or _shape(law).has_one_well


def outermost_turn(law: SurfaceLaw) -> float:
    """Gap beyond which the tension only falls; that of the largest tension for a law with one well.

    Examples
    --------
    >>> outermost_turn(LennardJones()) == LennardJones().peak_gap
    True
    """
    return _shape(law).outermost


def tension_beyond(law: SurfaceLaw, gap: Array) -> Array:
    """The largest tension at any gap of at least these, shape of `gap`.

    Examples
    --------
    >>> float(tension_beyond(LennardJones(), np.array(-0.5)))  # that of the law
    1.02640047...
    """
    if has_one_well(law):
        return np.asarray(-law.traction(np.maximum(gap, law.peak_gap)))
    gaps, tension, *_ = _shape(law)
    before = np.clip(np.searchsorted(gaps, gap, side="right") - 1, 0, len(gaps) - 1)
    return np.where(gap > gaps[-1], -law.traction(np.maximum(gap, gaps[-1])), tension[before])
