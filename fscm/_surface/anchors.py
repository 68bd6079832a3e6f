"""Anchors of the mesh: what fixes its scale c.

Before contact the scale is fixed, and the central gap is the continuation parameter.  In contact the mesh follows the
edge: its gap is at s = 1, and log c is the parameter.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from fscm.problem import Problem

__all__ = ["Anchor", "AtEdge", "FixedScale"]


@dataclass(frozen=True)
class FixedScale:
    """The scale is given.

    Attributes
    ----------
    parameter : str
        The usual continuation parameter.
    orientation : float
        1 if it rises along the path, -1 if it falls.
    in_contact : bool
        Whether the mesh follows the edge of a contact.
    """

    parameter = "gap"
    orientation = -1.0
    in_contact = False


@dataclass(frozen=True)
class AtEdge:
    """The gap at s = 1 is that of the edge; attributes as for `FixedScale`.

    Attributes
    ----------
    gap : float, optional
        By default that of largest tension.
    """

    gap: float | None = None
    parameter = "log_scale"
    orientation = 1.0
    in_contact = True

    def gap_at(self, problem: Problem, scale: float) -> float:
        """The gap at s = 1."""
        return float(problem.force.peak_gap(np.array(scale))) if self.gap is None else self.gap

    def drift(self, problem: Problem, scale: float) -> float:
        """Derivative of that gap by log c."""
        return problem.force.peak_drift(scale) if self.gap is None else 0.0


Anchor: TypeAlias = FixedScale | AtEdge
