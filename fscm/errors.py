"""Exceptions and warnings of the solvers."""

from __future__ import annotations

__all__ = ["AccuracyWarning", "NoSuchEvent", "NotConverged", "OutsideAtlas"]


class NotConverged(RuntimeError):
    """The computation did not reach its tolerance; the message says what was tried and what to change.

    Examples
    --------
    >>> from fscm import Problem, solve
    >>> solve(Problem(n=2, k=0.999, mu=1), "pull_off_force")
    Traceback (most recent call last):
    fscm.errors.NotConverged: the contact edge of ... is about 10^-314 of its radius wide, below 10^-22, ...
    """


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
