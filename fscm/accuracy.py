"""Meshes of a computation, by the requested relative error."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from fscm._validation import real_number

__all__ = ["ACCURACIES", "Accuracy", "Mesh", "Meshes"]

#: Relative errors by name.
ACCURACIES = {"quick": 1e-6, "default": 1e-8, "fine": 1e-10}
#: Coarser meshes may miss the events of a soft solid; on finer ones rounding stops the refinement.
_FINEST, _COARSEST = 1e-10, 1e-4


class Mesh(NamedTuple):
    """Nodes a panel and tolerance of the indicator (`_surface.adaptivity`)."""

    order: int
    tolerance: float


#: Meshes of the accuracy "default".
_PATH, _CHECK, _VALUE = Mesh(8, 3e-3), Mesh(10, 3e-7), Mesh(12, 1e-7)
_CURVE = Mesh(10, 1e-6)
#: Meshes of events at a lower accuracy: two nodes fewer for each digit down to the order of the path, and a tolerance
#: that grows with the power _POWER.  Measured over 19 random problems at 1e-6 (order 8, tolerance 1e-4): bounds of the
#: pull-off force from 1e-13 to 3e-7 of it, in the median 6e-10.
_FEWER, _POWER, _LARGEST_TOLERANCE = 2, 1.5, 1e-3


@dataclass(frozen=True)
class Meshes:
    """Meshes of paths and of states at events.

    Attributes
    ----------
    path : Mesh
        Of the path that brackets the events: its digits are not used.
    check, value : Mesh
        Of a state at an event, and of the same state again, which bounds the error of its fields.
    curve : Mesh
        Of a path that is drawn and integrated.
    end_height : float
        Undeformed gap F at the end of the mesh.  The closed tail beyond has the relative error (1/F)^2.
    recompute_above : float
        Relative bound above which a value is computed again on the default meshes; infinite for the default and below.
    warn_above : float
        Relative bound above which there is a warning: the requested error if it is a number, infinite for a name.
    """

    path: Mesh = _PATH
    check: Mesh = _CHECK
    value: Mesh = _VALUE
    curve: Mesh = _CURVE
    end_height: float = 1e6
    recompute_above: float = math.inf
    warn_above: float = math.inf

    @classmethod
    def of(cls, accuracy: Accuracy) -> Meshes:
        """Meshes for a relative error: tolerances in proportion to it, and one more node a panel for each digit.

        Errors above the default allow much coarser meshes at the events, because the default exceeds its request.

        Raises
        ------
        ValueError
            For an unknown name, or a number outside [1e-10, 1e-4].
        """
        if isinstance(accuracy, Meshes):
            return accuracy
        warn_above = math.inf if isinstance(accuracy, str) else accuracy
        if isinstance(accuracy, str):
            if accuracy not in ACCURACIES:
                raise ValueError(
                    f"unknown accuracy {accuracy!r}; it is a relative error or one of {', '.join(ACCURACIES)}"
                )
            accuracy = ACCURACIES[accuracy]
        reason = "coarser meshes miss events, finer ones meet the rounding of the numbers"
        accuracy = real_number(
            "accuracy", accuracy, low=_FINEST, high=_COARSEST, reason=reason, closed_low=True, closed_high=True
        )
        factor = accuracy / ACCURACIES["default"]
        more = max(0, round(-math.log10(factor)))
        fewer = max(0, round(_FEWER * math.log10(factor)))

        def scaled(mesh: Mesh) -> Mesh:
            return Mesh(mesh.order + more, mesh.tolerance * factor)

        def at_event(mesh: Mesh) -> Mesh:
            if not fewer:
                return scaled(mesh)
            return Mesh(max(mesh.order - fewer, _PATH.order), min(mesh.tolerance * factor**_POWER, _LARGEST_TOLERANCE))

        return cls(
            check=at_event(_CHECK),
            value=at_event(_VALUE),
            curve=scaled(_CURVE),
            recompute_above=accuracy if fewer else math.inf,
            warn_above=warn_above,
        )


#: A relative error, its name, or the meshes themselves.
Accuracy: TypeAlias = "float | str | Meshes"
