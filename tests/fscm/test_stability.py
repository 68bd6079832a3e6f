"""Stability: signs at folds, modes against two dimensions, limits, and the order of the modes."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import legendre
from scipy.fft import irfft2, rfft2
from scipy.sparse.linalg import LinearOperator, eigsh

from fscm import Analysis, CustomPunch, NoSuchEvent, Problem, displacement_cycle, equilibria, trace
from fscm._azimuthal_kernel import azimuthal_kernel
from fscm._deformation import response_matrix
from fscm._equilibrium import State
from fscm._panels import PanelMesh
from fscm.stability import margins, stability_of

MODES = range(5)


@pytest.mark.parametrize("k", [0.0, 1e-6, 0.4, 0.8])
@pytest.mark.parametrize("m", MODES)
def test_kernel_is_the_integral_around_the_ring(k: float, m: int) -> None:
    """Near and far of the ring and on both sides of it; and the power series, close to the ring."""
    kernel = azimuthal_kernel(k, m)
    a = (1 + mpmath.mpf(k)) / 2
    # Measured worst 1e-12 (m = 4), from the powers of (1 - y)/4 in double precision.
    tolerance = 5e-12
    for r, t in [(0.1, 1.0), (0.5, 0.6), (1.3, 0.7), (2.0, 0.01)]:
        integral = mpmath.quad(
            lambda phi, r=r, t=t: mpmath.cos(m * phi) * (r * r + t * t - 2 * r * t * mpmath.cos(phi)) ** -a,
            [0, 0.1, 0.5, mpmath.pi],
        )
        value = kernel.response(np.array([r]), np.array([t]), np.array([abs(r - t)]))[0]
        assert value == pytest.approx(float(integral * t / mpmath.pi), rel=tolerance)
    r, t = 1.5, 1.5 + 1e-6
    with mpmath.workdps(30):
        x = mpmath.mpf(r) / mpmath.mpf(t)
        series = x**m * mpmath.hyp2f1(a, a + m, m + 1, x * x) * mpmath.rf(a, m) / mpmath.factorial(m)
        exact = float(series * mpmath.mpf(t) ** -k)
    assert kernel.response(np.array([r]), np.array([t]), np.array([t - r]))[0] == pytest.approx(exact, rel=tolerance)


def _derivative(mesh: PanelMesh, values: np.ndarray) -> np.ndarray:
    """d/ds on each panel."""
    to_modes, u = mesh.rule.to_modes, mesh.rule.nodes
    matrix = np.array([2.0 * legendre.legval(2.0 * u - 1.0, legendre.legder(column)) for column in to_modes.T]).T
    return (values.reshape(-1, mesh.order) @ matrix.T / mesh.lengths[:, None]).ravel()


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.4, 1.0), (3.0, 0.6, 0.7)])
def test_translation(n: float, k: float, mu: float) -> None:
    """The equation at a surface shifted along x, less the equation: (1 - K_1 p') dH/dr = df/dr."""
    state = Analysis(Problem(n, k, mu), "fine").event("pull_off").value
    disc = state.disc
    slope = _derivative(disc.mesh, state.gap) / state.scale
    K = disc.stiffness_scale(state.scale) * response_matrix(azimuthal_kernel(k, 1), disc.mesh)
    left = slope - K @ (disc.problem.law.slope(state.gap) * slope)
    # Numerical derivatives lose digits: measured worst 5e-7, beside terms of 3.
    assert np.max(np.abs(left - disc.problem.punch.slope(state.radius))[state.radius < 20.0]) < 5e-6


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


@pytest.mark.parametrize("k", [0.0, 0.4])
def test_modes_against_two_dimensions(k: float) -> None:
    """Before contact p' > 0 everywhere: the spectrum in the plane is that of m = 0 once and of every m > 0 twice."""
    state = _state(Problem(2, k, 1.0), 0.9)
    modes = np.concatenate([np.repeat(1.0 - margins(state, m, 3), 1 if m == 0 else 2) for m in range(6)])
    count = 6  # m = 0, 1, 1, 0, 2, 2; the spectrum of the grid falls slowly behind them
    expected = np.sort(modes)[::-1][:count]
    coarse, fine = (np.max(np.abs(_plane_spectrum(state, points)[:count] - expected)) for points in (128, 256))
    # Measured 4e-4 (k = 0.4) and 5e-5 (k = 0); of third order.
    assert fine < 1e-3
    assert fine < 0.25 * coarse


def test_modes_become_one_in_the_limit_of_a_gibson_solid() -> None:
    """k -> 1: the surface moves only where it is pressed, w = 2 mu^2 p, so that 2 mu^2 p' decides for every m."""
    distance = []
    for k in (0.9, 0.97, 0.99):
        problem = Problem(2, k, 0.6)
        state = _state(problem, 0.9)
        limit = 2.0 * problem.mu**2 * np.max(problem.law.slope(state.gap))
        parts = np.array([1.0 - margins(state, m)[0] for m in MODES])
        assert np.all(parts < limit)
        distance.append(limit - parts)
    assert np.all(distance[1] < 0.5 * distance[0])
    assert np.all(distance[2] < 0.5 * distance[1])
    assert np.all(distance[2] < 0.05 * limit)


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.4, 1.0), (5.0, 0.2, 2.0), (1.0, 0.0, 1.2)])
def test_margin_is_zero_at_the_folds_of_the_displacement(n: float, k: float, mu: float) -> None:
    model = Analysis(Problem(n, k, mu))
    for event in ("jump_in", "jump_out"):
        stability = stability_of(model.event(event).value)
        # Measured worst 4e-12 (n = 2, k = 0.6, mu = 3).
        assert abs(stability.margins[0]) < 1e-9
        assert stability.margins[1] > 1e-2
    at_pull_off = stability_of(model.event("pull_off").value)
    assert at_pull_off.margins[0] > 1e-2
    assert abs(at_pull_off.stiffness) < 1e-8


