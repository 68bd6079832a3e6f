"""Stability: signs at folds, margins against two dimensions, limits."""

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from scipy.fft import irfft2, rfft2
from scipy.sparse.linalg import LinearOperator, eigsh

from fscm import Analysis, Problem, equilibria, trace
from fscm._surface.state import State
from fscm.stability import margins, stability_of, stable_sections
from tests.fscm.solved_once import analysis_of, path_of
from tests.marks import heavy


def _state(problem: Problem, central_gap: float) -> State:
    (state,) = equilibria(problem, "central_gap", central_gap)
    return state._state


def _plane_spectrum(state: State, points: int) -> np.ndarray:
    """Largest eigenvalues of sqrt(p') K sqrt(p') on a square grid in the plane, where no mode is known.

    The point force acts at a distance; at its own point the kernel has the weight that makes the sum over the grid
    exact to third order, -sum' |j|^-s = -4 zeta(s/2) beta(s/2), s = 1 + k.
    """
    disc, half = state.disc, 8.0
    h = 2.0 * half / points
    x = (np.arange(points) + 0.5) * h - half
    r = np.hypot(*np.meshgrid(x, x))
    root = np.sqrt(disc.problem.law.slope(disc.mesh.evaluate(state.gap, (r / state.scale).ravel()))).reshape(r.shape)
    s = 1.0 + disc.problem.k
    offset = np.arange(2 * points)
    offset = np.minimum(offset, 2 * points - offset) * h
    distance = np.hypot(*np.meshgrid(offset, offset))
    distance[0, 0] = 1.0
    kernel = distance**-s
    beta = 4.0 ** (-s / 2) * (mpmath.zeta(s / 2, mpmath.mpf(1) / 4) - mpmath.zeta(s / 2, mpmath.mpf(3) / 4))
    kernel[0, 0] = -4.0 * float(mpmath.zeta(s / 2) * beta) * h**-s
    factor = disc.problem.compliance * (1.0 - disc.problem.k) / (2.0 * math.pi) * h * h
    transformed, size = factor * rfft2(kernel), (2 * points, 2 * points)

    def product(v: np.ndarray) -> np.ndarray:
        moved = irfft2(transformed * rfft2(root * v.reshape(r.shape), size), size)
        return (root * moved[:points, :points]).ravel()

    operator = LinearOperator((points**2, points**2), matvec=product, dtype=float)
    start = np.random.default_rng(1).random(points**2)
    return np.sort(eigsh(operator, k=12, which="LA", v0=start, tol=1e-7, return_eigenvectors=False))[::-1]


@pytest.mark.parametrize("k", [*heavy(0.0), 0.4])
def test_margins_against_two_dimensions(k: float) -> None:
    """Before contact p' > 0 everywhere: the largest eigenvalue in the plane is axisymmetric, and the fourth, too."""
    state = _state(Problem(2, k, 1.0), 0.9)
    expected = 1.0 - margins(state, 2)
    # Two pairs of motions cos(m theta), sin(m theta) are behind the second one: m = 0, 1, 1, 0, 2, 2.
    coarse, fine = (np.max(np.abs(_plane_spectrum(state, points)[[0, 3]] - expected)) for points in (128, 256))
    # Measured 4e-4 (k = 0.4) and 5e-5 (k = 0); of third order.
    assert fine < 1e-3
    assert fine < 0.25 * coarse


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.4, 1.0), *heavy((5.0, 0.2, 2.0), (1.0, 0.0, 1.2))])
def test_margin_is_zero_at_the_folds_of_the_displacement(n: float, k: float, mu: float) -> None:
    model = analysis_of(Problem(n, k, mu))
    for event in ("jump_in", "jump_out"):
        stability = stability_of(model.event(event).value)
        # Measured worst 4e-12 (n = 2, k = 0.6, mu = 3).
        assert abs(stability.margin) < 1e-9
    at_pull_off = stability_of(model.event("pull_off").value)
    assert at_pull_off.margin > 1e-2
    assert abs(at_pull_off.stiffness) < 1e-8


@pytest.mark.parametrize(
    ("n", "k", "mu", "folds"),
    [
        (2.0, 0.4, 0.3, 1),
        (2.0, 0.4, 1.0, 3),
        *heavy((5.0, 0.2, 2.0, 5), (2.0, 0.6, 3.0, 13)),
    ],
)
def test_marks_change_at_folds_and_agree_with_eigenvalues(n: float, k: float, mu: float, folds: int) -> None:
    """The marks of the path come from the folds, those of a state from eigenvalues: same in every section."""
    problem = Problem(n, k, mu)
    path = path_of(problem)
    assert len(path.folds) == folds
    at = [int(np.argmin(np.abs(path.central_gap - fold.central_gap))) for fold in path.folds]
    for marks, quantity in ((path.stable_under_displacement, "displacement"), (path.stable_under_load, "load")):
        changes = {i + 1 if marks[i] else i for i in np.flatnonzero(np.diff(marks))}
        assert changes <= {i for i, fold in zip(at, path.folds, strict=True) if fold.quantity == quantity}
    assert path.stable_under_displacement[[0, -1]].all()
    assert list(path.stable_under_load[[0, -1]]) == [False, True]
    for start, end in pairwise([0, *at, len(path.load) - 1]):
        middle = (start + end) // 2
        if start < middle < end:
            (state,) = equilibria(problem, "central_gap", float(path.central_gap[middle]))
            assert state.stable_under_displacement == path.stable_under_displacement[middle]
            assert state.stable_under_load == path.stable_under_load[middle]


def test_several_states_at_one_displacement_or_load() -> None:
    """Under displacement control the outer two of three can be held, under load control the last of two."""
    problem = Problem(2, 0.4, 3.0)
    marks = [(s.stable_under_displacement, s.stable_under_load) for s in equilibria(problem, "displacement", -4.0)]
    assert marks == [(True, False), (False, False), (True, False)]
    assert [s.stable_under_load for s in equilibria(problem, "load", -1.0)] == [False, True]


def test_a_path_that_begins_behind_a_fold() -> None:
    """The unstable directions of the first state are counted, not assumed."""
    path = trace(Problem(2, 0.4, 1.0), start_gap=0.3)
    assert not path.stable_under_displacement[0]
    assert path.stable_under_displacement[-1]


@pytest.mark.parametrize(("apart", "stable"), [(0.0, True), (1e-7, False)])
def test_only_folds_in_no_order_are_counted_from_the_end_of_the_path(apart: float, stable: bool) -> None:
    """A fold too many, where the path coils up or where another one was missed."""
    model = Analysis(Problem(n=2, k=0.4, mu=1.0))
    folds = [(fold.quantity, fold.displacement) for fold in model.folds]
    start, end = model.points[0], model.points[-1]
    assert stable_sections(start, end, folds)[-1][0]
    name, displacement = folds[1]
    sections = stable_sections(start, end, [*folds[:2], (name, displacement + apart), *folds[2:]])
    assert sections[0][0]
    assert sections[-1][0] == stable
