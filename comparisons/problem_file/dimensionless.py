"""Problem of a file for the FSCM and the closed forms: dimensionless, with the unit of every scale."""

from __future__ import annotations

from collections.abc import Mapping

import fscm
from comparisons.problem_file.description import ProblemFile
from comparisons.problem_file.kinds import SECTIONS, kind_of
from fscm.problem import Problem

__all__ = ["dimensionless_problem", "physical_problem"]


def physical_problem(problem: ProblemFile) -> Problem:
    """Return the problem of a file for the FSCM, in SI.

    Raises
    ------
    ValueError
        If it is outside of what the FSCM admits.
    """
    parts = (getattr(problem, name) for name in SECTIONS)
    return Problem(*(kind_of(name, part.kind).build(fscm, part) for name, part in zip(SECTIONS, parts, strict=True)))


def dimensionless_problem(problem: ProblemFile) -> tuple[Problem, Mapping[str, float]]:
    """Return the dimensionless problem of a file for the FSCM, and the units of its results in SI.

    Returns
    -------
    problem : Problem
    units : mapping of str to float
        As `Problem.units`.

    Raises
    ------
    ValueError
        As `physical_problem`.

    Examples
    --------
    >>> from pathlib import Path
    >>> from comparisons.problem_file.description import Section
    >>> solid = Section("power-law", {"E0": 70e9, "c0": 1.0, "k": 0.0, "nu": 0.2})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> posed, units = dimensionless_problem(ProblemFile(Path("a"), solid, Section("sphere", {"R": 1e-6}), law))
    >>> round(posed.mu, 6), units["displacement"]
    (0.259204, 3e-10)
    """
    physical = physical_problem(problem)
    return physical.dimensionless, physical.units