@pytest.mark.parametrize(
    ("n", "k", "mu", "folds"),
    [
        (2.0, 0.4, 0.3, 1),
        (2.0, 0.4, 1.0, 3),
        pytest.param(5.0, 0.2, 2.0, 5, marks=pytest.mark.heavy),
        pytest.param(2.0, 0.6, 3.0, 13, marks=pytest.mark.heavy),
    ],
)
def test_marks_change_at_folds_and_agree_with_eigenvalues(n: float, k: float, mu: float, folds: int) -> None:
    """The marks of the path come from the folds, those of a state from eigenvalues: same in every section."""
    problem = Problem(n, k, mu)
    path = trace(problem)
    assert len(path.folds) == folds
    at = [int(np.argmin(np.abs(path.central_gap - fold.central_gap))) for fold in path.folds]
    for marks, quantity in ((path.stable_under_displacement, "displacement"), (path.stable_under_load, "load")):
        changes = {i + 1 if marks[i] else i for i in np.flatnonzero(np.diff(marks))}
        assert changes <= {i for i, fold in zip(at, path.folds, strict=True) if fold.quantity == quantity}
    assert path.stable_under_displacement[[0, -1]].all()
    assert list(path.stable_under_load[[0, -1]]) == [False, True]
    for first, last in zip([0, *at], [*at, len(path.load) - 1], strict=True):
        middle = (first + last) // 2
        if first < middle < last:
            (state,) = equilibria(problem, "central_gap", float(path.central_gap[middle]))
            assert state.stable_under_displacement == path.stable_under_displacement[middle]
            assert state.stable_under_load == path.stable_under_load[middle]


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.4, 1.0), pytest.param(8.0, 0.5, 3.0, marks=pytest.mark.heavy)])
def test_a_cycle_has_stable_states_only(n: float, k: float, mu: float) -> None:
    """Approach and retreat visit every stable state of a power-law punch, and no unstable one but the folds."""
    path = trace(Problem(n, k, mu))
    cycle = displacement_cycle(path)
    stable = set(zip(path.displacement, path.load, path.stable_under_displacement, strict=True))
    visited = {(d, P) for record in (cycle.loading, cycle.unloading) for d, P in record.T}
    assert {(d, P) for d, P, held in stable if held} <= visited
    unstable = {(d, P) for d, P, held in stable if not held} & visited
    assert unstable == {tuple(jump[:, 0]) for jump in (cycle.jump_in, cycle.jump_out)}


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


@pytest.mark.heavy
def test_a_punch_with_an_asperity() -> None:
    """More folds than two: the path ends stable, and each stable branch ends in a fold of the displacement."""
    punch = CustomPunch(lambda r: -4.0 * np.expm1(-(r**2)) + r**2 / 50.0, growth=2)
    path = trace(Problem(2, 0.0, 0.5, punch=punch))
    assert path.stable_under_displacement[[0, -1]].all()
    displacement = np.diff(path.displacement)
    stable = path.stable_under_displacement[1:] & path.stable_under_displacement[:-1]
    # A stable branch rises with the displacement along the path or falls, but never turns.
    for run in np.split(displacement[stable], np.flatnonzero(np.diff(np.flatnonzero(stable)) > 1) + 1):
        assert np.all(run > 0.0) or np.all(run < 0.0)


@pytest.mark.heavy
@settings(max_examples=6, derandomize=True)
@given(
    n=st.floats(1.0, 6.0),
    k=st.floats(0.0, 0.8),
    mu=st.floats(0.1, 2.5),
    central_gap=st.floats(0.02, 1.5),
)
def test_no_other_mode_is_unstable_before_the_axisymmetric_one(
    n: float, k: float, mu: float, central_gap: float
) -> None:
    """The margin rises with m, as derived in `fscm.stability`; stable and unstable states alike."""
    stability = stability_of(_state(Problem(n, k, mu), central_gap))
    assert np.all(np.diff(stability.margins) > 0.0)
    assert stability.margins[-1] < 1.0


def test_events_that_do_not_exist_have_no_margin() -> None:
    """Below the critical Tabor number the smallest margin of the path stays positive."""
    model = Analysis(Problem(2, 0.0, 0.5))
    with pytest.raises(NoSuchEvent):
        model.event("jump_in")
    assert min(margins(point.state, 0)[0] for point in model.points) > 0.1
