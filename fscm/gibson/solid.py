"""Self-consistent model of the Gibson solid, k = 1 and nu = 1/2, in closed algebraic form.

For k -> 1 the primitive Phi_k is a step, and the deformation is local, w = M p with
M = 2 mu^2.  With u = f(r) - delta, Eq. 28 reads

    F(H) = H - M p(H) = u,        e(u) = M p^2 / 2 + U(H),        de/du = -p,

U being the energy of the surface law and e the energy per area.  Up to the critical Tabor number F is monotone, and one
gap belongs to u.  Beyond it there are two stable gaps in a range of u, and the profile may have a front at which it
changes from one to the other.  A front is in equilibrium where both sides have the same energy e (Maxwell's rule): the
limit of Griffith's balance at the crack-like edge of a solid with k < 1 as its width tends to zero, not a spinodal
instability of each point separately.  The equilibrium path then has

    an open branch, all gaps on the far side, from infinite separation to the fold A of F (jump in);
    a contact branch, near side inside a front of level u = u_M, from radius 0 at delta = -u_M (jump out B).

Between A and B the path leads through an unstable small contact, which shrinks to the axis as k -> 1: it carries no
load, so that the load-displacement curve returns along the open branch; its central gap is not computed.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from functools import cached_property

import numpy as np

from fscm._threads import one_thread
from fscm.errors import Failure, NoSuchEvent, NotConverged
from fscm.gibson.local_equilibrium import Front, LocalEquilibrium, root
from fscm.problem import Problem
from fscm.punch import PowerPunch
from fscm.solution import Parts, Solution

__all__ = ["GibsonSolid"]

_EPS = sys.float_info.epsilon
#: Tolerance of the quadrature; its error estimate enters u_num.
_QUADRATURE = 1e-13
#: Rounding of all results, in units of eps (1 + M) |value|; measured worst 3 against the closed forms of n = 2.
_ROUNDING = 16.0
#: Step of the search for extremes of the load, in units of 1 + |delta|, its largest number, and the largest separation.
_SEARCH_STEP, _SEARCH_STEPS, _FARTHEST = 0.05, 2000, 10.0

Number = tuple[float, float]


class GibsonSolid:
    """The full self-consistent model at k = 1, for a power-law punch.

    Parameters
    ----------
    problem : Problem
        With k = 1 and the punch r^n / n; any surface law whose F folds at most twice.

    Raises
    ------
    ValueError
        For another k or punch, or a law with more than one unstable range.

    Examples
    --------
    >>> solid = GibsonSolid(Problem(n=2, k=1, mu=1.5))
    >>> round(solid.solution("pull_off_force").value, 12)      # 2 for a paraboloid, whatever mu
    2.0
    """

    def __init__(self, problem: Problem) -> None:
        if problem.k != 1.0:
            raise ValueError(f"gradient exponent k = {problem.k:g} is outside [1, 1]: this is the Gibson limit")
        if not isinstance(problem.punch, PowerPunch):
            raise ValueError(f"punch = {problem.punch!r} is not a power law, the only punch of the Gibson limit")
        self.problem = problem
        self._local = LocalEquilibrium(problem.law, problem.compliance)

    def _area(self, height: float, order: int = 0) -> float:
        """r^2 at which the punch has a height, (n f)^(2/n), or its derivative."""
        n = self.problem.n
        x = n * max(height, 0.0)
        return x ** (2.0 / n) if order == 0 else 2.0 * x ** (2.0 / n - 1.0) if x > 0.0 else 0.0

    def _sum(self, delta: float, contact: bool, order: int) -> Number:
        """Return P (order 0) or dP/d(delta) (order 1), with the error of the quadrature.

        P is the integral of p d(r^2).  By parts, P = [p r^2] - integral of r^2 dp over the gaps of the profile; the
        bracket is the jump at the front.
        """
        front = self._local.front if contact else None
        center = self._local.near(-delta) if contact else self._local.far(-delta)
        ends = [(center, front.near), (front.far, math.inf)] if front else [(center, math.inf)]
        total, error = 0.0, 0.0
        if front:
            jump = self._local.traction(front.near) - self._local.traction(front.far)
            total = self._area(front.level + delta, order) * jump
        for a, b in ends:
            # The well, of unit width, and the tail separately.
            pieces = [(a, a + 1.0), (a + 1.0, b)] if math.isinf(b) else [(a, b)]
            for c, d in pieces:
                value, wrong = _integral(
                    lambda H: self._area(self._local.level(H) + delta, order) * self._local.slope(H), c, d
                )
                total, error = total - value, error + wrong
        return total, error

    def displacement(self, central_gap: float) -> float:
        """Return delta at a central gap on the open or the contact branch.

        Raises
        ------
        ValueError
            For a central gap between the two branches, that of an unstable small contact, or below the singularity of
            the law.

        Examples
        --------
        >>> problem = Problem(n=2, k=1, mu=1.5)
        >>> p = float(problem.law.traction(np.array(10.0)))
        >>> abs(GibsonSolid(problem).displacement(10.0) - (problem.compliance * p - 10.0)) < 1e-12
        True
        """
        self._contact(central_gap)
        return -self._local.level(central_gap)

    def load(self, central_gap: float) -> float:
        """P at a central gap on the open or the contact branch; ValueError as for `displacement`.

        Examples
        --------
        Of a paraboloid with all gaps on the far side, P = 2 U(H_0) + M p(H_0)^2:

        >>> problem = Problem(n=2, k=1, mu=1.5)
        >>> p, U = (float(f(np.array(10.0))) for f in (problem.law.traction, problem.law.energy))
        >>> abs(GibsonSolid(problem).load(10.0) - (2.0 * U + problem.compliance * p**2)) < 1e-12
        True
        """
        contact = self._contact(central_gap)
        return self._sum(-self._local.level(central_gap), contact, 0)[0]

    def _contact(self, central_gap: float) -> bool:
        """Whether a central gap belongs to the contact branch."""
        if not self.problem.law.singular_gap < central_gap < math.inf:
            raise ValueError(f"central gap {central_gap} is outside ({self.problem.law.singular_gap:g}, inf)")
        if not (self._local.folds and self._local.front):
            return True
        if self._local.front.near < central_gap < self._local.folds[1]:
            raise ValueError(
                f"central gap {central_gap:g} is inside "
                f"({self._local.front.near:g}, {self._local.folds[1]:g}): "
                "between jump-in and jump-out the path has no limit as k -> 1"
            )
        return central_gap <= self._local.front.near

    @cached_property
    def _pull_off(self) -> tuple[float, bool]:
        """Displacement of the smallest load and whether it is on the contact branch."""
        candidates = []
        for contact in (True, False) if self._local.front else (True,):
            start = -self._local.front.level if self._local.front and contact else -_FARTHEST
            stop = -self._local.level(self._local.folds[1]) if self._local.folds and not contact else math.inf
            if not contact:
                start = stop - _FARTHEST
            candidates += [(self._sum(x, contact, 0)[0], x, contact) for x in self._extremes(start, stop, contact)]
        _, delta, contact = min(candidates)
        return delta, contact

    def _extremes(self, start: float, stop: float, contact: bool) -> list[float]:
        """Minima of the load on a branch, and its ends; ends early at a rising compressive load."""
        delta, rate, minima = start, self._sum(start, contact, 1)[0], [start]
        for _ in range(_SEARCH_STEPS):
            ahead = min(delta + _SEARCH_STEP * (1.0 + abs(delta)), stop)
            slope = self._sum(ahead, contact, 1)[0]
            if rate < 0.0 <= slope:
                minima.append(root(lambda x: self._sum(x, contact, 1)[0], delta, ahead))
            delta, rate = ahead, slope
            if delta >= stop:
                return [*minima, stop]
            if rate > 0.0 and self._sum(delta, contact, 0)[0] > 0.0:
                return minima
        raise NotConverged(f"no compressive load up to delta = {delta:g} for {self.problem}", Failure.END)

    @one_thread()
    def solution(self, quantity: str) -> Solution:
        """Compute one quantity with its numerical uncertainty.

        Parameters
        ----------
        quantity : str
            pull_off_force, pull_off_displacement, jump_in_displacement, jump_in_gap, jump_out_displacement,
            zero_load_displacement, hysteresis_energy or critical_tabor_number, as in `fscm.solve`.

        Raises
        ------
        NoSuchEvent
            For a jump below the critical Tabor number, and for jump_out_gap, which has no limit as k -> 1.
        ValueError
            For an unknown quantity.
        """
        start = time.perf_counter()
        if quantity not in _QUANTITIES:
            raise ValueError(f"unknown quantity {quantity!r}; known are {', '.join(_QUANTITIES)}")
        value, error = _QUANTITIES[quantity](self)
        parts = Parts(mesh=error, rounding=_ROUNDING * _EPS * (1.0 + self._local.M) * (1.0 + abs(value)))
        return Solution(value, parts, 1, 0, 0.0, time.perf_counter() - start)

    def _hysteretic(self) -> tuple[float, Front]:
        """Gap of fold A and the front, or NoSuchEvent."""
        if not (self._local.folds and self._local.front):
            raise NoSuchEvent(
                f"mu = {self.problem.mu:g} is outside ({math.sqrt(0.5 / self._local.steepness):g}, inf): "
                "the displacement rises monotonically, there is no jump"
            )
        return self._local.folds[1], self._local.front

    def _pull_off_force(self) -> Number:
        value, error = self._sum(*self._pull_off, 0)
        return -value, error

    def _pull_off_displacement(self) -> Number:
        delta, contact = self._pull_off
        rate, error = self._sum(delta, contact, 1)
        ends = (
            [-self._local.front.level, -self._local.level(self._local.folds[1])]
            if self._local.front and self._local.folds
            else []
        )
        if delta in ends:
            return delta, 0.0
        h = 1e-3 * (1.0 + abs(delta))
        stiffening = (self._sum(delta + h, contact, 1)[0] - rate) / h
        return delta, error / abs(stiffening)

    def _zero_load_displacement(self) -> Number:
        low = high = self._pull_off[0] if self._pull_off[1] else -self._hysteretic()[1].level
        while self._sum(high, True, 0)[0] <= 0.0:
            high += _SEARCH_STEP * (1.0 + abs(high))
        delta = root(lambda x: self._sum(x, True, 0)[0], low, high)
        return delta, self._sum(delta, True, 0)[1] / self._sum(delta, True, 1)[0]

    def _jump_in_displacement(self) -> Number:
        return -self._local.level(self._hysteretic()[0]), 0.0

    def _jump_in_gap(self) -> Number:
        H, _ = self._hysteretic()
        curvature = float(self.problem.law.curvature(np.array(H)))
        return H, _ROUNDING * _EPS * abs(self._local.slope(H) / curvature)

    def _jump_out_displacement(self) -> Number:
        _, front = self._hysteretic()
        # Two energies, each rounded, are equal to within their slope, the jump of the traction.
        return -front.level, _ROUNDING * _EPS / abs(self._local.traction(front.near) - self._local.traction(front.far))

    def _jump_out_gap(self) -> Number:
        self._hysteretic()
        raise NoSuchEvent("jump_out_gap has no value at k = 1: the contact at the jump shrinks to the axis")

    def _critical_tabor_number(self) -> Number:
        return math.sqrt(0.5 / self._local.steepness), 0.0

    def _hysteresis_energy(self) -> Number:
        """Energy of the open profile at A minus that of the contact profile there, integral of r^2 [p] du.

        At B, and at the front, both sides have the same energy: no energy is lost in the jump out.
        """
        A, front = self._hysteretic()
        level = self._local.level(A)

        def density(H: float) -> float:
            return (
                self._area(self._local.level(H) - level)
                * self._local.traction(H)
                * (1.0 - self._local.M * self._local.slope(H))
            )

        opened, error = _integral(density, A, front.far)
        closed, wrong = _integral(density, self._local.near(level), front.near)
        return opened - closed, error + wrong


#: Value and error of each quantity.
_QUANTITIES: dict[str, Callable[[GibsonSolid], Number]] = {
    "pull_off_force": GibsonSolid._pull_off_force,
    "pull_off_displacement": GibsonSolid._pull_off_displacement,
    "jump_in_displacement": GibsonSolid._jump_in_displacement,
    "jump_in_gap": GibsonSolid._jump_in_gap,
    "jump_out_displacement": GibsonSolid._jump_out_displacement,
    "jump_out_gap": GibsonSolid._jump_out_gap,
    "zero_load_displacement": GibsonSolid._zero_load_displacement,
    "hysteresis_energy": GibsonSolid._hysteresis_energy,
    "critical_tabor_number": GibsonSolid._critical_tabor_number,
}


def _integral(f: Callable[[float], float], a: float, b: float) -> Number:
    """Integral and its error by adaptive quadrature; the error replaces its warnings."""
    from scipy.integrate import quad

    value, error, *_ = quad(f, a, b, epsabs=_QUADRATURE, epsrel=_QUADRATURE, limit=200, full_output=1)
    return float(value), float(error)
