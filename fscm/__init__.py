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

The names in `__all__` of the modules of solids, punches and laws are names of the package, too.  `_lazy.pyi` lists the
others; a module is loaded when one of its names is first used.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import lazy_loader

from fscm import (
    cohesive_laws,
    custom_punch,
    custom_solid,
    dlvo,
    laws,
    layers,
    measured_punch,
    punch,
    solids,
    tabulated_law,
    tabulated_modulus,
)
from fscm.cohesive_laws import *
from fscm.custom_punch import *
from fscm.custom_solid import *
from fscm.dlvo import *
from fscm.laws import *
from fscm.layers import *
from fscm.measured_punch import *
from fscm.punch import *
from fscm.solids import *
from fscm.tabulated_law import *
from fscm.tabulated_modulus import *

if TYPE_CHECKING:
    from fscm._lazy import *

__getattr__, _, __all__ = lazy_loader.attach_stub(__name__, str(Path(__file__).with_name("_lazy.pyi")))
_STATED = (
    cohesive_laws,
    custom_punch,
    custom_solid,
    dlvo,
    laws,
    layers,
    measured_punch,
    punch,
    solids,
    tabulated_law,
    tabulated_modulus,
)
__all__ += [name for module in _STATED for name in module.__all__]


def __dir__() -> list[str]:
    return __all__
