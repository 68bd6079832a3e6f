"""The full self-consistent model of adhesive contact of power-law graded materials.

>>> from fscm import Problem, solve
>>> solution = solve(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
>>> round(solution.value, 8)
1.78848171

What a solver of an equilibrium path must have, and where it is:

1. a mesh of the surface that adapts to the pressure: `_surface.mesh`, `_surface.adaptivity`;
2. the response of the bodies to the pressure on it, and to that beyond it: `_surface.kernel`, `_surface.deformation`
   and `_surface.response`, `_surface.tail`;
3. an equation: a state, its residual with the exact tangent, Newton's method: `_surface.state`,
   `_surface.linearisation`, `_surface.newton`;
4. a continuation from far separation to an end: `_path.continuation`, `_path.ends`;
5. completeness, a proof that no turning point is missed between two points: `_path.completeness`;
6. events as roots of exact rates, and the jumps between stable branches: `_path.events`, `_path.jumps`;
7. a bound of the error of every value by its causes: `_bound.defect`, `_bound.parts`;
8. quantities, each a row that names its event and its functional: `quantities`; `analysis` computes them by 1 to 7.

The names of the package are listed in `_lazy.pyi`; a module is loaded when one of its names is first used.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import lazy_loader

if TYPE_CHECKING:
    from fscm._lazy import *

__getattr__, _, __all__ = lazy_loader.attach_stub(__name__, str(Path(__file__).with_name("_lazy.pyi")))


def __dir__() -> list[str]:
    return __all__
