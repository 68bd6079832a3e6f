r"""Stable states of a displacement-controlled experiment on a fixed mesh, as a coarse check of complete paths.

The punch is withdrawn from full contact and pressed on again, in small steps of the displacement.  Where a branch of
stable states ends, the surface relaxes in pseudo-time (implicit Euler) to the state in which the jump lands, and from
there the punch is moved both ways, until every branch that jumps lead to is known.  Only the kernel matrix and the law
are those of the solver: no edge is followed, no arc length is taken, and no unstable state is passed.

*What a comparison proves.*  Every state found here is an equilibrium, so that the deepest load found here is at most
the pull-off force, up to the error of the mesh: a path with a *smaller* force has missed a state, and this is a proof.
A path with a *larger* force is not refuted: the deepest load may lie on states that are unstable under displacement
control, or on a stable branch to which no jump leads.  Each jump is a turning point of the displacement, which a
complete path has as well; a complete path may have more of them, on branches to which no jump leads.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg import lu_factor, lu_solve

from fscm import Problem
from fscm._surface.deformation import response_matrix
from fscm._surface.kernel import kernel_of
from fscm._surface.mesh import PanelMesh

# Nodes a panel, nodes of the mesh at most, and the height of the punch where it ends.
_ORDER, _MOST, _HEIGHT = 6, 1000, 3e3
# Longest panel; and the cohesive edge is (_EDGE compliance)^(-1/(1-k)) wide.  On panels that are longer than that the
# edge is held between them and jumps from one to the next (n = 2, k = 0.29, mu = 1.9: more than 24 branches).
_WIDTH, _EDGE = 0.18, 1.03
# The fine panels reach this much farther than the edge at the first state.
_BEYOND_EDGE, _MARGIN = 1.1, 2.0
# Steps of the displacement: the first, the longest in tension and in compression, and the one at which a branch ends.
_FIRST, _LONGEST, _LONGEST_PRESSED, _SHORTEST = 0.01, 0.06, 0.3, 2e-4
# Largest relative change of a gap's distance to the singular gap in a step, and beyond the trapezoidal rule.
_CHANGE, _SURPRISE, _GROWTH = 0.25, 0.02, 1.5
# Newton's method on a branch: iterations, those between two factorisations, largest relative change of the last step.
_ITERATIONS, _EVERY, _TOLERANCE = 12, 4, 1e-9
# Gap at which the punch is apart, in units of 1 + mu.
_APART = 3.0
# Two states at one displacement are the same if no gap differs by more than this, relative.
_SAME = 1e-3
_MOST_BRANCHES = 24
# A relaxation after a jump begins this far beyond the end of the branch.
_BEYOND = 2e-3


class State(NamedTuple):
    """A stable state, and the derivative of its load by the displacement."""

    displacement: float
    load: float
    slope: float
    gap: np.ndarray


class StableStates(NamedTuple):
    """Pull-off force of the stable states, and displacements at which branches end in jumps.

    Attributes
    ----------
    pull_off_force : float
        Largest tension of all stable states that were met.
    retreat, approach : list of float
        Displacements of the jumps when the punch is withdrawn and pressed on, ascending.
    """

    pull_off_force: float
    retreat: list[float]
    approach: list[float]


def least_load(branch: list[State]) -> float:
    """Smallest load of states in the order of their displacements; between two it is cubic."""
    least = min(state.load for state in branch)
    for a, b in pairwise(branch):
        if a.slope < 0.0 < b.slope:
            ends = [a.displacement, b.displacement], [a.load, b.load], [a.slope, b.slope]
            cubic = CubicHermiteSpline(*ends)
            least = min(least, float(np.min(cubic(cubic.derivative().roots(extrapolate=False)))))
    return least


class BruteForce:
    """Stable states of a problem; `width` is the length of the panels up to the radius `fine`."""

    def __init__(self, problem: Problem, width, fine, order=_ORDER, most=_MOST, height=_HEIGHT) -> None:
        self.problem = problem
        end = fine
        while problem.punch.height(np.array([end]))[0] < height:
            end *= 1.3
        width = max(width, fine * order / most)
        breaks = list(np.linspace(0.0, fine, math.ceil(fine / width) + 1))
        step = breaks[1]
        while breaks[-1] < end:
            step *= 1.35
            breaks.append(breaks[-1] + step)
        breaks = np.union1d(breaks, [r for r in getattr(problem.punch, "kinks", ()) if r < breaks[-1]])
        breaks = breaks[np.append(True, np.diff(breaks) > 1e-9)]
        mesh = PanelMesh(breaks, order)
        self.response = problem.compliance * (1.0 - problem.k) * response_matrix(kernel_of(problem.k), mesh)
        self.area = 2.0 * mesh.weights * mesh.nodes
        self.radii = mesh.nodes
        self.height = problem.punch.height(mesh.nodes)

    def residual(self, H, d):
        return H + d - self.height - self.response @ self.problem.law.traction(H)

    def jacobian(self, H):
        J = -self.response * self.problem.law.slope(H)
        J[np.diag_indices_from(J)] += 1.0
        return J

    def load(self, H):
        return float(self.area @ self.problem.law.traction(H))

    def clearance(self, H):
        return H - self.problem.law.singular_gap

    def compressed(self, d):
        """The state at a displacement that relaxes from full contact."""
        return self.relaxed(np.maximum(self.height - d, 0.0), d)

    def relaxed(self, H, d):
        """The state to which the gaps H relax: steps of implicit Euler, longer and longer, none through a maximum."""
        time = 1e-2
        for _ in range(600):
            R = self.residual(H, d)
            if np.max(np.abs(R) / self.clearance(H)) < _TOLERANCE:
                return H
            J = self.jacobian(H)
            J[np.diag_indices_from(J)] += 1.0 / time
            factors = _factorised(J)
            step = lu_solve(factors, -R, check_finite=False)
            if _rising(factors) and np.max(np.abs(step) / self.clearance(H)) < 0.4:
                H, time = H + step, time * 1.5
            else:
                time *= 0.4
        raise RuntimeError(f"no state to relax to at delta = {d}")

    def _solved(self, H, d, factors):
        """Newton's method from a close guess, with the given factors as long as they do; None if it fails."""
        for iteration in range(1, _ITERATIONS + 1):
            step = lu_solve(factors, -self.residual(H, d), check_finite=False)
            change = float(np.max(np.abs(step) / self.clearance(H)))
            if not change < _CHANGE:
                return None
            H = H + step
            if change < _TOLERANCE:
                return H
            if iteration % _EVERY == 0:
                factors = _factorised(self.jacobian(H))
        return None

    def swept(self, branch: list[State], end: float, upwards: bool) -> bool:
        """Continue a branch from one of its ends; whether it ends in a jump, not at `end` or apart."""
        sense = 1.0 if upwards else -1.0
        state, step = branch[-upwards], _FIRST
        d, H = state.displacement, state.gap
        apart = _APART * (1.0 + self.problem.mu)
        factors, tangent = self._linearised(H)
        while sense * (end - d) > 0.0 and (upwards or np.min(H) < apart):
            step, surprise = min(step, abs(end - d)), math.inf
            if np.max(step * np.abs(tangent) / self.clearance(H)) < _CHANGE:
                new = self._solved(H + sense * step * tangent, d + sense * step, factors)
                if new is not None:
                    new_factors, new_tangent = self._linearised(new)
                    beyond = new - H - 0.5 * sense * step * (tangent + new_tangent)
                    surprise = float(np.max(np.abs(beyond) / self.clearance(new)))
            if surprise > _SURPRISE or not _rising(new_factors):
                step *= 0.5
                if step < _SHORTEST:
                    return True
                continue
            d, H, factors, tangent = d + sense * step, new, new_factors, new_tangent
            branch.insert(len(branch) if upwards else 0, self._state(d, H, tangent))
            # The deviation from the trapezoidal rule is of third order.
            growth = min(_GROWTH, (0.5 * _SURPRISE / max(surprise, 1e-12)) ** (1.0 / 3.0))
            step = min(growth * step, _LONGEST_PRESSED if self.load(H) > 0.0 else _LONGEST)
        return False

    def _linearised(self, H):
        """Factors of the tangent matrix, and the derivative of the gaps by the displacement."""
        factors = _factorised(self.jacobian(H))
        return factors, lu_solve(factors, -np.ones_like(H), check_finite=False)

    def _state(self, d, H, tangent):
        return State(d, self.load(H), float(self.area @ (self.problem.law.slope(H) * tangent)), H)

    def _on(self, branch: list[State], H, d) -> bool:
        """Whether a state is on a branch: Newton's method from the states next to it leads to it."""
        at, gaps = [state.displacement for state in branch], [state.gap for state in branch]
        if not at[0] - _FIRST < d < at[-1] + _FIRST:
            return False
        j = int(np.clip(np.searchsorted(at, d), 1, len(at) - 1)) if len(at) > 1 else 0
        fraction = np.clip((d - at[j - 1]) / (at[j] - at[j - 1]), 0.0, 1.0) if j else 1.0
        start = (1.0 - fraction) * gaps[j - 1] + fraction * gaps[j]
        new = self._solved(start, d, _factorised(self.jacobian(start)))
        return new is not None and bool(np.max(np.abs(new - H) / self.clearance(H)) < _SAME)

    def stable(self, largest: float) -> StableStates:
        """The states of all branches that jumps lead to, from full contact at the displacement `largest`."""
        branches: list[list[State]] = []
        jumps: dict[bool, list[float]] = {False: [], True: []}
        seeds = [(largest, self.compressed(largest))]
        while seeds:
            d, H = seeds.pop()
            if any(self._on(branch, H, d) for branch in branches):
                continue
            if len(branches) == _MOST_BRANCHES:
                raise RuntimeError(f"more than {_MOST_BRANCHES} branches")
            branch = [self._state(d, H, self._linearised(H)[1])]
            branches.append(branch)
            for upwards in (False, True):
                if self.swept(branch, largest if upwards else -math.inf, upwards):
                    last = branch[-upwards]
                    jumps[upwards].append(last.displacement)
                    beyond = last.displacement + (_BEYOND if upwards else -_BEYOND)
                    seeds.append((beyond, self.relaxed(last.gap, beyond)))
        return StableStates(-min(map(least_load, branches)), sorted(jumps[False]), sorted(jumps[True]))


