"""Pull-off forces of many problems: values and bounds of the batches, and what they leave to `fscm.solve`."""

import csv
import re
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

from fscm import Problem, solve, solve_many
from fscm import many as module
from fscm._many import bounds, equilibrium, guess, pull_off
from fscm._many.bounds import _BESIDE, _Defect, missed_share
from fscm._many.guess import guesses
from fscm._many.kernels import Kernels, are_apart
from fscm._many.meshes import CommonMesh
from fscm._many.response import INTERVALS, Orders, ResponseTable, assembled, scales
from fscm._surface.deformation import response_blocks
from fscm._surface.kernel import kernel_of
from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm.interpolation.builder import pull_off_states
from tests.marks import heavy

#: Problems on few meshes: rigid and soft, flat and sharp; the last one in the upper interval of k.
FEW = np.array([(2.0, 0.0, 0.5), (2.0, 0.0, 1.0), (1.0, 0.2, 0.05), (6.0, 0.3, 0.01), (2.0, 0.72, 0.05)])
CORNERS = [(n, k, mu) for n in (1.0, 1.001, 2.0, 6.0) for k in (0.0, 0.4, 0.8) for mu in (0.01, 10.0)]


def finer(problem):
    return solve(Problem(*map(float, problem)), "pull_off_force", accuracy="fine")


def assert_within(found, n, k, mu):
    for value, bound, problem in zip(found.value, found.u_num, zip(n, k, mu, strict=True), strict=True):
        reference = finer(problem)
        assert abs(value - reference.value) <= bound + reference.u_num, problem


@pytest.fixture(scope="module")
def few():
    return solve_many(*FEW.T, "pull_off_force")


def test_values_of_a_batch_are_within_their_bounds(few):
    assert few.count("batch") == len(FEW)
    assert np.all(few.u_num <= 1e-8 * few.value)
    assert_within(few, *FEW.T)


@pytest.mark.parametrize("mu", heavy(0.01, 10.0))
def test_values_at_the_ends_of_the_range_are_within_their_bounds(mu):
    corners = np.array([corner for corner in CORNERS if corner[2] == mu])
    assert_within(solve_many(*corners.T, "pull_off_force"), *corners.T)


