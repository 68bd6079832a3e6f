"""Exceptions and warnings of the solver.

RuntimeError
    NotConverged        a computation missed its tolerance; `failure` says which one, with its remedy
LookupError
    NoSuchEvent         the path has no such event
ValueError              an argument is outside its range
UserWarning
    AccuracyWarning     the bound of a value exceeds the requested accuracy
"""

from __future__ import annotations

from enum import Enum
from typing import Any

__all__ = ["AccuracyWarning", "Failure", "NoSuchEvent", "NotConverged"]


class Failure(Enum):
    """What did not converge; the value is the remedy.

    Examples
    --------
    >>> Failure.START.value
    'take a stiffer solid'
    """

    #: Newton's method, of the condensed or of the whole system.
    ITERATION = "take a finer accuracy"
    #: A contact edge, or the spot on which contact begins, for which no mesh is fine enough.
    MESH = "take a stiffer surface, a smaller work of adhesion, or a longer range of the law"
    #: A solid that changes within a length for which no elements are thin enough.
    SOLID = "make the change longer, or sharp as between two layers"
    #: A stiffness that is not positive definite, or is spoiled by rounding.
    STIFFNESS = "check modulus, mesh and nu"
    #: Conjugate gradients and their preconditioner.
    LINEAR = "check modulus and mesh, or use the direct solver"
    #: A displacement that conjugate gradients have left as it was.
    UNSOLVED = "report the case"
    #: The first state of a path.
    START = "take a stiffer solid"
    #: The search for turning points between the points of a path.
    FOLDS = "the folds at a work of adhesion that is a little different may be told apart"
    #: The state at an event, or the modulus at which jumps begin.
    EVENT = "take a finer accuracy, or a modulus farther from the one at which jumps begin"
    #: A punch with more kinks than a mesh follows.
    KINKS = "take fewer points of the profile, or a smooth curve through them as a CustomPunch"
    #: A contact larger than its punch.
    REACH = "take a larger ball or a stiffer solid"
    #: The end of the path.
    END = "take a punch without asperities"
    #: The end of the path, where a profile bends down beyond its last row.
    GROWTH = "the profile then goes on as its last rows do"


class NotConverged(RuntimeError):
    """A linear, nonlinear or mesh iteration missed its tolerance.

    Parameters
    ----------
    reason : str
        What was tried, and where it ended.
    failure : Failure, optional
        Its remedy ends the message.

    Examples
    --------
    >>> raise NotConverged("the edge is 1e-9 of its radius wide", Failure.MESH)
    Traceback (most recent call last):
    fem_reference.errors.NotConverged: the edge is 1e-9 of its radius wide; take a stiffer surface, a smaller ...
    """

    def __init__(self, reason: str = "", failure: Failure | None = None) -> None:
        super().__init__(f"{reason}; {failure.value}" if failure else reason)
        self.reason, self.failure = reason, failure

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.reason, self.failure)


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
