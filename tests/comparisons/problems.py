"""Problems of a sphere in SI."""

from comparisons.problem import Problem, Section


def on_solid(kind, values, columns=None, *, R=1e-7, punch="sphere", work=0.05, z0=4e-10):
    """A sphere on a solid, by the 9-3 law."""
    law = Section("lennard-jones-9-3", {"work_of_adhesion": work, "z0": z0})
    return Problem(Section(kind, values, columns or {}), Section(punch, {"R": R}), law)