@pytest.mark.heavy
def test_stored_forces_of_random_problems_are_within_the_bounds():
    with (Path(__file__).parent / "random_problems.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["quantity"] == "pull_off_force" and row["status"] == "value"]
    n, k, mu, value = (np.array([float(row[name]) for row in rows]) for name in ("n", "k", "mu", "value"))
    inside = (n >= 1.0) & (n <= 6.0) & (k <= 0.8) & (mu >= 0.01) & (mu <= 10.0)
    assert inside.sum() > 10
    found = solve_many(n[inside], k[inside], mu[inside], "pull_off_force")
    assert np.all(abs(found.value - value[inside]) <= found.u_num + 1e-10 * value[inside])


@pytest.mark.heavy
def test_hardly_a_random_problem_is_left_to_the_solver():
    random = np.random.default_rng(7)
    n, k = 1.0 / random.uniform(1.0 / 6.0, 1.0, 300), random.uniform(0.0, 0.8, 300)
    mu = np.exp(random.uniform(np.log(0.01), np.log(10.0), 300))
    loads = pull_off.pull_off_forces(n, k, mu)
    assert np.isnan(loads.load).sum() <= 2
    for i in range(0, 300, 6):
        reference = finer((n[i], k[i], mu[i]))
        assert not abs(loads.load[i] - reference.value) > loads.bound[i] + reference.u_num


def whatever_the_bound(monkeypatch, *problem):
    """Force and bound of a problem of a batch without a limit of the bound, and without the atlas."""
    monkeypatch.setattr(pull_off, "RELATIVE_BOUND", np.inf)
    monkeypatch.setattr(pull_off, "atlas", lambda *_: (np.full(1, 0.0), np.full(1, np.inf)))
    loads = pull_off.pull_off_forces(*(np.array([number]) for number in problem))
    return float(loads.load[0]), float(loads.bound[0])


def with_longer_panels(monkeypatch, coarser):
    """Leave the narrowest panels at the edge out."""
    original = pull_off.panels_for

    def without(*arguments):
        return [panels._replace(edge=panels.edge - coarser) for panels in original(*arguments)]

    monkeypatch.setattr(pull_off, "panels_for", without)


def with_first_orders(monkeypatch, chosen):
    intervals = [each._replace(orders=each.orders._replace(first=chosen(each.orders))) for each in INTERVALS]
    monkeypatch.setattr(pull_off, "INTERVALS", intervals)


@pytest.mark.parametrize("coarser", [4, *heavy(3, 5)])
def test_a_mesh_that_is_too_coarse_shows_in_the_bound(monkeypatch, coarser):
    with_longer_panels(monkeypatch, coarser)
    value, bound = whatever_the_bound(monkeypatch, 2.0, 0.35, 3.0)
    reference = finer((2.0, 0.35, 3.0))
    assert reference.u_num < abs(value - reference.value) <= bound


@pytest.mark.parametrize("coarser", [3, *heavy(2, 4)])
def test_the_residual_alone_bounds_the_error_of_a_mesh_that_is_too_coarse(monkeypatch, coarser):
    """Two equal solutions have no difference.  The load is corrected by what the residual sees of its error."""
    with_longer_panels(monkeypatch, coarser)
    with_first_orders(monkeypatch, lambda orders: (orders.coarse,))
    value, bound = whatever_the_bound(monkeypatch, 2.0, 0.35, 3.0)
    reference = finer((2.0, 0.35, 3.0))
    assert reference.u_num < abs(value - reference.value) <= 0.02 * bound


def test_a_mesh_that_ends_too_early_shows_in_the_bound(monkeypatch):
    """Both solutions neglect the same deformation behind it."""
    original = pull_off.panels_for
    monkeypatch.setattr(pull_off, "panels_for", lambda *at: [panels._replace(far=2) for panels in original(*at)])
    value, bound = whatever_the_bound(monkeypatch, 2.0, 0.0, 0.5)
    reference = finer((2.0, 0.0, 0.5))
    assert reference.u_num < abs(value - reference.value) <= bound


def test_a_value_with_a_large_bound_is_not_certified(monkeypatch):
    with_longer_panels(monkeypatch, 6)
    assert np.isnan(pull_off.pull_off_forces(*np.array([[2.0], [0.35], [3.0]])).load)


def test_the_bound_holds_the_difference_of_two_solutions(monkeypatch, few):
    """A poor first solution leaves the value as it is, within a larger bound."""
    with_first_orders(monkeypatch, lambda _: (4,))
    value, bound = whatever_the_bound(monkeypatch, *FEW[1])
    assert abs(value - few.value[1]) <= few.u_num[1]
    assert bound > 100.0 * few.u_num[1]


def test_the_bound_holds_what_the_nodes_of_the_higher_order_miss(monkeypatch, few):
    monkeypatch.setattr(bounds, "missed_share", lambda k, fine: 1e4 * missed_share(k, fine))
    assert whatever_the_bound(monkeypatch, *FEW[1])[1] > 10.0 * few.u_num[1]


def test_a_poor_first_solution_is_replaced(monkeypatch, few):
    with_first_orders(monkeypatch, lambda orders: (4, orders.first[0]))
    loads = pull_off.pull_off_forces(*FEW[1:2].T)
    assert abs(loads.load[0] - few.value[1]) <= few.u_num[1]
    assert loads.bound[0] == pytest.approx(few.u_num[1], rel=0.01)


@pytest.mark.heavy
def test_shares_of_several_processes_are_as_certain_as_one_batch(few):
    """As `docs/sweeps.md` divides them: the meshes of a share are others, so the values agree within both bounds."""
    shares = np.array_split(FEW[np.argsort(-FEW[:, 1])], 2)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        parts = list(pool.map(partial(solve_many, quantity="pull_off_force"), *(
            [share[:, column] for share in shares] for column in range(3)
        )))  # fmt: skip
    order = np.argsort(np.argsort(-FEW[:, 1]))
    value, u_num = (np.concatenate([getattr(part, name) for part in parts])[order] for name in ("value", "u_num"))
    assert np.all(np.abs(value - few.value) <= u_num + few.u_num)
    assert np.all(u_num <= 1e-8 * value)


@pytest.mark.heavy
def test_the_narrowest_edges_are_within_their_bounds():
    """The response between narrow panels expands slowly in k, and the deformation is most singular there."""
    problems = np.array([(1.0, 0.8, 10.0), (1.2079, 0.7962, 7.318), (1.0066616, 0.7879862, 9.6661776)])
    assert_within(solve_many(*problems.T, "pull_off_force"), *problems.T)


def test_the_adjoint_of_a_coarse_solution_moves_a_narrow_edge_as_that_of_a_fine_one():
    """Its equation at a fixed radius hardly determines that motion: it would be wrong by a sixth for order 4."""
    by_order = []
    for order in (4, 7):
        batch, states = states_of_order(order, 2.0, 0.68, 4.0)
        inside = batch.mesh.fine.node_offsets < 0.0
        by_order.append(_Defect(batch, states).by_pressure[0, inside][-1])
    assert by_order[0] == pytest.approx(by_order[1], rel=0.01)


def states_of_order(order, *problem):
    n, k, mu = (np.array([number]) for number in problem)
    guess = guesses(n, k, mu)
    ((panels, group),) = pull_off.groups_of(n, k, guess, np.arange(1)).items()
    interval = INTERVALS[1]._replace(orders=Orders((order,), order, 12, 8))
    mesh = CommonMesh(panels, ResponseTable(interval, [panels.offsets]))
    return pull_off.solved(mesh, mesh.first[0], n, k, mu, guess, group)[:2]


@pytest.mark.heavy
def test_an_error_that_both_solutions_have_is_within_the_bound():
    """The error is 1.4e-10 of the force, and the difference of the solutions a tenth of it."""
    problem = (5.8823, 0.79521, 9.8626)
    found, reference = solve_many(*problem, "pull_off_force"), finer(problem)
    assert found.method == "batch"
    assert abs(found.value - reference.value) + reference.u_num < 0.5 * found.u_num


def test_a_value_that_the_atlas_contradicts_is_not_certified(monkeypatch):
    original = pull_off.atlas
    monkeypatch.setattr(pull_off, "atlas", lambda *at: (original(*at).value * (1.0 + 1e-4), original(*at).bound))
    assert np.all(np.isnan(pull_off.pull_off_forces(*FEW[:1].T).load))


def test_a_maximum_of_the_load_is_not_certified(monkeypatch):
    original = equilibrium.stationary_states

    def turned(*arguments):
        states = original(*arguments)
        return states._replace(curvature=-states.curvature)

    monkeypatch.setattr(pull_off, "stationary_states", turned)
    assert np.all(np.isnan(pull_off.pull_off_forces(*FEW[:1].T).load))


def test_a_wrong_guess_gives_the_same_value_or_none(monkeypatch, few):
    original = pull_off.guesses

    def wrong(*arguments):
        right = original(*arguments)
        return right._replace(log_scale=right.log_scale + 0.1, inside=right.inside + 0.05, outside=right.outside * 0.9)

    monkeypatch.setattr(pull_off, "guesses", wrong)
    loads = pull_off.pull_off_forces(*FEW[:2].T)
    known = ~np.isnan(loads.load)
    assert np.all(abs(loads.load - few.value[:2])[known] <= (loads.bound + few.u_num[:2])[known])


def test_what_the_batch_leaves_is_solved_one_by_one(monkeypatch):
    def none(n, k, mu):
        return pull_off.Loads(np.full(n.shape, np.nan), np.full(n.shape, np.nan))

    monkeypatch.setattr(module, "pull_off_forces", none)
    found, alone = solve_many(2.0, 0.0, [[1.0]], "pull_off_force"), solve(Problem(2.0, 0.0, 1.0), "pull_off_force")
    assert (found.method.tolist(), found.value.tolist(), found.u_num.tolist()) == (
        [["solve"]],
        [[alone.value]],
        [[alone.u_num]],
    )


def test_problems_outside_the_range_and_other_quantities_are_solved_one_by_one():
    found = solve_many([2.0, 6.5], [1.0, 0.0], 0.1, "pull_off_force")
    assert found.method.tolist() == ["solve", "solve"]
    assert found.value[0] == solve(Problem(2.0, 1.0, 0.1), "pull_off_force").value


def test_a_problem_without_the_event_has_a_reason():
    found = solve_many(2.0, 0.0, [0.1, 2.0], "jump_in_gap")
    assert np.isnan(found.value).tolist() == [True, False]
    assert found.status.tolist() == ["NoSuchEvent", "value"]
    assert "no jump" in found.reason[0]
    assert found.reason[1] == ""


def test_a_problem_that_does_not_converge_has_a_reason():
    found = solve_many(2.0, [0.999, 1.0], 1.0, "pull_off_force")
    assert found.status.tolist() == ["NotConverged", "value"]
    assert np.isnan([found.value, found.u_num]).tolist() == [[True, False], [True, False]]
    assert found.reason[0] != ""


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (([2.0, -1.0], 0.0, 1.0, "pull_off_force"), ["problem 1", "n = -1"]),
        ((2.0, [0.0, 0.1, 1.5], 1.0, "pull_off_force"), ["problem 2", "k = 1.5"]),
        ((2.0, 0.0, [np.nan], "pull_off_force"), ["problem 0", "mu = nan"]),
        ((2.0, "a", 1.0, "pull_off_force"), ["k = 'a'"]),
        (([2.0, 3.0], [0.1, 0.2, 0.3], 1.0, "pull_off_force"), ["(2,)", "(3,)"]),
        ((2.0, 0.0, 1.0, "force"), ["'force'"]),
    ],
)
def test_a_bad_argument_is_refused(arguments, said):
    with pytest.raises(ValueError, match=re.escape(said[0])) as refused:
        solve_many(*arguments)
    assert all(part in str(refused.value) for part in said)


