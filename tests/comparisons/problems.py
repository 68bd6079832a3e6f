"""Problems of a sphere in SI."""

from comparisons.problem import Problem, Section


def on_solid(kind, values, R=1e-7):
    """A sphere on a solid, by the 9-3 law."""
    law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    return Problem(Section(kind, values), Section("sphere", {"R": R}), law)
