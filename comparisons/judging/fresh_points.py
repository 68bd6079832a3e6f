"""Points of fresh cases: spread over the domain of a model or between standing cases, apart from these."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import groupby, islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from comparisons.domain import NO_LIMITS, Domain
from comparisons.judging.gates import Gate
from comparisons.judging.selection import promised
from comparisons.model import HasSkip
from comparisons.problem import Problem
from comparisons.problem.problem import split_name
from comparisons.problem.variation import parse_variations, problems_of
from comparisons.runs.frames import unit_in

#: The smallest and the largest value of parameters.
_Box = Mapping[str, tuple[float, float]]

#: Fresh cases are drawn inside these ranges at most. The full self-consistent model converges in all of them: its edge
#: becomes too narrow beyond k = 0.8 at mu = 10, and the rest is wider than the box of the atlas. Other parameters, the
#: varied keys of problem files, reach as far as their standing values.
REACH: _Box = {"n": (0.8, 10.0), "k": (0.0, 0.8), "mu": (0.005, 10.0)}
#: Points are even in these parameters, and in the logarithm of the others where they are positive.
_LINEAR = ("n", "k")

#: A fresh case differs from every standing one by this part of the reach in one of the parameters: by 0.09 in n, 0.008
#: in k or 8 % in mu. Most neighbouring standing values differ by more than twice that.
_APART = 0.01

#: A box has room if this share of it is apart from the standing cases: in a narrower one a model could be wrong
#: wherever no fresh case is drawn. Standing mu at one n and k differ by factors of 1.3 and more, which leaves half.
_ROOM, _DRAWN = 1.0 / 3.0, 300

#: Digits of the numbers that are drawn: a printed case is the exact one.
_DIGITS = 6


def sample(
    gate: Gate,
    taken: HasSkip | None,
    standing: Sequence[Problem],
    avoided: Sequence[Problem],
    count: int,
    seed: list[int],
) -> tuple[list[Problem], set[Problem]] | None:
    """Draw cases for a gate from what a model takes, or from between the standing cases where it does not state it.

    Parameters
    ----------
    gate : Gate
    taken : HasSkip or None
        As of `promised`.
    standing : sequence of Problem
        Of the gate.
    avoided : sequence of Problem
        The cases that fresh ones are apart from.
    count : int
    seed : list of int

    Returns
    -------
    cases, untested
        Fresh cases, and the standing cases in parts of the domain that have none, for lack of room or since there are
        more parts than cases; None if the gate itself leaves no room, whatever the domain is.
    """
    groups = groupby(sorted(standing, key=_family_of), _family_of)
    families = [_Family(gate, list(cases), avoided) for _, cases in groups]
    if all(family.reach and not family.points(family.frame(taken), 1, seed) for family in families):
        return None
    boxes = [(family, *space) for family in families for space in family.boxes(taken)]
    drawn = [family.points(box, count, [*seed, number]) for number, (family, box, _) in enumerate(boxes)]
    spaces = [(family, tested, points) for (family, _, tested), points in zip(boxes, drawn, strict=True) if points]
    cases: list[Problem] = []
    untested = {case for case in standing if promised(taken, gate.quantity, case) is not False}
    shares = _shares([len(tested) for _, tested, _ in spaces], count, seed)
    for (family, tested, points), share in zip(spaces, shares, strict=True):
        problems = (case for case in family.problems_at(points) if promised(taken, gate.quantity, case) is not False)
        fresh = list(islice(problems, share))
        cases += fresh
        untested -= {*tested} if fresh else set()
    return sorted(dict.fromkeys(cases)), untested


def _numbers(case: Problem) -> dict[str, float]:
    """Return the parameters that fresh cases vary; Poisson's ratio is left to the models."""
    return {
        name: float(value) for name, value in case.parameters.items() if name != "nu" and not isinstance(value, str)
    }


def _family_of(case: Problem) -> tuple[str, ...]:
    """Return what the cases of a family have in common: their file, and their varied keys that are not numbers."""
    words = (f"{name}={value}" for name, value in case.parameters.items() if isinstance(value, str))
    return split_name(case.name)[0], *_numbers(case), *words