@pytest.mark.parametrize(
    ("interval", "deepest", "step"),
    [
        (INTERVALS[0], 14, 3),
        (INTERVALS[1], 6, 1),
        *heavy((INTERVALS[1], 29, 3), (INTERVALS[2], 45, 3), (INTERVALS[0], 14, 1), (INTERVALS[2], 20, 1)),
    ],
)
def test_the_bound_of_the_response_exceeds_the_error_of_its_expansion(interval, deepest, step):
    """Between the narrowest panels of the range, from them to wide ones, and between panels that double."""
    halves = 0.5 ** np.arange(1.0, deepest + 1.0, step)
    offsets = np.concatenate([[-1.0], -halves, [0.0], halves[::-1], [1.0, 2.0]])
    orders, count = interval.orders, len(offsets) - 1
    table = ResponseTable(interval, [offsets])
    coefficients, uncertain = table.coefficients(offsets)
    to_fine = gauss_rule(orders.coarse).interpolation(gauss_rule(orders.fine).nodes)
    targets, sources = np.indices((count, count)).reshape(2, -1)
    for k in (interval.low, interval.low + 0.037, interval.high):
        exact = response_blocks(kernel_of(k), PanelMesh(offsets, orders.fine, 1.0), targets, sources) @ to_fine
        exact = (1.0 - k) * exact.reshape(count, count, orders.fine, orders.coarse).transpose(0, 2, 1, 3)
        at = np.array([k])
        expanded = assembled(table.polynomials(at), coefficients, scales(offsets, at))[0]
        error = np.abs(expanded.reshape(exact.shape) - exact).max(axis=(1, 3))
        assert np.all(error <= uncertain * scales(offsets, at)[0])
        assert np.max(error / np.abs(exact).max(axis=(1, 3))) < 1e-9


