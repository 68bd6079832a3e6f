"""What holds at the surface of a half-space beside its load."""

from __future__ import annotations

from dataclasses import dataclass, replace

__all__ = ["FREE", "SurfaceCondition"]


@dataclass(frozen=True, slots=True)
class SurfaceCondition:
    """Surface tension, and whether points of the surface keep their radius.

    Attributes
    ----------
    tension : float
        Force per length, >= 0.
    bonded : bool
        Whether u_r = 0 along the whole surface.

    Examples
    --------
    >>> SurfaceCondition(tension=3.0).scaled(2.0)
    SurfaceCondition(tension=6.0, bonded=False)
    """

    tension: float = 0.0
    bonded: bool = False

    def scaled(self, ratio: float) -> SurfaceCondition:
        """Return the condition with the tension in other units."""
        return replace(self, tension=ratio * self.tension)


#: Neither tension nor bond.
FREE = SurfaceCondition()