class _Family:
    """Standing cases of a gate that differ in numbers alone, and the cases that fresh ones are apart from.

    `reach` has the parameters in which fresh cases can differ, with the ends of the ranges in which they are drawn.
    """

    def __init__(self, gate: Gate, standing: list[Problem], avoided: Iterable[Problem]) -> None:
        self._gate, self._standing = gate, standing
        self._avoided = [_numbers(case) for case in avoided if _family_of(case) == _family_of(standing[0])]
        values = {name: [_numbers(case)[name] for case in standing] for name in _numbers(standing[0])}
        self._hull: _Box = {name: (min(numbers), max(numbers)) for name, numbers in values.items()}
        reach = {name: REACH.get(name, ends) for name, ends in self._hull.items()}
        self.reach: _Box = {name: ends for name, ends in reach.items() if ends[0] < ends[1]}

    def frame(self, taken: HasSkip | None) -> _Box:
        """Return the largest box that the gate leaves to any model, or to those that do not state what they take."""
        return self._limited(self._hull if taken is None else {})

    def boxes(self, taken: HasSkip | None) -> Iterator[tuple[_Box, list[Problem]]]:
        """Yield the boxes in which fresh cases are drawn, each with the standing cases that they test."""
        # It restricts n, k and mu alone.
        if taken is None or not self.reach.keys() & REACH.keys():
            yield self.frame(None), self._standing
            return
        if not isinstance(taken, Domain):
            yield self._around([case for case in self._standing if promised(taken, self._gate.quantity, case)])
            return
        for table in taken.of_quantity(self._gate.quantity):
            tested = [case for case in self._standing if table.within(case.parameters)]
            yield self._limited({name: table.limits.get(name, NO_LIMITS) for name in self.reach}), tested

    def points(self, box: _Box, count: int, seed: list[int]) -> list[dict[str, float]]:
        """Return points of a box, even if some are left out; none if it has hardly any that are apart."""
        if not box or any(low > high for low, high in box.values()):
            return []
        # It takes a second to import.
        from scipy.stats import qmc

        is_log = np.array([name not in _LINEAR and low > 0.0 for name, (low, _) in box.items()])

        def coordinates(values: Sequence[Sequence[float]]) -> NDArray[np.float64]:
            return np.where(is_log, np.log(np.where(is_log, values, 1.0)), values)

        low, high = coordinates([*zip(*box.values(), strict=True)])
        least, largest = coordinates([*zip(*(self.reach[name] for name in box), strict=True)])
        avoided = coordinates([[case[name] for name in box] for case in self._avoided])
        unit = qmc.Halton(len(box), seed=np.random.default_rng(seed)).random(max(_DRAWN, 3 * count))
        points = low + unit * (high - low)
        distance = np.abs(points[:, None] - avoided) / (largest - least)
        apart = (distance.max(axis=2) >= _APART).all(axis=1)
        values = np.where(is_log, np.exp(np.where(is_log, points, 0.0)), points)[apart]
        drawn = [dict(zip(box, map(_rounded, point, box.values()), strict=True)) for point in values]
        return drawn if apart.mean() >= _ROOM else []

    def problems_at(self, points: Iterable[Mapping[str, float]]) -> Iterator[Problem]:
        """Yield the problem at each point that has one: two keys may exclude each other."""
        for point in points:
            with suppress(ValueError):
                yield _problem_at(self._standing[0], point)

    def _around(self, tested: list[Problem]) -> tuple[_Box, list[Problem]]:
        """Return a box about standing cases: a parameter in which they differ is drawn from all of its reach."""
        values = {name: {_numbers(case)[name] for case in tested} for name in self.reach}
        one_value = {name: (min(numbers), max(numbers)) for name, numbers in values.items() if len(numbers) == 1}
        return (self._limited(one_value) if tested else {}), tested

    def _limited(self, box: _Box) -> _Box:
        """Return the part of a box that the gate is about and in which fresh cases are drawn."""
        limits = {
            name: [ends, box.get(name, ends), self._gate.cases.get(name, ends)] for name, ends in self.reach.items()
        }
        return {name: (max(low for low, _ in ends), min(high for _, high in ends)) for name, ends in limits.items()}


def _rounded(value: float, ends: tuple[float, float]) -> float:
    return min(max(float(f"{value:.{_DIGITS}g}"), ends[0]), ends[1])


def _problem_at(like: Problem, point: Mapping[str, float]) -> Problem:
    if like.path is None:
        return Problem.dimensionless(**point)
    texts = []
    for column, value in {**like.parameters, **point}.items():
        key, unit = unit_in(column)
        texts.append(f"{key}={value}" if isinstance(value, str) or unit == "1" else f"{key}={value!r} {unit}")
    return named_problem(like.path, [split_name(like.name)[0], *texts])


def named_problem(path: Path, name: Sequence[str]) -> Problem:
    """Return the problem of a file whose name, as of `split_name`, has the values of its keys."""
    (problem,) = problems_of(path, parse_variations(name[1:]), name[0])
    return problem


def _shares(sizes: Sequence[int], count: int, seed: list[int]) -> list[int]:
    """Return how many cases each box gets: the more, the more standing cases it has; by systematic sampling.

    One with standing cases gets one at least, as long as another has one to spare.
    """
    weights = np.cumsum([0, *(1 + size for size in sizes)])
    shifted = np.floor(np.random.default_rng(seed).random() + count * weights / max(weights[-1], 1))
    shares = np.diff(shifted).astype(int)
    needed = np.array(sizes, dtype=int).clip(max=1)
    for box in np.flatnonzero(shares < needed):
        spare = shares - needed
        if spare.max() > 0:
            shares[spare.argmax()] -= 1
            shares[box] += 1
    return [int(share) for share in shares]
