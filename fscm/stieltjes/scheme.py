"""The Stieltjes scheme (Sec. 2.4, Eqs. 34-39): uniform segments, Riemann-Stieltjes sums, central gap control.

As in the paper, as a second discretisation and as the baseline of comparisons: N uniform segments up to f(r_max) = 50
with nothing beyond, tractions at the mean of neighbouring gaps, Newton's method from the previous solution.  Only what
the paper leaves open is added: the step of the central gap is halved if Newton's method fails; if that does not help,
there is an exception instead of a number.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from fscm._roots import bracketed_root
from fscm._surface.kernel import Psi
from fscm._threads import one_thread
from fscm._typing import Array
from fscm._validation import real_number
from fscm.errors import Failure, NotConverged
from fscm.problem import Problem

__all__ = ["CentralGapRates", "StieltjesScheme", "StieltjesState"]

#: Stopping rule of the paper: max |H_new / H_old - 1| < 1e-6.
_TOLERANCE = 1e-6
#: The rule of the paper divides by gaps that cross zero.  An absolute change below this is always accepted; it is the
#: rounding of M p for M up to 100 at |dp/dH| = 16.
_SMALLEST_CHANGE = 1e-12
#: Newton converges quadratically from a neighbouring solution: 3 to 6 iterations were seen.
_ITERATIONS = 30
#: In contact the displacement changes by 40 (mu = 1, k = 0) and far more per unit of the central gap, and the paper
#: does not state its step: largest number of halvings.
_HALVINGS = 12
#: Rows of the table evaluated together, to bound the memory of temporaries.
_BLOCK = 200


@lru_cache(maxsize=2)
def _psi_table(k: float, segments: int) -> Array:
    """i^(1-k) [Psi_k(j/i) - Psi_k((j-1)/i)], i, j = 1..N: for uniform segments it depends on k and N only."""
    table = np.empty((segments, segments))
    j = np.arange(segments + 1.0)
    for start in range(0, segments, _BLOCK):
        i = np.arange(start + 1.0, min(start + _BLOCK, segments) + 1.0)[:, None]
        # j - i is exact, j/i - 1 is not.
        table[start : start + _BLOCK] = i ** (1.0 - k) * np.diff(Psi(k, j / i, (j - i) / i), axis=1)
    table.flags.writeable = False
    return table


@dataclass(frozen=True, eq=False)
class StieltjesState:
    """An equilibrium: gaps H_1..H_N at the ends of the segments, displacement (Eq. 38) and load (Eq. 39).

    `change` is the largest change of a gap in the last of the `iterations`.

    Examples
    --------
    >>> state = StieltjesScheme(Problem(n=2, k=0.4, mu=0.5), segments=100).solve(10.0)
    >>> state.gap.shape, state.change < 1e-6
    ((100,), True)
    """

    central_gap: float
    gap: Array
    displacement: float
    load: float
    iterations: int
    change: float


@dataclass(frozen=True)
class CentralGapRates:
    """Derivatives of displacement and load by the central gap, along the path.

    Examples
    --------
    >>> scheme = StieltjesScheme(Problem(n=2, k=0.4, mu=0.5), segments=100)
    >>> rates = scheme.rates(scheme.solve(10.0))
    >>> rates.load > 0.0 > rates.displacement  # moving apart, the pull weakens
    True
    """

    displacement: float
    load: float


def _solved(matrix: Array, right: Array) -> Array:
    """Solution of a linear system; not a number when the matrix is singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, right), float)
    except np.linalg.LinAlgError:
        return np.full_like(right, np.nan)