def test_responses_of_several_exponents_are_those_of_each():
    """Both zones of the kernel, between panels on both sides of the edge, narrow and wide."""
    offsets = np.array([-1.0, -0.96, -0.5, -1e-6, 0.0, 1e-6, 1.0, 7.0, 50.0])
    exponents, mesh = np.array([1e-3, 0.4, 0.8]), PanelMesh(offsets, 12, 1.0)
    targets, sources = np.indices((8, 8)).reshape(2, -1)
    apart = are_apart(mesh, targets, sources, 0.875)
    targets, sources, unit = targets[apart], sources[apart], np.linspace(0.1, 3.0, apart.sum())
    together = Kernels(exponents).blocks(mesh, targets, sources, unit)
    for k, blocks in zip(exponents, together, strict=True):
        alone = response_blocks(kernel_of(float(k)), mesh, targets, sources, 0.875)
        assert np.allclose(blocks, (1.0 - k) * unit[:, None, None] ** k * alone, rtol=1e-13, atol=0.0)


def test_the_series_of_states_are_fitted_to_states_of_the_batches(monkeypatch, tmp_path):
    """A series of one term is the state at all nodes."""
    problem = n, k, mu = [np.full(3, number) for number in FEW[0]]
    monkeypatch.setattr(pull_off_states, "state_nodes", lambda count: problem)
    sizes = pull_off_states.fit_states(3, 0, tmp_path / "states.npz")
    assert (sizes["nodes"], sizes["terms"]) == (3.0, 1.0)
    monkeypatch.setattr(guess, "DATA", tmp_path / "states.npz")
    guess._stored.cache_clear()
    fitted = guess.guesses(n, k, mu)
    monkeypatch.undo()
    guess._stored.cache_clear()
    displacement = solve(Problem(*map(float, FEW[0])), "pull_off_displacement").value
    assert abs(fitted.displacement[0] - displacement) < 1e-6
    assert np.allclose(fitted.inside, fitted.inside[0])


