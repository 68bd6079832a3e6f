"""Fresh cases of problem files: the numbers of their varied keys are drawn between those of the standing cases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from comparisons.data.contained_paths import path_inside
from comparisons.problem import Problem
from comparisons.problem.problem import split_name
from comparisons.problem.variation import parse_variation, problems_of
from comparisons.runs.case_columns import unit_in

__all__ = ["case_of_label", "fresh_problems"]

#: A fresh case differs from every standing one by this part of the range of some key.
_APART = 0.01

#: So often a case is drawn again that is beside a standing one, or that a file does not admit.
_ATTEMPTS = 64

#: Digits of the numbers that are drawn: a printed case is the exact one.
_DIGITS = 6


def fresh_problems(standing: Sequence[Problem], count: int, seed: list[int]) -> tuple[Problem, ...]:
    """Draw cases for a gate on problem files, the same number of each file.

    A key with numbers is drawn between the smallest and the largest one, in their logarithm where all are positive; a
    key with texts has one of these.

    Parameters
    ----------
    standing : sequence of Problem
        Of the gate, each of a problem file.
    count : int
    seed : list of int

    Returns
    -------
    tuple of Problem
        None of a file whose standing cases have no key with two numbers, and as many fewer.
    """
    of_file: dict[tuple[str, ...], list[Problem]] = {}
    for case in standing:
        if not case.is_dimensionless:
            of_file.setdefault((split_name(case.name)[0], *case.parameters), []).append(case)
    drawn: list[Problem] = []
    for number, (key, problems) in enumerate(sorted(of_file.items())):
        share = (count * (number + 1)) // len(of_file) - (count * number) // len(of_file)
        drawn += _drawn(problems, list(key[1:]), share, np.random.default_rng([*seed, number]))
    return tuple(sorted(dict.fromkeys(drawn)))


def case_of_label(label: str, folder: Path) -> Problem:
    """Return the case of a label, as that of `comparisons.Problem`, from a problem file in a folder.

    Raises
    ------
    ValueError
        One sentence, if the file or the problem is not admissible.
    """
    name, *texts = split_name(label)
    return _case(path_inside(folder, name), name, texts)


def _case(path: Path, name: str, texts: Sequence[str]) -> Problem:
    (problem,) = problems_of(path, [parse_variation(text) for text in texts], name)
    return problem


def _drawn(problems: list[Problem], keys: list[str], count: int, generator: np.random.Generator) -> list[Problem]:
    ends = {key: _ends(problems, key) for key in keys}
    drawn: list[Problem] = []
    if all(end is None for end in ends.values()):
        return drawn
    name, path = split_name(problems[0].name)[0], problems[0].path or Path()
    for _ in range(_ATTEMPTS * count):
        like = problems[int(generator.integers(len(problems)))]
        values = {key: _value(like, key, ends[key], float(generator.random())) for key in keys}
        if not all(_is_apart(values, one, ends) for one in problems):
            continue
        try:
            drawn.append(_case(path, name, [_text(key, value) for key, value in values.items()]))
        except ValueError:
            # Two keys may exclude each other, as the thickness of a coating and that of its transition.
            continue
        if len(drawn) == count:
            break
    return drawn


def _ends(problems: list[Problem], key: str) -> tuple[float, float] | None:
    """The smallest and the largest number of a key, None if it has not two."""
    values = [one.parameters[key] for one in problems]
    numbers = [value for value in values if not isinstance(value, str)]
    return (min(numbers), max(numbers)) if len(set(numbers)) > 1 else None


def _value(like: Problem, key: str, ends: tuple[float, float] | None, share: float) -> float | str:
    if ends is None:
        return like.parameters[key]
    low, high = ends
    value = low * (high / low) ** share if low > 0.0 else low + (high - low) * share
    return min(max(float(f"{value:.{_DIGITS}g}"), low), high)


def _is_apart(
    values: Mapping[str, float | str], known: Problem, ends: Mapping[str, tuple[float, float] | None]
) -> bool:
    for key, value in values.items():
        there, range_of = known.parameters[key], ends[key]
        if isinstance(value, str) or isinstance(there, str):
            if value != there:
                return True
        elif range_of is not None and abs(value - there) >= _APART * (range_of[1] - range_of[0]):
            return True
    return False


def _text(column: str, value: float | str) -> str:
    key, unit = unit_in(column)
    return f"{key}={value}" if isinstance(value, str) or unit == "1" else f"{key}={value!r} {unit}"
