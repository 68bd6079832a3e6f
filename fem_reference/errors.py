"""What can go wrong, as types: no unconverged number leaves a solver."""

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


class NoSuchEvent(RuntimeError):
    """The equilibrium path has no such point (no fold, say, for a stiff solid); the message says why.

    Examples
    --------
    >>> from fem_reference._contact.events import folds
    >>> folds([])
    Traceback (most recent call last):
    fem_reference.errors.NoSuchEvent: the displacement rises all along the path: this solid is too stiff for jumps
    """
