"""The traced path: energy balance, folds among its points, the experiment, states under each control."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from fscm import Analysis, LennardJones, NotConverged, Problem, equilibria, profile, solve, solve_together, trace
from fscm._arc_length import parameter_of, rates_of
from fscm._continuation import equilibrium_path, moved
from fscm.experiment import displacement_cycle
from tests.fscm.equilibria_on_finer_meshes import finer_analysis
from tests.fscm.marks import heavy


@pytest.mark.parametrize(
    ("n", "k", "mu"),
    [
        (2.0, 0.0, 0.3),
        (2.0, 0.4, 1.5),
        (5.0, 0.3, 1.2),
        *heavy((1.5, 0.6, 1.0), (1.0, 0.2, 0.5)),
    ],
)
def test_work_equals_change_of_energy(n: float, k: float, mu: float) -> None:
    """Elastic plus surface energy changes by the work of the load between all neighbours on the path.

    The work is the Gauss integral over the continuation parameter of P d(delta), at states solved there.
    """
    points = []
    for point in equilibrium_path(Problem(n, k, mu), 10, 1e-6, longest_step=0.2):
        points.append(point)
        if point.state.follows_edge and point.state.load > 0:
            break
    nodes, weights = np.polynomial.legendre.leggauss(6)
    worst = 0.0
    for a, b in pairwise(points):
        if a.state.follows_edge != b.state.follows_edge:
            continue
        x = [parameter_of(p.state) for p in (a, b)]
        work = 0.0
        for node, weight in zip(nodes, weights, strict=True):
            state = moved(a.state, rates_of(a.state), x[0] + 0.5 * (1 + node) * (x[1] - x[0]))
            work += 0.5 * (x[1] - x[0]) * weight * state.load * rates_of(state).displacement
        worst = max(worst, abs(b.state.energy - a.state.energy - work))
    # Meshes of tolerance 1e-6 differ between neighbours; measured worst 4e-7.
    assert worst < 3e-6


@pytest.mark.parametrize("mu", [0.3, pytest.param(3.0, marks=pytest.mark.heavy)])
def test_path_contains_the_exact_events(mu: float) -> None:
    problem = Problem(2, 0.4, mu)
    path = trace(problem)
    assert path.load.min() == pytest.approx(-solve(problem, "pull_off_force").value, abs=1e-7)
    folds = np.flatnonzero(np.diff(path.displacement) < 0)
    if mu < 0.7:
        assert folds.size == 0
    else:
        assert path.displacement[folds[0]] == pytest.approx(solve(problem, "jump_in_displacement").value, abs=1e-6)
        bottom = path.displacement[folds[-1] + 1]
        assert bottom == pytest.approx(solve(problem, "jump_out_displacement").value, abs=1e-6)
    assert path.u_load < 1e-5
    assert path.u_displacement < 1e-5


def test_uncertainty_of_the_path_is_honest() -> None:
    """States at the same central gap, solved to full accuracy."""
    problem = Problem(2, 0.4, 1.0)
    path = trace(problem)
    for i in (3, len(path.load) // 2, -5):
        (state,) = equilibria(problem, "central_gap", float(path.central_gap[i]))
        # In contact the central gap hardly moves: compare along the curve, not at equal gap.
        slope = np.gradient(path.load, path.displacement)[i]
        off = state.load - path.load[i] - slope * (state.displacement - path.displacement[i])
        assert abs(off) < path.u_load + abs(slope) * path.u_displacement + 1e-9


@pytest.mark.parametrize(
    ("control", "value", "message"),
    [("gap", 1.0, "unknown"), ("load", float("nan"), "finite"), ("central_gap", -1.0, "singular")],
)
def test_bad_control_is_refused(control: str, value: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        equilibria(Problem(2, 0.4, 1.0), control, value)


def test_cycle_encloses_the_hysteresis_energy() -> None:
    """The area between loading and unloading equals the drop of energy in the two jumps."""
    problem = Problem(2, 0.4, 1.5)
    cycle = displacement_cycle(trace(problem))
    area = -sum(np.trapezoid(c[1], c[0]) for c in (cycle.loading, cycle.unloading))
    exact = solve(problem, "hysteresis_energy").value
    assert abs(area) == pytest.approx(exact, rel=0.02)  # trapezoids of a drawn curve
    assert cycle.jump_in is not None
    assert cycle.jump_out is not None
    assert cycle.jump_in[1, 1] < cycle.jump_in[1, 0] < 0  # attraction grows on jumping in
    assert cycle.jump_out[1, 0] < cycle.jump_out[1, 1] < 0
    assert np.all(np.diff(cycle.loading[0]) >= 0)
    assert np.all(np.diff(cycle.unloading[0]) <= 0)


def test_profiles_at_pull_off() -> None:
    """Eq. 4 closes on the profiles; the contact is flat and the edge carries the strength (Fig. 5)."""
    surface = profile(Problem(2, 0.4, 1.0))
    closure = surface.gap + surface.displacement - surface.radius**2 / 2 - surface.deformation
    assert np.max(np.abs(closure) / (1 + surface.gap)) < 1e-10
    assert surface.pressure.min() == pytest.approx(-1.0264, abs=1e-3)
    assert abs(surface.gap[0]) < 0.02


@pytest.mark.parametrize(
    ("n", "k", "mu"),
    [
        *((300.0, 0.4, 1.0), (30.0, 0.4, 1.0), (30.0, 0.0, 0.05)),
        *heavy((300.0, 0.0, 1.0), (300.0, 0.2, 0.3), (100.0, 0.4, 1.0), (50.0, 0.0, 3.0), (30.0, 0.0, 1.0)),
    ],
)
def test_steep_punches_are_solved(n: float, k: float, mu: float) -> None:
    """The deformation of a steep punch is stored beside its heights, which would round it away."""
    problem = Problem(n, k, mu)
    solution, finer = solve(problem, "pull_off_force"), finer_analysis(problem).solution("pull_off_force")
    assert abs(solution.value - finer.value) <= solution.u_num < 1e-9


@pytest.mark.parametrize("n", [100.0, 300.0])
def test_a_steep_punch_on_a_stiff_solid_has_the_pull_off_force_of_bradley(n: float) -> None:
    """P(H_0) = 2 int p(H_0 + r^n / n) r dr, its largest tension."""

    def load(H: float) -> float:
        def density(r: float) -> float:
            return 2.0 * r * float(LennardJones().traction(np.array(H + r**n / n)))

        return sum(quad(density, *ends, limit=200)[0] for ends in pairwise([0.0, 0.9, 1.0, 1.1, 1.5]))

    least = minimize_scalar(load, bounds=(0.1, 0.3), method="bounded", options={"xatol": 1e-9})
    assert solve(Problem(n, 0.2, 1e-5), "pull_off_force").value == pytest.approx(-least.fun, rel=1e-7)


@pytest.mark.heavy
def test_a_punch_near_the_least_shape_index_is_followed_in_steps_of_its_load() -> None:
    """The tail carries loads of 1e3 near n = 2/3; steps in the unit of the contact needed more than 1500 points."""
    problem = Problem(0.67, 0.4, 1.0)
    analysis = Analysis(problem)
    solution = analysis.solution("pull_off_force")
    assert len(analysis.points) < 250
    assert abs(solution.value - 206.46053308) < 1e-7  # the same with other steps, in the unit of the contact
    assert solution.u_num < 1e-8


@pytest.mark.heavy
@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.95, 1.0), (5.0, 0.95, 1.0), (2.0, 0.9, 2.0), (2.0, 0.98, 1.0)])
def test_the_edge_of_a_small_nucleus_is_followed(n: float, k: float, mu: float) -> None:
    """It is up to 1e-16 wide and its own gap is above that of largest tension: the fixed mesh needed 1e3 steps."""
    analysis = Analysis(Problem(n, k, mu))
    solution = analysis.solution("pull_off_force")
    assert len(analysis.points) < 150
    gibson = solve(Problem(n, 1.0, mu), "pull_off_force").value
    other = solve(Problem(n, 2.0 * k - 1.0, mu), "pull_off_force").value
    # Between the values at 1 and at twice the distance from 1, near their middle: measured worst 6e-3 off.
    assert abs(solution.value - 0.5 * (gibson + other)) < 2e-2
    assert solution.u_num < 1e-7


@pytest.mark.parametrize(
    ("k", "mu", "zero_load_displacement"), [(0.0, 1e5, 194888.854486038), (0.4, 1e3, 2017.03606843554)]
)
@pytest.mark.heavy
def test_an_edge_below_the_rounding_of_its_radius(k: float, mu: float, zero_load_displacement: float) -> None:
    """JKR-n-k: it is right to 5e-7 here.  A mesh that does not resolve the edge was wrong by 2e-3."""
    solutions = solve_together(Problem(2.0, k, mu), ("pull_off_force", "zero_load_displacement"))
    for solution, jkr in zip(solutions.values(), (0.5 * (3.0 + k), zero_load_displacement), strict=True):
        assert solution.value == pytest.approx(jkr, rel=5e-7)
        assert solution.u_num < 1e-6 * jkr


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.9, 100.0), (2.0, 0.99, 1.0), (2.0, 0.95, 20.0)])
def test_an_edge_too_narrow_is_refused_with_the_largest_tabor_number(n: float, k: float, mu: float) -> None:
    with pytest.raises(NotConverged, match=r"the largest Tabor number at n = 2, k = .* is mu = "):
        solve(Problem(n, k, mu), "pull_off_force")


def test_the_drawn_curve_turns_slowly():
    """The loop at n = 5, mu = 2 has several folds: 180 degrees adds no points, and then the line has corners."""
    problem = Problem(5.0, 0.4, 2.0)
    sparse, dense = trace(problem, largest_turn=180.0), trace(problem)

    def largest_turn(path):
        depth = -path.load.min()
        shown = (path.load < 0.5 * depth) & (np.abs(path.load) > 0.05 * depth)
        x, y = path.displacement / np.ptp(path.displacement[shown]), path.load / (1.5 * depth)
        chords = np.diff(np.stack([x, y]), axis=1)
        # Folds and the zero of the load may be next to a point of the path.
        long = np.hypot(*chords) > 1e-6
        angle = np.unwrap(np.arctan2(chords[1], chords[0]))
        inside = shown[1:-1] & long[1:] & long[:-1]
        return np.degrees(np.abs(np.diff(angle))[inside].max())

    assert largest_turn(sparse) > 20.0
    assert largest_turn(dense) <= 5.0
    assert len(dense.load) < 4 * len(sparse.load)
    assert [fold.displacement for fold in dense.folds] == pytest.approx(
        [fold.displacement for fold in sparse.folds], abs=dense.u_displacement + sparse.u_displacement
    )


@pytest.mark.parametrize("degrees", [0.0, -5.0, 181.0, float("nan")])
def test_a_turn_that_is_no_angle_is_refused(degrees):
    with pytest.raises(ValueError, match="largest_turn"):
        trace(Problem(2.0, 0.0, 0.3), largest_turn=degrees)
