"""What a fit may change: keys of a problem file and the zeros of a record."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from comparisons.data.validation import known_name, shown
from comparisons.problem import Problem
from comparisons.problem.kinds import KINDS, known_word, meant
from comparisons.problem.uncertain import Uncertainty

#: Largest logarithm of a share of the value of the file: seventeen powers of ten.
_WIDEST = 40.0


@dataclass(frozen=True)
class Key:
    """A key of a problem file that is fitted: by the logarithm of its share of the value of the file, or as it is.

    Attributes
    ----------
    name : str
        As "solid.E0".
    unit : str
        In SI; "1" for a number.
    start : float
        The value of the file.
    logarithmic : bool
        Whether the value is positive without an upper limit.
    limits : tuple of float
        Ends of the admissible values, or of the interval of the file.
    prior : Uncertainty or None
        The standard deviation of the file.
    """

    name: str
    unit: str
    start: float
    logarithmic: bool
    limits: tuple[float, float]
    prior: Uncertainty | None

    def value(self, number: float) -> float:
        """Return the value of a fitted number, which is 0 at the start."""
        if not self.logarithmic:
            return self.start + number
        return self.start * math.exp(min(max(number, -_WIDEST), _WIDEST))

    def number(self, value: float) -> float:
        """Return the number of a value."""
        if not self.logarithmic:
            return value - self.start
        return math.log(value / self.start) if value > 0.0 else -math.inf

    def uncertainty(self, value: float, deviation: float) -> float:
        """Return the standard deviation of a value by that of its number."""
        return abs(value) * deviation if self.logarithmic else deviation

    @property
    def deviation(self) -> float | None:
        """Standard deviation of the number by the file; None if it states none."""
        if self.prior is None or self.prior.is_interval:
            return None
        return self.prior.size / self.start if self.logarithmic else self.prior.size


def free_keys(problem: Problem, names: Sequence[str]) -> list[Key]:
    """Return the keys that are to be fitted.

    Raises
    ------
    ValueError
        One sentence, if a name is unknown, twice there, or no number.
    """
    if not names or len(set(names)) < len(names):
        raise ValueError(f"--free {' '.join(names)}: name each key once, as law.work_of_adhesion solid.E0")
    return [_key(problem, name) for name in names]


def uncertain_keys(problem: Problem, free: Sequence[Key]) -> list[Key]:
    """Return the other keys to which the file gives a standard deviation or an interval."""
    names = {key.name for key in free}
    return [_key(problem, name) for name in problem.uncertain if name not in names]


def _key(problem: Problem, name: str) -> Key:
    section, _, key = name.partition(".")
    where = f"--free {shown(name)}"
    if section not in KINDS and not key and (full := _full_names(problem, name)):
        raise ValueError(f"{where} names no section: did you mean {' or '.join(full)}?")
    known_name("section", section, KINDS, where)
    known_word("key", key, problem.section(section).values, where)
    start = problem[name]
    if not isinstance(start, float | int):
        raise ValueError(f"{where}: it is not a number of the file; only numbers can be fitted")
    form, prior = problem.form(name), problem.uncertain.get(name)
    limits = form.low, form.high
    if prior is not None and prior.is_interval:
        limits = prior.limits(start)
    logarithmic = start > 0.0 and math.isinf(form.high)
    return Key(name, form.unit or "1", float(start), logarithmic, limits, prior)


def _full_names(problem: Problem, name: str) -> list[str]:
    """The numbers of a problem whose key has a name, perhaps that of another program."""
    keys = {full: full.partition(".")[2] for full in problem.numbers_of_sections}
    searched = name if name in keys.values() else meant(name, keys.values())
    return [full for full, key in keys.items() if key == searched]


def changed(problem: Problem, keys: Sequence[Key], numbers: Mapping[str, float]) -> Problem:
    """Return the problem with the values of fitted numbers, by the names of the keys."""
    for key in keys:
        problem = problem.with_value(key.name, key.value(numbers[key.name]))
    return problem