class StieltjesScheme:
    """The discretisation of one problem.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    segments : int
        N, at least 10; 2500 in the paper.
    farthest_height : float
        f(r_max), > 0; 50 in the paper.
    gap_step : float
        Step of the central gap along the path, > 0; not stated in the paper.
    first_gap, last_gap : float
        Central gaps where the path begins and ends.  The paper has "say 10" and "say -0.1"; a path that ends at -0.1
        does not reach the pull-off of a cone on a stiff solid.
    last_load : float
        The path also ends at the first load above this: at a larger compression the contact would leave the domain.

    Raises
    ------
    ValueError
        With the value, the admissible range and the reason.

    Examples
    --------
    >>> scheme = StieltjesScheme(Problem(n=2, k=0.4, mu=0.5), segments=100, gap_step=0.2)
    >>> central_gap, displacement, load = scheme.curve()
    >>> bool(-1.9 < load.min() < -1.8)                      # converged: -1.8663
    True
    """

    def __init__(
        self,
        problem: Problem,
        segments: int = 2500,
        farthest_height: float = 50.0,
        gap_step: float = 0.1,
        first_gap: float = 10.0,
        last_gap: float = -0.4,
        last_load: float = 0.0,
    ) -> None:
        inf = math.inf
        if problem.k >= 1.0:
            raise ValueError("gradient exponent k = 1 is the Gibson solid, whose model is fscm.gibson")
        if problem.interaction != "derjaguin":
            raise ValueError(
                f"interaction {problem.interaction!r} is not that of the scheme of the paper, whose traction depends "
                "on the gap alone; take 'derjaguin'"
            )
        if isinstance(segments, bool) or not isinstance(segments, int) or segments < 10:
            raise ValueError(f"segments = {segments!r} is not an integer >= 10: the contact needs some points")
        reason = "the path leads from a wide gap, through contact, above the singularity of the law"
        singular = problem.law.singular_gap
        self.problem = problem
        self.segments = segments
        self.farthest_height = real_number(
            "farthest_height", farthest_height, low=0.0, high=inf, reason="the domain has a size"
        )
        self.gap_step = real_number("gap_step", gap_step, low=0.0, high=inf, reason="the gap falls step by step")
        self.last_gap = real_number("last_gap", last_gap, low=singular, high=inf, reason=reason)
        self.first_gap = real_number("first_gap", first_gap, low=self.last_gap, high=inf, reason=reason)
        self.last_load = real_number(
            "last_load",
            last_load,
            low=0.0,
            high=inf,
            closed_low=True,
            reason="the path leads through tension",
        )
        radius = np.linspace(0.0, self._farthest_radius(), segments + 1)
        self.radius: Array = radius[1:]
        self._height = problem.punch.height(self.radius)
        self._w = problem.compliance * np.diff(radius ** (1.0 - problem.k))
        self._area = np.diff(radius**2)
        # M r_i^(1-k) [Psi differences] = M h^(1-k) i^(1-k) [...]
        self._front = problem.compliance * radius[1] ** (1.0 - problem.k)

    def _farthest_radius(self) -> float:
        """Radius at which the punch reaches the farthest height."""

        def excess(r: float) -> float:
            return float(self.problem.punch.height(np.array([r]))[0]) - self.farthest_height

        high = 1.0
        while excess(high) < 0.0:
            high *= 2.0
        return bracketed_root(excess, 0.0, high, 1e-300)

    @one_thread()
    def solve(self, central_gap: float, start: Array | None = None) -> StieltjesState:
        """Newton's method at a central gap (Eqs. 34-37).

        Parameters
        ----------
        central_gap : float
            H_0 in z0.
        start : ndarray, shape (N,), optional
            First iterate; the undeformed gap H_0 + f by default.

        Raises
        ------
        NotConverged
            When the stopping rule is not met, or an iterate leaves the domain of the law.
        """
        H = central_gap + self._height if start is None else start
        for iteration in range(1, _ITERATIONS + 1):
            p, matrix = self._linearised(central_gap, H)
            residual = H - central_gap - self._height - self._front * (_psi_table(self.problem.k, self.segments) @ p)
            # A singular matrix or an overflow makes an iterate that fails the check below.
            new = H - _solved(matrix, residual)
            if not (np.all(np.isfinite(new)) and new.min() > self.problem.law.singular_gap):
                break
            change = np.abs(new - H)
            converged = np.all((change < _TOLERANCE * np.abs(H)) | (change < _SMALLEST_CHANGE))
            H = new
            if converged:
                p = self.problem.law.traction(self._middle(central_gap, H))
                displacement = float(self._w @ p) - central_gap
                return StieltjesState(
                    central_gap, H, displacement, float(self._area @ p), iteration, float(change.max())
                )
        raise NotConverged(
            f"Newton's method failed at the central gap {central_gap:g} after {iteration} iterations on "
            f"{self.segments} segments at mu = {self.problem.mu:g}",
            Failure.SCHEME,
        )

    @staticmethod
    def _middle(central_gap: float, H: Array) -> Array:
        """Gaps at the middle of the segments, (H_{j-1} + H_j) / 2."""
        return 0.5 * (H + np.concatenate([[central_gap], H[:-1]]))

    def _linearised(self, central_gap: float, H: Array) -> tuple[Array, Array]:
        """Tractions of the segments and the Jacobi matrix of Eq. 37."""
        middle = self._middle(central_gap, H)
        law = self.problem.law
        weighted = _psi_table(self.problem.k, self.segments) * (-0.5 * self._front * law.slope(middle))
        weighted[:, :-1] += weighted[:, 1:]
        weighted.flat[:: self.segments + 1] += 1.0
        return law.traction(middle), weighted

    @one_thread()
    def rates(self, state: StieltjesState) -> CentralGapRates:
        """Derivatives by the central gap, from one solve with the Jacobi matrix of the state."""
        slope = self.problem.law.slope(self._middle(state.central_gap, state.gap))
        _, matrix = self._linearised(state.central_gap, state.gap)
        # H_0 enters Eq. 34 itself and through the middle of the first segment.
        by_central = 1.0 + 0.5 * self._front * slope[0] * _psi_table(self.problem.k, self.segments)[:, 0]
        dH = _solved(matrix, by_central)
        dp = slope * self._middle(1.0, dH)
        return CentralGapRates(float(self._w @ dp) - 1.0, float(self._area @ dp))

    @cached_property
    @one_thread()
    def path(self) -> list[StieltjesState]:
        """States from the first gap to the last gap or load, by `gap_step`, halved where Newton fails.

        Raises
        ------
        NotConverged
            When the smallest step fails.
        """
        states = [self.solve(self.first_gap)]
        step = self.gap_step
        while states[-1].central_gap > self.last_gap and states[-1].load <= self.last_load:
            state = states[-1]
            try:
                states.append(self.solve(max(state.central_gap - step, self.last_gap), state.gap))
            except NotConverged:
                step *= 0.5
                if step < self.gap_step * 0.5**_HALVINGS:
                    raise
            else:
                step = min(2.0 * step, self.gap_step)
        return states

    def curve(self) -> tuple[Array, Array, Array]:
        """Central gaps, displacements and loads along the path, three arrays of one length."""
        rows = [(s.central_gap, s.displacement, s.load) for s in self.path]
        central, displacement, load = np.array(rows).T
        return central, displacement, load
