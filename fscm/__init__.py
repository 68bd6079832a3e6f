"""The full self-consistent model of adhesive contact of power-law graded materials.

The short way in: describe the problem, ask for a quantity.

>>> from fscm import Problem, solve
>>> answer = solve(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
>>> round(answer.value, 8)
1.78848171
"""

from fscm.analysis import Analysis, Solution
from fscm.control import EquilibriumState, equilibria
from fscm.errors import NoSuchEvent, NotConverged
from fscm.path import EquilibriumPath, SurfaceProfiles, profiles, trace
from fscm.problem import Problem
from fscm.solve import QUANTITIES, solve

__all__ = [
    "QUANTITIES",
    "Analysis",
    "EquilibriumPath",
    "EquilibriumState",
    "NoSuchEvent",
    "NotConverged",
    "Problem",
    "Solution",
    "SurfaceProfiles",
    "equilibria",
    "profiles",
    "solve",
    "trace",
]
