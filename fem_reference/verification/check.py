"""Result of one check of the finite elements."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Check"]


@dataclass(frozen=True, slots=True)
class Check:
    """The measured error of one check, with its limit.

    Attributes
    ----------
    name, case : str
        The property that is checked, and the mesh and material.
    error, limit : float
        Measured relative error and the largest allowed.
    unknowns : int
        Size of the finite-element problem.

    Examples
    --------
    >>> Check("symmetry", "k = 0.4", error=1e-15, limit=1e-12, unknowns=100).passed
    True
    """

    name: str
    case: str
    error: float
    limit: float
    unknowns: int

    @property
    def passed(self) -> bool:
        """Whether the error is at most the limit."""
        return self.error <= self.limit
