"""Checks of a problem file as a whole: scales that fit together, and a profile that reaches beyond the contact."""

from __future__ import annotations

import fscm
from comparisons.problem.kinds import kind_of
from comparisons.problem.problem import Problem
from comparisons.problem.source import Source
from fscm.punch import unit_of_radii

__all__ = ["check_consistency"]

#: Largest and smallest admissible ratio of the radius of the punch to the range of the law.  A lens of 10 m
#: and a range of 0.2 nm give 5e10; a tip with a radius far below an atom has no meaning.
_RATIOS = 1e-3, 1e12


def check_consistency(problem: Problem, source: Source) -> None:
    """Refuse a problem whose parts do not fit together.

    Raises
    ------
    ValueError
        One sentence with file, line, value and remedy.
    """
    try:
        z0 = kind_of("law", problem.law.kind).build(fscm, problem.law).z0
    except ValueError as error:
        raise source.refusal("law", None, f"{error}; correct the values") from None
    try:
        n, Q = unit_of_radii(kind_of("punch", problem.punch.kind).build(fscm, problem.punch), z0)
    except ValueError as error:
        raise ValueError(f"{source.path}: {error}; check the values and their units") from None
    # Q of a cone is a slope: it has no scale.
    radius = Q ** (1.0 / (n - 1.0)) if n > 1.0 else z0
    low, high = _RATIOS
    if not low <= radius / z0 <= high:
        key = next((key for key in ("R", "Q", "file") if key in problem.punch.values), None)
        raise source.refusal(
            "punch",
            key,
            f"the length {radius:.3g} m of the punch is {radius / z0:.1e} times the range {z0:.3g} m of the law, "
            f"outside [{low:g}, {high:g}]; check the units of both",
        )
    try:
        mu, reach = problem.posed.mu, problem.units["displacement"]
    except ValueError as error:
        raise ValueError(f"{source.path}: {error}; check the values and their units") from None
    if problem.punch.kind == "table":
        # At pull-off the height of the shape at the contact edge is about mu z0 (1.2 times that for a sphere, by JKR),
        # and the law reaches further by its own range.
        height = problem.punch.columns["height"][-1] - problem.punch.columns["height"][0]
        needed = (1.0 + mu) * reach
        if height < needed:
            raise source.refusal(
                "punch",
                "file",
                f"the profile {problem.punch['file']} ends at the height {height:.3g} m inside the contact, which "
                f"reaches about {needed:.3g} m; measure it further out",
            )
