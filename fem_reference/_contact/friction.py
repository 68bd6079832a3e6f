"""Friction between solid and punch: none, or a surface whose points keep their radius.

The bond is u_r = 0 along the whole surface, inside and outside the contact, so that the solid stays linear.  A bond of
the part in contact alone is less stiff: its displacements are a larger set, and those without friction a still larger
one.  In this order the elastic energy at a given displacement of the surface falls.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from fem_reference.problem import Problem
from fem_reference.solid import ScaledSolid

__all__ = ["FrictionName", "with_friction"]

FrictionName = Literal["none", "bonded"]


def with_friction(problem: Problem, friction: FrictionName) -> Problem:
    """Return the problem with the friction of its surfaces.

    Raises
    ------
    ValueError
        If the name is unknown, or two elastic bodies are to be bonded.
    """
    if friction not in ("none", "bonded"):
        raise ValueError(f"friction {friction!r} is unknown; choose 'none' or 'bonded'")
    # What is no problem is refused where it is solved.
    if friction == "none" or not isinstance(problem, Problem):
        return problem
    if problem.punch_solid is not None:
        raise ValueError(
            "friction 'bonded' needs a rigid punch: points of two elastic bodies move together along the surface and "
            "do not keep their radius; leave out punch_solid, or take friction 'none'"
        )
    return replace(problem, solid=ScaledSolid(problem.solid, bonded=True))
