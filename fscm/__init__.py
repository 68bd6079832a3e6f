"""The full self-consistent model of adhesive contact of power-law graded materials.

>>> from fscm import Problem, solve
>>> solution = solve(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
>>> round(solution.value, 8)
1.78848171

The public names are listed in `__init__.pyi`; a module is loaded when one of its names is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
