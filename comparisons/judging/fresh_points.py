"""Points of fresh cases: spread over the domain of a model or between standing cases, apart from these."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.domain import Domain
from comparisons.judging.gates import Gate
from comparisons.judging.selection import promised
from comparisons.problem import Problem

__all__ = ["REACH", "Sample", "sample"]

#: The smallest and the largest value of n, k and mu.
_Box = Mapping[str, tuple[float, float]]

#: Fresh cases are drawn inside these ranges at most. The full self-consistent model converges in all of them: its edge
#: becomes too narrow beyond k = 0.8 at mu = 10, and the rest is wider than the box of the atlas.
REACH: _Box = {"n": (0.8, 10.0), "k": (0.0, 0.8), "mu": (0.005, 10.0)}

#: A fresh case differs from every standing one by this part of the reach in one of the parameters: by 0.09 in n, 0.008
#: in k or 8 % in mu. Most neighbouring standing values differ by more than twice that.
_APART = 0.01

#: A box has room if this share of it is apart from the standing cases: in a narrower one a model could be wrong
#: wherever no fresh case is drawn. Standing mu at one n and k differ by factors of 1.3 and more, which leaves half.
_ROOM, _DRAWN = 1.0 / 3.0, 300

#: Digits of the numbers that are drawn: a printed case is the exact one.
_DIGITS = 6


@dataclass(frozen=True, slots=True)
class Sample:
    """Fresh cases, and the standing cases in parts of the domain that have no room for fresh ones."""

    cases: tuple[Problem, ...]
    untested: frozenset[Problem]


def sample(
    gate: Gate,
    domain: Domain | None,
    standing: Sequence[Problem],
    avoided: Sequence[Problem],
    count: int,
    seed: list[int],
) -> Sample | None:
    """Draw cases for a gate from the domain of a model, or from between the standing cases where it states none.

    Parameters
    ----------
    gate : Gate
    domain : Domain or None
    standing : sequence of Problem
        Of the gate.
    avoided : sequence of Problem
        The cases that fresh ones are apart from.
    count : int
    seed : list of int

    Returns
    -------
    Sample or None
        None if the gate itself leaves no room, whatever the domain is.
    """
    coordinates = _coordinates(standing)
    hull = _box(coordinates.min(axis=0), coordinates.max(axis=0))
    largest_box = _limited(gate, hull if domain is None else {})
    if not _points(largest_box, avoided, 1, seed):
        return None
    spaces = [(largest_box, list(standing))]
    if domain is not None:
        spaces = [
            (_limited(gate, table.limits), [case for case in standing if table.within(case.numbers)])
            for table in domain.of_quantity(gate.quantity)
        ]
    cases: set[Problem] = set()
    untested = {case for case in standing if promised(domain, gate.quantity, case) is not False}
    shares = _shares([len(tested) for _, tested in spaces], count, seed)
    for number, ((box, tested), share) in enumerate(zip(spaces, shares, strict=True)):
        points = _points(box, avoided, share, [*seed, number])
        cases |= set(points[:share])
        untested -= {*tested} if points else set()
    return Sample(tuple(sorted(cases)), frozenset(untested))


def _limited(gate: Gate, box: _Box) -> _Box:
    """Return the part of a box that a gate is about and in which fresh cases are drawn."""
    limits = {name: (ends, box.get(name, ends), gate.cases.get(name, ends)) for name, ends in REACH.items()}
    return {name: (max(low for low, _ in ends), min(high for _, high in ends)) for name, ends in limits.items()}


def _points(box: _Box, avoided: Sequence[Problem], count: int, seed: list[int]) -> list[Problem]:
    """Return at least `count` cases of a box; none if hardly any of the box is apart from the cases to avoid."""
    if any(low > high for low, high in box.values()):
        return []
    # It takes a second to import.
    from scipy.stats import qmc

    (low, high), reach = (_even(np.array(list(ends.values())).T) for ends in (box, REACH))
    unit = qmc.Halton(len(box), seed=np.random.default_rng(seed)).random(max(_DRAWN, 3 * count))
    points = low + unit * (high - low)
    distance = np.abs(points[:, None] - _even(_coordinates(avoided))) / np.diff(reach, axis=0)
    is_apart = (distance.max(axis=2) >= _APART).all(axis=1)
    if is_apart.mean() < _ROOM:
        return []
    points[:, 2] = np.exp(points[:, 2])
    return [
        Problem.dimensionless(*(_rounded(value, ends) for value, ends in zip(point, box.values(), strict=True)))
        for point in points[is_apart]
    ]


def _coordinates(cases: Iterable[Problem]) -> NDArray[np.float64]:
    """Return n, k and mu of cases in three columns."""
    return np.array([[case.n, case.k, case.mu] for case in cases], dtype=float)


def _even(coordinates: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return n, k and ln(mu), in which points are drawn evenly."""
    return np.column_stack([coordinates[:, :2], np.log(coordinates[:, 2])])


def _box(low: NDArray[np.float64], high: NDArray[np.float64]) -> _Box:
    return {name: (float(low[index]), float(high[index])) for index, name in enumerate(REACH)}


def _rounded(value: float, ends: tuple[float, float]) -> float:
    return min(max(float(f"{value:.{_DIGITS}g}"), ends[0]), ends[1])


def _shares(sizes: Sequence[int], count: int, seed: list[int]) -> list[int]:
    """Return how many cases each box gets: the more, the more standing cases it has; by systematic sampling."""
    weights = np.cumsum([0, *(1 + size for size in sizes)])
    shifted = np.floor(np.random.default_rng(seed).random() + count * weights / max(weights[-1], 1))
    return [int(share) for share in np.diff(shifted)]
