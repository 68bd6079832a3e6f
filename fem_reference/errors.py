"""Exceptions and warnings of the solver."""

from __future__ import annotations

__all__ = ["AccuracyWarning", "NoSuchEvent", "NotConverged"]


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
    """The equilibrium path has no such event (for example no fold for a stiff solid); the message says why.

    Examples
    --------
    >>> try:
    ...     raise NoSuchEvent("the displacement rises all along the path: this solid is too stiff for jumps")
    ... except LookupError as error:
    ...     print(error)
    the displacement rises all along the path: this solid is too stiff for jumps
    """


class AccuracyWarning(UserWarning):
    """The bound of a value exceeds the requested accuracy; the message has the accuracy reached.

    Examples
    --------
    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     warnings.warn("accuracy = 1e-08 is not reached", AccuracyWarning)
    >>> [str(warning.message) for warning in caught]
    ['accuracy = 1e-08 is not reached']
    """
