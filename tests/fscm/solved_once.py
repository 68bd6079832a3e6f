"""Analyses and traced paths that several tests need, each computed once."""

from functools import cache

import numpy as np

from fscm import Analysis, Coating, CustomPunch, LennardJones, PowerPunch, Problem, trace

analysis_of, path_of = cache(Analysis), cache(trace)

#: A tall asperity on a flat paraboloid.
ASPERITY = CustomPunch(lambda r: -8 * np.expm1(-(r**2)) + r**2 / 50, growth=2)

#: A sphere on a stiff coating of a soft solid, in SI units: radius, work of adhesion, range of the law, substrate.
R, WORK, Z0 = 5e-6, 0.05, 0.4e-9
SUBSTRATE = 1.5e6, 0.49


def contact(solid, z0=Z0):
    """Dimensionless problem of the sphere, and the unit of its radii."""
    problem = Problem(solid, PowerPunch(n=2, Q=R), LennardJones(WORK, z0))
    return problem.dimensionless, problem.units["radius"]


@cache
def stiff_on_soft(E=1e9, thickness=100e-9):
    """Analysis of the sphere on the coating, and the unit of the radii."""
    problem, unit = contact(Coating(E, SUBSTRATE[0], thickness, 0.0, 0.4, SUBSTRATE[1]))
    return Analysis(problem, "quick"), unit
