"""Exceptions raised by the solver."""

from __future__ import annotations

__all__ = ["NoSuchEvent", "NotConverged"]


class NotConverged(RuntimeError):
    """A linear, nonlinear or mesh iteration missed its tolerance; the message says what to change.

    Examples
    --------
    >>> try:
    ...     raise NotConverged("the path stops at H0 = 0.3; refine the mesh at the edge")
    ... except RuntimeError as error:
    ...     print(error)
    the path stops at H0 = 0.3; refine the mesh at the edge
    """


class NoSuchEvent(LookupError):
    """The equilibrium path has no such event (no fold, say, for a stiff solid); the message says why.

    Examples
    --------
    >>> try:
    ...     raise NoSuchEvent("the displacement rises all along the path: this solid is too stiff for jumps")
    ... except LookupError as error:
    ...     print(error)
    the displacement rises all along the path: this solid is too stiff for jumps
    """
