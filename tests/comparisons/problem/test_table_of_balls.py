"""Table of balls: what lies between its rows, towards mu -> infinity, and at its limits."""

import itertools

import numpy as np
import pytest

from comparisons.description import strain_errors
from comparisons.description.changes import Change, between, towards
from comparisons.description.strain_errors import POISSON_RATIOS, SOFTNESS, body_change, shape_change, strain_change
from comparisons.description.third_order import strain_limit
from tests.comparisons.problem.strain_table import forces_of_a_ball

SHAPE, BODY = 0, 1


@pytest.fixture
def rows_up_to(monkeypatch):
    """A function that leaves rows of larger Tabor numbers out of the table."""
    complete = strain_errors._table()

    def leave_out(mu, softness, nu):
        table = {key: dict(rows) for key, rows in complete.items()}
        table[softness, nu] = {number: row for number, row in table[softness, nu].items() if number <= mu}
        monkeypatch.setattr(strain_errors, "_table", lambda: table)
        for function in (strain_errors._strains, strain_errors._shares):
            function.cache_clear()

    yield leave_out
    monkeypatch.undo()
    for function in (strain_errors._strains, strain_errors._shares):
        function.cache_clear()


def test_strain_at_larger_tabor_numbers_is_inside_the_uncertainty_of_smaller_ones(rows_up_to):
    """The rows of the first w/(E* R) lead towards the limit; those of the others follow them."""
    worst = 0.0
    for softness, nu in itertools.product(SOFTNESS, POISSON_RATIOS):
        numbers = sorted(strain_errors._strains(softness, nu))
        rows = {mu: strain_errors._strains(softness, nu)[mu] for mu in numbers}
        for last, mu in itertools.combinations([number for number in numbers if number >= 1.0], 2):
            if softness == SOFTNESS[0] and last < 5.0:
                continue
            rows_up_to(last, softness, nu)
            change = strain_errors._strain_at(softness, mu, nu)
            worst = max(worst, abs(rows[mu].value - change.value) / (change.uncertainty + rows[mu].uncertainty))
            rows_up_to(np.inf, softness, nu)
    assert 0.5 < worst < 1.0


@pytest.mark.parametrize("mechanism", [SHAPE, BODY])
def test_shape_and_area_at_larger_tabor_numbers_are_inside_the_uncertainty_of_smaller_ones(mechanism):
    for softness in SOFTNESS:
        nodes = strain_errors._shares(softness, mechanism)
        for last, mu in itertools.combinations(sorted(number for number in nodes if number >= 2.0), 2):
            change = towards(Change(1.0, 0.0), nodes[last], last / mu)
            assert abs(nodes[mu].value - change.value) <= change.uncertainty + nodes[mu].uncertainty, (softness, mu)
            assert change.uncertainty < 0.25


def test_between_rows_the_error_is_inside_the_bound():
    """A row that is left out, from its neighbours in w/(E* R)."""
    roots, ratios = np.cbrt(SOFTNESS), []
    columns = [lambda softness, nu=nu: strain_errors._strains(softness, nu) for nu in POISSON_RATIOS]
    columns += [lambda softness, of=of: strain_errors._shares(softness, of) for of in (SHAPE, BODY)]
    for column, mu in itertools.product(columns, (0.3, 1.0, 2.0)):
        nodes = [column(softness).get(mu) for softness in SOFTNESS]
        known = [i for i, node in enumerate(nodes) if node is not None]
        for left_out in known[1:-1]:
            others = [i for i in known if i != left_out]
            change = between(roots[others], [nodes[i] for i in others], roots[left_out])
            ratios.append(abs(change.value - nodes[left_out].value) / change.uncertainty)
    assert 0.5 < max(ratios) < 1.0


def test_the_area_of_another_poisson_ratio_is_that_of_the_incompressible_solid_within_its_uncertainty():
    shares = []
    for softness, nu in itertools.product(SOFTNESS, POISSON_RATIOS[:-1]):
        for mu, node in strain_errors._shares(softness, BODY, nu).items():
            distance = abs(node.value - strain_errors._shares(softness, BODY)[mu].value)
            shares.append(distance / (strain_errors.OTHER_RATIOS * np.cbrt(softness)))
    assert 0.5 < max(shares) < 1.0


def test_shape_and_potential_of_a_ball_on_a_rigid_solid():
    """Both loads of the ball are one integral but for its shape beyond 0.95 R, whose effect falls as (z0/R)^2."""
    shapes, bodies = zip(*map(strain_errors.rigid_changes, (0.02, 0.01)), strict=True)
    assert bodies[0] / bodies[1] == pytest.approx(4.0, rel=0.02)
    assert shapes[0] / shapes[1] == pytest.approx(2.0, rel=0.02)
    # To first order the force 2 pi int (R - t) p(z0 + t) dt is smaller by int t p dt / (R int p dt) = (9/7) z0/R.
    assert shapes[1] == pytest.approx(-9.0 / 7.0 * 0.01, rel=0.02)
    # By the elements at w/(E* R) = 1e-3 and mu = 0.02, a stiff ball for its z0 of R/2.
    assert strain_errors.rigid_changes(0.5)[BODY] == pytest.approx(-0.0966, abs=1e-3)


def test_the_limits_of_the_table():
    small, smaller = strain_change(1e-5, 1.0, 0.5), strain_change(1e-8, 1.0, 0.5)
    assert smaller.value == pytest.approx(small.value / 10.0, rel=0.05)
    assert strain_change(1e-3, 0.05, 0.5).uncertainty < 1e-4
    assert strain_change(0.11, 1.0, 0.5) is body_change(0.11, 1.0, 0.5) is shape_change(0.11, 1.0) is None
    assert body_change(1e-3, 1e6, 0.5).value == pytest.approx(1.002354 / 0.990819 - 1.0, rel=2e-3)
    assert shape_change(5e-3, 1e6).value == pytest.approx(0.973699 - 1.0, rel=2e-3)


@pytest.mark.parametrize("nu", [0.0, 0.2, 0.5])
def test_strain_at_a_small_softness_tends_to_the_energy_of_third_order(nu):
    """The contact radius at the pull-off of JKR is (9 pi/8)^(1/3) x; the term of second order is x times that."""
    change = strain_change(1e-5, 1e7, nu)
    x = 1e-5 ** (1.0 / 3.0)
    first = strain_limit(nu) * (9.0 * np.pi / 8.0) ** (1.0 / 3.0) * x
    assert change.value == pytest.approx(first, abs=0.15 * x**2)
    assert change.uncertainty < 0.15 * x**2


@pytest.mark.heavy
@pytest.mark.parametrize(("softness", "mu", "nu"), [(5e-3, 2.0, 0.5), (4e-2, 0.6, 0.45), (2e-3, 0.05, 0.3)])
def test_rows_and_values_between_them_are_what_both_references_give(softness, mu, nu):
    body, vertical, small = forces_of_a_ball(softness, mu, nu)
    pairs = ((strain_change, vertical, small), (body_change, body, vertical))
    for function, changed, force in pairs:
        change = function(softness, mu, nu)
        bound = change.uncertainty + (changed.u_num + force.u_num) / force.value
        assert changed.value / force.value - 1.0 == pytest.approx(change.value, abs=bound)
