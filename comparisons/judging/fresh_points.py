"""Points of fresh cases: drawn from the domain of a model, apart from the standing cases."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.domain import Domain
from comparisons.judging.gates import Gate
from comparisons.problem import Problem
from comparisons.runs.parameter_sets import latin_hypercube

__all__ = ["REACH", "Sample", "sample"]

#: Fresh cases are drawn inside these ranges at most.  The full self-consistent model converges in all of them: its edge
#: becomes too narrow beyond k = 0.8 at mu = 10, and the rest is wider than the box of the atlas.
REACH = {"n": (0.8, 10.0), "k": (0.0, 0.8), "mu": (0.005, 10.0)}

#: A fresh case differs from every standing one by this part of `REACH` in n, k or the logarithm of mu: by 0.09, 0.008
#: or 8 %.  Most neighbouring standing values differ by more than twice that, so that there is room between them.
_APART = 0.01

#: A range has room if this share of it is apart from the standing cases: in a narrower one a model could be wrong
#: wherever no fresh case is drawn.  Standing mu at one n and k differ by factors of 1.3 and more, which leaves half.
_ROOM, _DRAWN = 1.0 / 3.0, 300

#: So often cases beside a standing one are drawn again.
_ATTEMPTS = 64

#: The smallest and the largest n, k and mu.
_Box = dict[str, tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Sample:
    """Fresh cases, and the standing cases in parts of the domain that have no room for fresh ones."""

    cases: tuple[Problem, ...]
    untested: frozenset[Problem]


def sample(
    gate: Gate,
    domain: Domain | None,
    standing: Sequence[Problem],
    known: Sequence[Problem],
    count: int,
    seed: list[int],
) -> Sample | None:
    """Draw cases for a gate from the domain of a model, or from between the standing cases if it declares none.

    Parameters
    ----------
    gate : Gate
    domain : Domain or None
    standing : sequence of Problem
        Of the gate.
    known : sequence of Problem
        The cases that fresh ones are apart from.
    count : int
    seed : list of int

    Returns
    -------
    Sample or None
        None if the gate itself leaves no room, whatever the domain is.
    """
    if not standing:
        return None
    frame = _limited(_hull(standing) if domain is None else {}, gate)
    if not _points(frame, 1, known, seed):
        return None
    if domain is None:
        boxes = [(frame, list(standing))]
    else:
        tables = domain.of_quantity(gate.quantity)
        boxes = [
            (
                _limited({name: table.ends(name) for name in REACH}, gate),
                [case for case in standing if table.within(case.parameters)],
            )
            for table in tables
        ]
    cases: list[Problem] = []
    untested = {case for case in standing if domain is None or domain.contains(gate.quantity, case.parameters)}
    for number, ((box, promised), share) in enumerate(zip(boxes, _shares(boxes, count, seed), strict=True)):
        points = _points(box, max(share, 1), known, [*seed, number])
        cases += points[:share]
        untested -= {*promised} if points else set()
    return Sample(tuple(dict.fromkeys(cases)), frozenset(untested))


def _hull(cases: Sequence[Problem]) -> _Box:
    values = {name: [getattr(case, name) for case in cases] for name in REACH}
    return {name: (min(found), max(found)) for name, found in values.items()}


def _limited(box: Mapping[str, tuple[float, float]], gate: Gate) -> _Box:
    """Return the part of a box that the gate is about and in which fresh cases are drawn."""
    limits = {name: [reach, box.get(name, reach), gate.cases.get(name, reach)] for name, reach in REACH.items()}
    return {name: (max(low for low, _ in ends), min(high for _, high in ends)) for name, ends in limits.items()}


def _shares(boxes: Sequence[tuple[_Box, list[Problem]]], count: int, seed: list[int]) -> list[int]:
    """Return how many cases each box gets: the more, the more standing cases it has; by systematic sampling."""
    weights = np.cumsum([0, *(1 + len(promised) for _, promised in boxes)])
    shifted = np.floor(np.random.default_rng(seed).random() + count * weights / max(weights[-1], 1))
    return [int(share) for share in np.diff(shifted)]


def _points(box: _Box, count: int, known: Sequence[Problem], seed: list[int]) -> list[Problem]:
    """Return fresh cases of a box, fewer than `count` if it has hardly any."""
    points: list[Problem] = []
    if any(low > high for low, high in box.values()) or not _has_room(box, known, seed):
        return points
    for attempt in range(_ATTEMPTS):
        table = {"count": count - len(points), "seed": [*seed, attempt], **box}
        drawn = [Problem.dimensionless(*point) for point in latin_hypercube(table, "fresh cases")]
        points += [case for case, apart in zip(drawn, _are_apart(drawn, known), strict=True) if apart]
        if len(points) == count:
            break
    return points


def _has_room(box: _Box, known: Sequence[Problem], seed: list[int]) -> bool:
    drawn = latin_hypercube({"count": _DRAWN, "seed": [*seed, _ATTEMPTS], **box}, "fresh cases")
    return float(np.mean(_are_apart([Problem.dimensionless(*point) for point in drawn], known))) >= _ROOM


def _are_apart(cases: Sequence[Problem], known: Sequence[Problem]) -> NDArray[np.bool_]:
    distances = np.abs(_coordinates(cases)[:, None] - _coordinates(known)) / np.diff(_coordinates(_CORNERS), axis=0)
    return np.asarray((distances.max(axis=2) >= _APART).all(axis=1))


def _coordinates(cases: Sequence[Problem]) -> NDArray[np.float64]:
    return np.array([(case.n, case.k, math.log(case.mu)) for case in cases])


_CORNERS = tuple(Problem.dimensionless(*corner) for corner in zip(*REACH.values(), strict=True))
