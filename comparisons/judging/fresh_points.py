"""Points of fresh cases: spread over the domain of a model or between standing cases, apart from these."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.data.contained_paths import path_inside
from comparisons.domain import Domain
from comparisons.judging.gates import Gate
from comparisons.problem import Problem
from comparisons.problem.problem import split_name
from comparisons.problem.variation import parse_variation, problems_of
from comparisons.runs.case_columns import unit_in

__all__ = ["REACH", "Sample", "problem_of_name", "sample"]

#: The smallest and the largest value of parameters or of varied keys.
_Box = Mapping[str, tuple[float, float]]

#: Dimensionless fresh cases are drawn inside these ranges at most. The full self-consistent model converges in all of
#: them: its edge becomes too narrow beyond k = 0.8 at mu = 10, and the rest is wider than the box of the atlas.
REACH: _Box = {"n": (0.8, 10.0), "k": (0.0, 0.8), "mu": (0.005, 10.0)}
#: Points are even in these parameters, and in the logarithm of the others where they are positive.
_LINEAR = ("n", "k")

#: A fresh case differs from every standing one by this part of `REACH`, or of the range of a varied key, in one of
#: them: by 0.09 in n, 0.008 in k or 8 % in mu. Most neighbouring standing values differ by more than twice that.
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


@dataclass(frozen=True, slots=True)
class _Space:
    """A box in which fresh cases are drawn, with the standing cases that they test and those that they avoid."""

    box: _Box
    scale: _Box
    standing: tuple[Problem, ...]
    avoided: tuple[Problem, ...]
    problem_at: Callable[[Mapping[str, float]], Problem]

    def points(self, count: int, seed: list[int]) -> list[dict[str, float]]:
        """Return points of the box, even if some are left out; none if it has hardly any that are apart."""
        if not self.box or any(low > high for low, high in self.box.values()):
            return []
        # It takes a second to import.
        from scipy.stats import qmc

        names = list(self.box)
        low, high = self._coordinates([{name: self.box[name][end] for name in names} for end in (0, 1)])
        unit = qmc.Halton(len(names), seed=np.random.default_rng(seed)).random(max(_DRAWN, 3 * count))
        points = low + unit * (high - low)
        ends = self._coordinates([{name: self.scale[name][end] for name in names} for end in (0, 1)])
        distance = np.abs(points[:, None] - self._coordinates([case.parameters for case in self.avoided]))
        apart = ((distance / np.diff(ends, axis=0)).max(axis=2) >= _APART).all(axis=1)
        return [self._point(point) for point in points[apart]] if apart.mean() >= _ROOM else []

    def _is_linear(self, name: str) -> bool:
        return name in _LINEAR or self.box[name][0] <= 0.0

    def _coordinates(self, points: Iterable[Mapping[str, Any]]) -> NDArray[np.float64]:
        rows = [
            [point[name] if self._is_linear(name) else math.log(point[name]) for name in self.box] for point in points
        ]
        return np.array(rows, dtype=float)

    def _point(self, coordinates: NDArray[np.float64]) -> dict[str, float]:
        point = {}
        for (name, (low, high)), at in zip(self.box.items(), coordinates, strict=True):
            value = at if self._is_linear(name) else math.exp(at)
            point[name] = min(max(float(f"{value:.{_DIGITS}g}"), low), high)
        return point


def sample(
    gate: Gate,
    domain: Domain | None,
    standing: Sequence[Problem],
    avoided: Sequence[Problem],
    count: int,
    seed: list[int],
) -> Sample | None:
    """Draw cases for a gate from the domain of a model, or from between the standing cases if it declares none.

    Those of problem files are drawn between the values of their varied keys.

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
    numbers = tuple(case for case in standing if case.is_dimensionless)
    taken = tuple(case for case in avoided if case.is_dimensionless)
    if numbers:
        frame = _limited(_hull(numbers, REACH) if domain is None else {}, gate)
        if not _of_numbers(frame, numbers, taken).points(1, seed):
            return None
    elif not standing:
        return None
    spaces = [*_spaces_of_numbers(gate, domain, numbers, taken), *_spaces_of_files(standing)]
    cases: list[Problem] = []
    untested = {
        case
        for case in standing
        if domain is None or not case.is_dimensionless or domain.contains(gate.quantity, case.numbers)
    }
    for number, (space, share) in enumerate(zip(spaces, _shares(spaces, count, seed), strict=True)):
        points = space.points(share, [*seed, number])
        cases += islice(_admissible(space, points), share)
        untested -= {*space.standing} if points else set()
    return Sample(tuple(sorted(dict.fromkeys(cases))), frozenset(untested))


