"""An independent axisymmetric finite-element model of adhesive contact of graded materials.

Physical quantities in any consistent units: a half-space with Young's modulus E(z) and Poisson ratio nu(z), a
rigid punch f(r), a surface law p(H).  The solid is meshed with high-order elements and closed by the exact
stiffness of the infinite exterior.  Condensed to its surface it follows the path of equilibria; at an event every
displacement of the mesh is solved with pyamg.

The public names are listed in `__init__.pyi`; a module is loaded when one of its names is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
