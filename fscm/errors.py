"""Exceptions and warnings of the solver.

RuntimeError
NotConverged        a computation did not reach its tolerance; `failure` says which one, with its remedy
RingsForm         the surface comes into contact in rings
LookupError
NoSuchEvent         the path has no such event
ValueError            an argument is outside its range
OutsideAtlas        a parameter is outside the range of the atlas
UserWarning
AccuracyWarning     the bound of a value exceeds the requested accuracy
"""

from __future__ import annotations

from enum import Enum
from typing import Any

__all__ = ["AccuracyWarning", "Failure", "NoSuchEvent", "NotConverged", "OutsideAtlas", "RingsForm"]


class Failure(Enum):
    """What did not converge; the value is the remedy.

    Examples
    --------
    >>> Failure.STEP.value
    'the path of a smaller Tabor number turns less sharply'
    """

    #: Newton's method.
    ITERATION = "take a smaller step or a closer start, in a solution a smaller Tabor number or gradient exponent"
    #: The refinement of a mesh.
    MESH = "a smaller Tabor number or gradient exponent has a wider contact edge"
    #: Depths at which the constants of a solid change.
    SOLID = "a step is an interface of sharp layers (Layers, the kind layers)"
    #: The continuation of the path.
    STEP = "the path of a smaller Tabor number turns less sharply"
    #: The search for turning points between the points of a path.
    FOLDS = "the folds of a Tabor number that is a little different may be told apart"
    #: The end of the path.
    END = "take a punch without asperities, a law without barriers, or a stiffer solid of one power law"
    #: The end of the path, where the profile of a punch bends down beyond its last row.
    GROWTH = "the profile then goes on as its last rows do"
    #: The root of an event.
    EVENT = "take a Tabor number that is farther from the critical one"
    #: The stable branches between which a cycle jumps.
    BRANCH = "ask for a quantity at one event, or trace the path"
    #: A surface that comes into contact in rings.
    RINGS = "take a smaller Tabor number or a stiffer film"
    #: A contact larger than its punch.
    REACH = "take a larger ball or a stiffer solid"
    #: The potential of the atoms of a punch.
    PUNCH = "state the radii at which the slope of the punch jumps as its kinks"
    #: The paper's own scheme.
    SCHEME = "use a smaller gap_step or more segments"


class NotConverged(RuntimeError):
    """The computation did not reach its tolerance.

    Parameters
    ----------
    reason : str
        What was tried, and where it ended.
    failure : Failure, optional
        Its remedy ends the message.

    Examples
    --------
    >>> from fscm import Problem, solve
    >>> solve(Problem(n=2, k=0.999, mu=1), "pull_off_force")
    Traceback (most recent call last):
    fscm.errors.NotConverged: the contact edge of ... is about 10^-314 of its radius wide, below 10^-22, ...
    """

    def __init__(self, reason: str = "", failure: Failure | None = None) -> None:
        super().__init__(f"{reason}; {failure.value}" if failure else reason)
        self.reason, self.failure = reason, failure

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.reason, self.failure)


class RingsForm(NotConverged):
    """The surface comes into contact in rings; a finer mesh does not help."""


class NoSuchEvent(LookupError):
    """The equilibrium path has no such event (for example no jump below the critical Tabor number).

    Examples
    --------
    >>> from fscm import Problem, solve
    >>> solve(Problem(n=2, k=0, mu=0.1), "jump_in_gap")
    Traceback (most recent call last):
    fscm.errors.NoSuchEvent: the displacement rises monotonically along the path at mu = 0.1: there is no jump below ...
    """


class OutsideAtlas(ValueError):
    """A parameter is outside the range of the atlas.

    Examples
    --------
    >>> from fscm import atlas
    >>> atlas(2, 0.4, 20.0, "pull_off_force")
    Traceback (most recent call last):
    fscm.errors.OutsideAtlas: mu = 20 is outside [0.01, 10], the range of the atlas; fscm.solve has a wider one
    """


class AccuracyWarning(UserWarning):
    """The bound of a value exceeds the requested accuracy; the message has the accuracy reached.

    Examples
    --------
    >>> import warnings
    >>> from fscm import Exponential, Problem, solve
    >>> pad = Problem(2, 0.0, 1.0, graded=Exponential(E_surface=1.0, E_depth=400.0, length=1.0, nu=0.3))
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     force = solve(pad, "pull_off_force", accuracy=1e-10)
    >>> [warning.category.__name__ for warning in caught], 1e-10 < force.u_num / force.value < 1e-8
    (['AccuracyWarning'], True)
    """
