"""An independent axisymmetric finite-element model of adhesive contact of graded materials.

Physical quantities in any consistent units: a half-space with Young's modulus E(z) and Poisson's ratio nu(z), a
rigid punch f(r), a surface law p(H).  The solid is meshed with high-order elements and closed by the exact
stiffness of the infinite exterior.  The equilibrium path is traced on the system condensed to the surface; a value is
that of the whole system at an event, solved by Newton's method with conjugate gradients and pyamg.

The names in `__all__` of the modules of solids, punches and laws are names of the package, too.  `_lazy.pyi` lists the
others; a module is loaded when one of its names is first used.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import lazy_loader

from fem_reference import laws, profiles, punch, solids, tabulated_law
from fem_reference.laws import *
from fem_reference.profiles import *
from fem_reference.punch import *
from fem_reference.solids import *
from fem_reference.tabulated_law import *

if TYPE_CHECKING:
    from fem_reference._lazy import *

__getattr__, _, __all__ = lazy_loader.attach_stub(__name__, str(Path(__file__).with_name("_lazy.pyi")))
_STATED = (laws, profiles, punch, solids, tabulated_law)
__all__ += [name for module in _STATED for name in module.__all__]


def __dir__() -> list[str]:
    return __all__
