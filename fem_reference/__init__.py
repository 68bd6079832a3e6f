"""An independent axisymmetric finite-element model of adhesive contact of graded materials.

Physical quantities in any consistent units: a half-space with Young's modulus E(z) and Poisson's ratio nu(z), a
rigid punch f(r), a surface law p(H).  The solid is meshed with high-order elements and closed by the exact
stiffness of the infinite exterior.  The equilibrium path is traced on the system condensed to the surface; a value is
that of the whole system at an event, solved by Newton's method with conjugate gradients and pyamg.

What a solver of an equilibrium path must have, and where it is:

1. a mesh that is fine where the pressure is: `_elastic.mesh`, `_contact.mesh_lengths`, `_contact.meshes`;
2. the response of the bodies to a pressure on it: `_elastic.assembly`, `_elastic.compliance`, `_contact.bodies`, and
   to that beyond it: `_elastic.exterior`, `_contact.tail`;
3. an equation: a state, its residual with the exact tangent, Newton's method: `_contact.contact`,
   `_contact.controls`, `_contact.newton`;
4. a continuation from far separation into compression, on one mesh before contact and then with a state for each radius
   of the contact edge, on a mesh that resolves it: `_contact.states`, `_contact.edge_states`, `_contact.path`;
5. completeness, a proof that no turning point is missed between two points: `_contact.completeness`;
6. events as roots of rates, the jumps between stable branches, and the mesh of each: `_contact.events`,
   `_contact.followed`, `_contact.event_mesh`;
7. the value at an event from the whole system: `_contact.uncondensed` and `_linear`;
8. a bound of the error of every value by its causes: `_contact.carried` and `_contact.parts`, its rounding in 7;
9. quantities, each a row that names its event and its functional: `quantities`; `solution` computes them by 1 to 8.

The names in `__all__` of the modules of solids, punches and laws are names of the package, too.  `_lazy.pyi` lists the
others; a module is loaded when one of its names is first used.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import lazy_loader

from fem_reference import (
    cohesive_laws,
    custom_solid,
    dlvo,
    laws,
    profiles,
    punch,
    solids,
    tabulated_law,
    tabulated_modulus,
)
from fem_reference.cohesive_laws import *
from fem_reference.custom_solid import *
from fem_reference.dlvo import *
from fem_reference.laws import *
from fem_reference.profiles import *
from fem_reference.punch import *
from fem_reference.solids import *
from fem_reference.tabulated_law import *
from fem_reference.tabulated_modulus import *

if TYPE_CHECKING:
    from fem_reference._lazy import *

__getattr__, _, __all__ = lazy_loader.attach_stub(__name__, str(Path(__file__).with_name("_lazy.pyi")))
_STATED = (cohesive_laws, custom_solid, dlvo, laws, profiles, punch, solids, tabulated_law, tabulated_modulus)
__all__ += [name for module in _STATED for name in module.__all__]


def __dir__() -> list[str]:
    return __all__
