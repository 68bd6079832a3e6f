"""Values of a problem whose size suggests that a unit was forgotten."""

from __future__ import annotations

from typing import Any

from comparisons.problem import Problem

#: Smallest and largest usual value of what has a unit, in SI: from moduli of the softest gels to ten times that of
#: diamond, lengths from the smoothing of a profile (1 pm) to metres, works of adhesion up to twice those of metals,
#: which are below 5 J/m^2.
_USUAL = {"Pa": (100.0, 1e13), "m": (5e-13, 1.0), "J/m^2": (1e-7, 10.0)}


def unusual_sizes(problem: Problem) -> list[dict[str, Any]]:
    """Return key, value and unit of what has an unusual size.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    >>> pad = Section("homogeneous", {"E": 1e9, "nu": 0.4})
    >>> unusual_sizes(Problem(pad, Section("sphere", {"R": 20.0}), law))
    [{'key': 'punch.R', 'value': 20.0, 'unit': 'm'}]
    """
    unusual = []
    for key in problem.numbers_of_sections:
        unit, value = problem.form(key).unit, problem[key]
        low, high = _USUAL.get(unit, (0.0, 0.0))
        if value and high and not low <= abs(value) <= high:
            unusual.append({"key": key, "value": value, "unit": unit})
    return unusual
