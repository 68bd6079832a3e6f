"""Equilibrium path on a fixed mesh, from compression to separation, as a coarse check of complete paths.

Nothing follows an edge here, and no step is taken in the edge radius or in the central gap: the mesh is fixed, and the
arc length is that of all gaps together, oriented by the tangent before.  The first state is found from full contact by
relaxation, so that the path begins at the other end.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from fscm import Problem
from fscm._deformation import response_matrix
from fscm._kernel import kernel_of
from fscm._panels import PanelMesh

# Nodes a panel, nodes of the mesh at most, and the height of the punch where it ends.
_ORDER, _MOST, _HEIGHT = 4, 400, 3e3
_STEP, _SMALLEST, _STEPS = 0.1, 1e-5, 1500


class BruteForce:
    """Loads of the equilibrium path of a problem; `width` is the length of the panels up to the radius `fine`."""

    def __init__(
        self,
        problem: Problem,
        width: float,
        fine: float,
        order: int = _ORDER,
        most: int = _MOST,
        height: float = _HEIGHT,
    ) -> None:
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
        self.height = problem.punch.height(mesh.nodes)
        self.fine = mesh.nodes < fine

    def residual(self, H, d):
        return H + d - self.height - self.response @ self.problem.law.traction(H)

    def jacobian(self, H):
        J = -self.response * self.problem.law.slope(H)
        J[np.diag_indices_from(J)] += 1.0
        return J

    def load(self, H):
        return float(self.area @ self.problem.law.traction(H))

    def compressed(self, d):
        """Relax from full contact at a displacement: steps of implicit Euler, longer and longer."""
        H, time = np.maximum(self.height - d, 0.0), 1e-2
        for _ in range(400):
            R = self.residual(H, d)
            if np.max(np.abs(R) / (1.0 + np.abs(H))) < 1e-10:
                return H
            J = self.jacobian(H)
            J[np.diag_indices_from(J)] += 1.0 / time
            step = np.linalg.solve(J, -R)
            if np.max(np.abs(step) / (H + 1.0)) < 0.4:
                H, time = H + step, time * 1.5
            else:
                time *= 0.4
        raise RuntimeError(f"no state in compression at delta = {d}")

    def path(self, d):
        """Displacements and loads from compression at `d` to separation."""
        H = self.compressed(d)
        tangent = np.append(np.zeros_like(H), -1.0)
        step, found = _STEP, [(d, self.load(H))]
        for _ in range(_STEPS):
            weights = np.append(self.area * self.fine / (1.0 + H) ** 2, 0.1)
            J = np.block([[self.jacobian(H), np.ones((len(H), 1))], [(weights * tangent)[None, :]]])
            new = np.linalg.solve(J, np.append(np.zeros_like(H), 1.0))
            new /= math.sqrt(float(weights @ new**2))
            turn = float(weights @ (new * tangent))
            tangent = new
            while True:
                moved = self._corrected(H, d, tangent, weights, step)
                if moved is not None:
                    break
                step *= 0.5
                if step < _SMALLEST:
                    raise RuntimeError(f"no step at delta = {d}, P = {found[-1][1]}")
            H, d, iterations = moved
            step = min(
                step * (1.3 if iterations <= 3 and turn > 0.0 else 0.8), _STEP * max(1.0, abs(found[-1][1])) ** 0.5
            )
            found.append((d, self.load(H)))
            if np.min(H) > 4.0:
                return np.array(found).T
        raise RuntimeError(f"no separation in {_STEPS} steps")

    def _corrected(self, H0, d0, tangent, weights, step):
        H, d = H0 + step * tangent[:-1], d0 + step * tangent[-1]
        if np.min(H) <= -0.75:
            return None
        row = weights * tangent
        factors = None
        for iteration in range(1, 9):
            R = np.append(self.residual(H, d), row @ (np.append(H - H0, d - d0)) - step)
            if factors is None or iteration % 2 == 1:
                J = np.block([[self.jacobian(H), np.ones((len(H), 1))], [row[None, :]]])
                factors = lu_factor(J, check_finite=False)
            x = lu_solve(factors, -R, check_finite=False)
            change = float(np.max(np.abs(x[:-1]) / (1.0 + np.abs(H))))
            if change > 0.3:
                return None
            H, d = H + x[:-1], d + x[-1]
            if np.min(H) <= -0.9:
                return None
            if change < 1e-7:
                return H, d, iteration
        return None


def least_load(problem: Problem, height: float, width: float = 0.12) -> float:
    """Smallest load on the path from a displacement beyond roughness of that height; coarse.

    Raises
    ------
    RuntimeError
        When the path is not found.
    """
    displacement = 6.0 + 1.3 * height + 2.0 * problem.mu
    radii = np.linspace(0.0, 40.0, 4001)
    reached = radii[problem.punch.height(radii) < displacement + 4.0 * problem.mu]
    load = BruteForce(problem, width, max(6.0, float(reached[-1]))).path(displacement)[1]
    return float(np.min(load))
