"""Pull-off forces of many problems: values and bounds of the batches, and what they leave to `fscm.solve`."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest

from fscm import Problem, solve, solve_many
from fscm import many as module
from fscm._many import equilibrium, pull_off
from fscm._many.meshes import Panels
from fscm._many.response import INTERVALS, SECOND, Orders, ResponseTable, assembled
from fscm._surface.deformation import response_blocks
from fscm._surface.kernel import kernel_of
from fscm._surface.mesh import PanelMesh, gauss_rule
from tests.marks import heavy

#: Problems in the lower interval of k, on few meshes: rigid and soft, flat and sharp.
FEW = np.array([(2.0, 0.0, 0.5), (2.0, 0.0, 1.0), (1.0, 0.2, 0.05), (6.0, 0.3, 0.01), (2.0, 0.399, 0.5)])
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
    assert np.isnan(loads.load).sum() <= 9
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
    monkeypatch.setattr(Panels, "finer", property(lambda panels: panels))
    monkeypatch.setattr(pull_off, "SECOND", pull_off.FIRST)
    value, bound = whatever_the_bound(monkeypatch, 2.0, 0.35, 3.0)
    reference = finer((2.0, 0.35, 3.0))
    assert reference.u_num < abs(value - reference.value) <= 0.02 * bound


def test_a_value_with_a_large_bound_is_not_certified(monkeypatch):
    with_longer_panels(monkeypatch, 3)
    assert np.isnan(pull_off.pull_off_forces(*np.array([[2.0], [0.35], [3.0]])).load)


def test_the_bound_holds_the_difference_of_two_solutions(monkeypatch, few):
    """A poor first solution leaves the value as it is, within a larger bound."""
    monkeypatch.setattr(pull_off, "FIRST", Orders(6, 10, 7))
    value, bound = whatever_the_bound(monkeypatch, *FEW[1])
    assert abs(value - few.value[1]) <= few.u_num[1]
    assert bound > 100.0 * few.u_num[1]


@pytest.mark.heavy
def test_the_narrowest_edges_are_within_their_bounds():
    """The response between narrow panels expands slowly in k, and the deformation is most singular there."""
    problems = np.array([(1.0, 0.8, 10.0), (1.2079, 0.7962, 7.318), (1.0066616, 0.7879862, 9.6661776)])
    assert_within(solve_many(*problems.T, "pull_off_force"), *problems.T)


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
        guess = original(*arguments)
        return guess._replace(log_scale=guess.log_scale + 0.1, inside=guess.inside + 0.05, outside=guess.outside * 0.9)

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
    assert "no jump" in found.reason[0]
    assert found.reason[1] == ""


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


@pytest.mark.parametrize(("interval", "deepest"), [(0, 16), (1, 43)])
def test_the_last_coefficients_of_the_response_exceed_the_error_of_its_expansion(interval, deepest):
    """Between the narrowest panels of the range, and from them to wide ones."""
    low, high = INTERVALS[interval]
    halves = 0.5 ** np.arange(1.0, deepest + 1.0, 3.0)
    offsets = np.concatenate([[-1.0], -halves, [0.0], halves[::-1], [1.0, 2.0]])
    table, count = ResponseTable(low, high, SECOND), len(offsets) - 1
    coefficients = table.coefficients(offsets)
    to_fine = gauss_rule(SECOND.coarse).interpolation(gauss_rule(SECOND.fine).nodes)
    targets, sources = np.indices((count, count)).reshape(2, -1)

    def blocks(weights, of, k):
        found = assembled(weights, of, offsets, np.array([k]))[0]
        return found.reshape(count, SECOND.fine, count, SECOND.coarse).transpose(0, 2, 1, 3)

    for k in (low, low + 0.137, high):
        exact = response_blocks(kernel_of(k), PanelMesh(offsets, SECOND.fine, 1.0), targets, sources) @ to_fine
        exact = (1.0 - k) * exact.reshape(count, count, SECOND.fine, SECOND.coarse)
        error = np.abs(blocks(table.polynomials(np.array([k])), coefficients, k) - exact)
        size = np.abs(exact).max(axis=(2, 3), keepdims=True)
        last = blocks(np.ones((1, 1)), np.abs(coefficients[-2:]).sum(axis=0, keepdims=True), k)
        assert np.all(error <= last + 1e-13 * size)
        assert np.max(error / size) < 1e-11
