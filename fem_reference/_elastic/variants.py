"""Variants of a mesh: one feature made coarser, every other node kept.

The difference between a mesh and its variant is then due to that feature alone.  Whatever its error falls with, it is
at least halved from the variant to the mesh if it is at least linear, so that the difference bounds it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np

from fem_reference._elastic.mesh import Grid, MeshSpec, shortened

__all__ = ["ENDS", "FEATURES", "VariantSpec", "variant"]

#: Name of the variant whose innermost element is larger and whose mesh ends earlier.
ENDS = "ends"
#: What a variant makes coarser: the first layer takes in the second, or the innermost element takes in its neighbour
#: and the mesh ends earlier.  The latter two share a variant, because they do not cancel: the innermost element changes
#: gaps in the centre by 1e-6 or more, where the end changes them by 1e-9, and other values by less than 2e-10 (measured
#: on 10 problems of cones and two of others).
FEATURES = ("first layer", ENDS)

#: Smallest ratio of the extent to that of a variant.
SHRINKAGE = 2.0


@dataclass(frozen=True, slots=True)
class VariantSpec(MeshSpec):
    """A mesh with one feature of `FEATURES` made coarser, hashable.

    With `ENDS`, it ends at its own `end`, if that is at most half of the extent.
    """

    feature: str = ""

    def grid(self) -> Grid:
        """Return the grid with its edge at s = 1."""
        grid = MeshSpec.grid(self)
        if self.feature == "first layer":
            return Grid(grid.r, np.delete(grid.z, 1))
        whole = replace(self, feature="", end=math.inf)
        if grid.extent > MeshSpec.grid(whole).extent / SHRINKAGE:
            r = grid.r[grid.r <= grid.extent / SHRINKAGE * (1.0 + 1e-12)]
            grid = Grid(r, shortened(grid.z, float(r[-1])))
        return Grid(np.delete(grid.r, 1), grid.z)


def variant(spec: MeshSpec, feature: str) -> VariantSpec:
    """Return a mesh with one feature made coarser.

    Parameters
    ----------
    spec : MeshSpec
    feature : str
        One of `FEATURES`.

    Raises
    ------
    ValueError
        For an unknown feature.

    Examples
    --------
    >>> spec = MeshSpec(0.1, 0.05, 100.0, 0.5, 4)
    >>> bool(variant(spec, "first layer").grid().z[1] == spec.grid().z[2])
    True
    """
    if feature not in FEATURES:
        raise ValueError(f"feature {feature!r} of a mesh is unknown; choose one of {', '.join(FEATURES)}")
    return VariantSpec(**{field.name: getattr(spec, field.name) for field in fields(MeshSpec)}, feature=feature)