def problem_of_name(name: str, folder: Path) -> Problem:
    """Return the problem of a name, as that of `comparisons.Problem`, from a problem file in a folder.

    Raises
    ------
    ValueError
        One sentence, if the file or the problem is not admissible.
    """
    file, *texts = split_name(name)
    (problem,) = problems_of(path_inside(folder, file), [parse_variation(text) for text in texts], file)
    return problem


def _spaces_of_numbers(
    gate: Gate, domain: Domain | None, standing: tuple[Problem, ...], avoided: tuple[Problem, ...]
) -> Iterator[_Space]:
    if domain is None and standing:
        yield _of_numbers(_limited(_hull(standing, REACH), gate), standing, avoided)
    for table in domain.of_quantity(gate.quantity) if domain and standing else ():
        box = _limited({name: table.ends(name) for name in REACH}, gate)
        yield _of_numbers(box, tuple(case for case in standing if table.within(case.numbers)), avoided)


def _of_numbers(box: _Box, standing: tuple[Problem, ...], avoided: tuple[Problem, ...]) -> _Space:
    return _Space(box, REACH, standing, avoided, lambda point: Problem.dimensionless(**point))


def _spaces_of_files(standing: Sequence[Problem]) -> Iterator[_Space]:
    """Yield the space of each file, and of each combination of its varied keys that are no numbers."""
    groups: dict[tuple[object, ...], list[Problem]] = {}
    for case in standing:
        if not case.is_dimensionless:
            words = [value for value in case.parameters.values() if isinstance(value, str)]
            groups.setdefault((split_name(case.name)[0], *case.parameters, *words), []).append(case)
    for _, group in sorted(groups.items(), key=lambda item: str(item[0])):
        hull = _hull(group, [name for name, value in group[0].parameters.items() if not isinstance(value, str)])
        box = {name: ends for name, ends in hull.items() if ends[0] < ends[1]}
        yield _Space(box, box, tuple(group), tuple(group), partial(_varied, group[0]))


def _varied(like: Problem, point: Mapping[str, float]) -> Problem:
    texts = []
    for column, value in {**like.parameters, **point}.items():
        key, unit = unit_in(column)
        texts.append(f"{key}={value}" if isinstance(value, str) or unit == "1" else f"{key}={value!r} {unit}")
    path, name = like.path or Path(), split_name(like.name)[0]
    (problem,) = problems_of(path, [parse_variation(text) for text in texts], name)
    return problem


def _admissible(space: _Space, points: list[dict[str, float]]) -> Iterator[Problem]:
    for point in points:
        try:
            yield space.problem_at(point)
        except ValueError:
            # Two keys may exclude each other, as the thickness of a coating and that of its transition.
            continue


def _shares(spaces: Sequence[_Space], count: int, seed: list[int]) -> list[int]:
    """Return how many cases each space gets: the more, the more standing cases it has; by systematic sampling."""
    weights = np.cumsum([0, *(1 + len(space.standing) for space in spaces)])
    shifted = np.floor(np.random.default_rng(seed).random() + count * weights / max(weights[-1], 1))
    return [int(share) for share in np.diff(shifted)]


def _hull(cases: Sequence[Problem], names: Iterable[str]) -> dict[str, tuple[float, float]]:
    values = {name: [float(case.parameters[name]) for case in cases] for name in names}
    return {name: (min(numbers), max(numbers)) for name, numbers in values.items()}


def _limited(box: _Box, gate: Gate) -> _Box:
    """Return the part of a box that the gate is about and in which fresh cases are drawn."""
    limits = {name: [reach, box.get(name, reach), gate.cases.get(name, reach)] for name, reach in REACH.items()}
    return {name: (max(low for low, _ in ends), min(high for _, high in ends)) for name, ends in limits.items()}
