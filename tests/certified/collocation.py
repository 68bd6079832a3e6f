"""The equation on the sphere at Gauss nodes, in doubles and in many digits; for approximations only."""

from __future__ import annotations

import numpy as np
from flint import arb, arb_mat

from tests.certified.sphere_form import SphereForm

_NEWTON_STEPS, _NEWTON_TOLERANCE = 60, 1e-12
# A displacement at which the gap is large, and a step that Newton's method can follow.
_START, _STEP = -1.5, 0.1


def _floats(matrix: arb_mat) -> np.ndarray:
    return np.array([[float(v) for v in row] for row in matrix.tolist()])


class Collocation:
    """Nodes in s, values of the Legendre polynomials there, and the projection on them."""

    def __init__(self, form: SphereForm) -> None:
        N = form.degree
        self.form = form
        rule = [tuple(x.mid() for x in arb.legendre_p_root(N + 1, j, weight=True)) for j in range(N + 1)]
        rows = [[arb(1) for _ in rule], [s for s, _ in rule]]
        for order in range(1, N):
            triples = zip(rule, rows[-2], rows[-1], strict=True)
            # Midpoints: the radii of the recurrence would grow exponentially.
            rows.append([(((2 * order + 1) * s * b - order * a) / (order + 1)).mid() for (s, _), a, b in triples])
        self.basis = arb_mat(rows).transpose()
        self.projection = arb_mat(
            [
                [(2 * order + 1) * w / 2 * v for (_, w), v in zip(rule, row, strict=True)]
                for order, row in enumerate(rows)
            ]
        )
        self.sigma = [((1 + s) / 2).sqrt() for s, _ in rule]
        self.x = np.array([float(v) for v in self.sigma])
        self.float_basis, self.float_projection = _floats(self.basis), _floats(self.projection)
        eigenvalues = np.array([float(form.eigenvalue(order)) for order in range(N + 1)])
        self.T = self.float_basis @ (eigenvalues[:, None] * self.float_projection)

    def coefficients(self, values: list[arb]) -> list[arb]:
        """Exact numbers near the Legendre coefficients of nodal values."""
        column = self.projection * arb_mat([[v] for v in values])
        return [column[order, 0].mid() for order in range(column.nrows())]

    def deform(self, values: list[arb], added: list[arb] | None = None) -> list[arb]:
        """T of nodal values, and of a series that is added to them."""
        coefficients = self.coefficients(values)
        if added is not None:
            coefficients = [a + b for a, b in zip(coefficients, added, strict=True)]
        column = self.basis * arb_mat([[v] for v in self.form.deformed(coefficients)])
        return [column[j, 0] for j in range(column.nrows())]

    def follow(self, delta: float) -> np.ndarray:
        """1 + H at a displacement by Newton's method in doubles, from a state of large gap."""
        W = np.zeros(len(self.x))
        for d in [*np.arange(min(_START, delta - _STEP), delta, _STEP), delta]:
            W = self._newton(float(d), W)
        return self._height(delta, W)

    def _height(self, delta: float, W: np.ndarray) -> np.ndarray:
        x, L = self.x, self.form.length
        return 1 - delta + L**2 * (1 - x**2) / (2 * x**2) + x * W

    def _newton(self, delta: float, W: np.ndarray) -> np.ndarray:
        x, identity = self.x, np.eye(len(self.x))
        for _ in range(_NEWTON_STEPS):
            h = self._height(delta, W)
            traction = -8 / 3 * (h**-3 - h**-9) / x**3
            slope = 8 * (h**-4 - 3 * h**-10) / x**2
            change = np.linalg.solve(identity - self.T * slope, self.T @ traction - W)
            step = 1.0
            while np.any(h + step * x * change < 0.5 * np.minimum(1.0, h)):
                step /= 2
            W = W + step * change
            if np.max(np.abs(change)) < _NEWTON_TOLERANCE:
                break
        return W