def graded_rule(count=45):
    """Nodes and weights on [0, 1], graded towards 0."""
    x, weights = np.polynomial.legendre.leggauss(16)
    lengths = 0.5 ** np.arange(1.0, count + 1.0)[:, None]
    return (lengths * (1.5 + 0.5 * x)).ravel(), (lengths * 0.5 * weights).ravel()


def response_of_mode(k, mode, u):
    """The integral of P_l(2v - 1) |u - v|^-k / k over [0, 1], or with -log |u - v| for k = 0."""
    polynomial, (x, weights) = np.polynomial.Legendre.basis(mode, [0.0, 1.0]), graded_rule()

    def kernel(distance):
        return -np.log(distance) if k == 0.0 else distance**-k / k

    total = np.zeros(len(u))
    for i, at in enumerate(u):
        if at > 1.0:
            total[i] = (weights * kernel(at - 1.0 + x)) @ polynomial(1.0 - x)
        else:
            for side, length in ((-1.0, at), (1.0, 1.0 - at)):
                total[i] += length * (weights * kernel(length * x)) @ polynomial(at + side * length * x)
    return total


@pytest.mark.parametrize("interval", INTERVALS)
@pytest.mark.parametrize("at_upper", [False, *heavy(True)])
def test_the_nodes_of_the_higher_order_miss_less_than_the_bound_of_what_they_miss(interval, at_upper):
    """Responses to modes that the nodes of the pressure do not resolve, on their panel and beside it."""
    k = interval.high if at_upper else interval.low
    rule = gauss_rule(interval.orders.fine)
    x, weights = graded_rule(28)
    u, weights = np.concatenate([0.5 * x, 1.0 - 0.5 * x]), 0.5 * np.concatenate([weights, weights])

    def missed(mode, start, length):
        exact, at_nodes = (response_of_mode(k, mode, start + length * points) for points in (u, rule.nodes))
        polynomials = [np.polynomial.Legendre.basis(degree, [0.0, 1.0]) for degree in range(4)]
        return length * max(
            abs((weights * exact) @ weight(u) - (rule.weights * at_nodes) @ weight(rule.nodes))
            for weight in polynomials
        )

    modes = (interval.orders.first[0], interval.orders.coarse, interval.orders.fine - 1)
    own = max(missed(mode, 0.0, 1.0) for mode in modes)
    share = missed_share(k, rule.order)
    assert 0.15 * share < own <= 0.5 * share
    for length in (0.25, 1.0, 4.0):
        assert max(missed(mode, 1.0, length) for mode in modes) <= 0.5 * _BESIDE * length * share
