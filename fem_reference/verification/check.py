"""One row of the verification ladder."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Rung"]


@dataclass(frozen=True, slots=True)
class Rung:
    """One row of the ladder.

    Attributes
    ----------
    rung, case : str
        What is tested, and on what.
    error, limit : float
        Measured relative error and the largest allowed.
    unknowns : int
        Size of the finite-element problem.

    Examples
    --------
    >>> Rung("symmetry", "k = 0.4", error=1e-15, limit=1e-12, unknowns=100).passed
    True
    """

    rung: str
    case: str
    error: float
    limit: float
    unknowns: int

    @property
    def passed(self) -> bool:
        """Whether the error is at most the limit."""
        return self.error <= self.limit