def _factorised(J):
    return lu_factor(J, overwrite_a=True, check_finite=False)


def _rising(factors):
    """Whether the determinant of a factorised matrix is positive: no unstable direction, or an even number."""
    matrix, pivots = factors
    swapped = np.count_nonzero(pivots != np.arange(len(pivots)))
    return (np.count_nonzero(np.diag(matrix) < 0.0) + swapped) % 2 == 0


def _edge(problem: Problem, displacement: float) -> float:
    """Outermost radius of contact at a displacement, on a coarse mesh."""
    radii = np.geomspace(1.0, 200.0, 2000)
    inside = problem.punch.height(radii) < displacement + 4.0 * problem.mu
    coarse = BruteForce(problem, 0.5, max(6.0, float(radii[inside][-1])), most=200)
    return float(np.max(coarse.radii[coarse.compressed(displacement) < problem.law.peak_gap]))


def stable_states(problem: Problem, height: float) -> StableStates:
    """The stable states from a displacement beyond roughness of that height to separation; coarse.

    Raises
    ------
    RuntimeError
        When a state is not found.
    """
    displacement = 6.0 + 1.3 * height + 2.0 * problem.mu
    width = (_EDGE * problem.compliance) ** (-1.0 / (1.0 - problem.k))
    fine = _BEYOND_EDGE * _edge(problem, displacement) + _MARGIN
    return BruteForce(problem, min(width, _WIDTH), fine).stable(displacement)
