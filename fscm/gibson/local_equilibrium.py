"""Equilibrium gaps at one point of the Gibson solid: at a level, at the folds and at a front.

The Gibson solid moves only where it is pressed.  With the level u = f(r) - delta and the compliance M, the gap obeys
F(H) = H - M p(H) = u and costs the energy e(u) = M p^2 / 2 + U(H) per area, de/du = -p.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fscm._roots import bracketed_root
from fscm.laws import SurfaceLaw

__all__ = ["Front", "LocalEquilibrium", "root"]

#: Absolute accuracy of roots, for that at zero (the equilibrium gap): M p is then exact to 16 M times as much.
_ROOT_FLOOR = 1e-20


def root(f: Callable[[float], float], a: float, b: float) -> float:
    """Root of f between a and b, to rounding.

    Examples
    --------
    >>> root(lambda x: x * x - 2.0, 1.0, 2.0)
    1.41421356237...
    """
    return bracketed_root(f, a, b, _ROOT_FLOOR)


@dataclass(frozen=True)
class Front:
    """Two stable gaps of one energy at one level u.

    Examples
    --------
    >>> from fscm.laws import LennardJones
    >>> point = LocalEquilibrium(LennardJones(), 8.0)
    >>> front = point.front
    >>> abs(point.energy(front.near) - point.energy(front.far)) < 1e-12  # Maxwell's rule
    True
    """

    level: float
    near: float
    far: float


class LocalEquilibrium:
    """Equilibrium gaps at a level, for one law and compliance.

    Parameters
    ----------
    law : SurfaceLaw
    M : float
        Compliance, > 0.

    Raises
    ------
    ValueError
        When F has more than one falling range.

    Examples
    --------
    >>> from fscm.laws import LennardJones
    >>> point = LocalEquilibrium(LennardJones(), 8.0)
    >>> near, far = point.near(3.0), point.far(3.0)      # two gaps at one level
    >>> near < far, abs(point.level(near) - point.level(far)) < 1e-13
    (True, True)
    """

    def __init__(self, law: SurfaceLaw, M: float) -> None:
        self.law = law
        self.M = M
        size = law.peak_gap - law.singular_gap
        grid = law.peak_gap + size * np.geomspace(1e-3, 1e4, 600)
        slopes = law.slope(grid)
        top = int(np.argmax(slopes))
        self._steepest = root(lambda H: float(law.curvature(np.array(H))), grid[top - 1], grid[top + 1])
        self.steepness = self.slope(self._steepest)
        falling = M * slopes > 1.0
        if np.sum(np.diff(falling.astype(int)) != 0) > 2:
            raise ValueError(f"law = {law!r} has more than one unstable range at the compliance M = {M:g}")

    def traction(self, H: float) -> float:
        """p(H)."""
        return float(self.law.traction(np.array(H)))

    def slope(self, H: float) -> float:
        """dp/dH."""
        return float(self.law.slope(np.array(H)))

    def level(self, H: float) -> float:
        """F(H)."""
        return H - self.M * self.traction(H)

    def energy(self, H: float) -> float:
        """Return e at the level of H."""
        return 0.5 * self.M * self.traction(H) ** 2 + float(self.law.energy(np.array(H)))

    @cached_property
    def folds(self) -> tuple[float, float] | None:
        """Gaps where F has its maximum and its minimum (the latter is A), if it folds."""
        if self.M * self.steepness <= 1.0:
            return None

        def stability(H: float) -> float:
            return 1.0 - self.M * self.slope(H)

        far = self._steepest + 1.0
        while stability(far) < 0.0:
            far = self._steepest + 2.0 * (far - self._steepest)
        inner = root(stability, self.law.peak_gap, self._steepest)
        return inner, root(stability, self._steepest, far)

    def near(self, level: float) -> float:
        """Gap on the near side of the folds (or the only gap) at a level."""
        singular = self.law.singular_gap
        high = self.folds[0] if self.folds else max(level, self.law.peak_gap) + 1.0
        low = high
        while self.level(low) >= level:
            low = singular + 0.5 * (low - singular)
        return root(lambda H: self.level(H) - level, low, high)

    def far(self, level: float) -> float:
        """Gap on the far side; F(H) >= H under tension brackets it."""
        if not self.folds:
            return self.near(level)
        low = self.folds[1]
        if level <= self.level(low):
            return low
        return root(lambda H: self.level(H) - level, low, max(level, low) + 1.0)

    @cached_property
    def front(self) -> Front | None:
        """Maxwell's rule: the level at which the near and the far side have one energy."""
        if not self.folds:
            return None
        low, high = self.level(self.folds[1]), self.level(self.folds[0])

        def excess(u: float) -> float:
            return self.energy(self.near(u)) - self.energy(self.far(u))

        # Just above the critical Tabor number the energies differ by less than rounding in the whole range.
        level = root(excess, low, high) if excess(low) < 0.0 < excess(high) else 0.5 * (low + high)
        return Front(level, self.near(level), self.far(level))
