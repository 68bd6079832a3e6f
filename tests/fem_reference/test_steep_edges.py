"""Finite strain under tensions of many moduli: stiffness of the volume, states carried over to other elements."""

from dataclasses import replace

import numpy as np
import pytest

from fem_reference import Ball, LennardJones, NeoHookean, Problem, solve_large_strain
from fem_reference._elastic.elasticity import gauss_product
from fem_reference._elastic.mesh import edge_grid, uniform_grid
from fem_reference._elastic.tensor_elements import unit_functions
from fem_reference._large_strain.block import block_of
from fem_reference._large_strain.core import core_of
from fem_reference._large_strain.discretisation import linear_event
from fem_reference._large_strain.equilibrium import State
from fem_reference._large_strain.events import Family
from fem_reference._large_strain.transfer import _fields, _projected, carried_over
from fem_reference.large_strain import _discretisation


def ball(number, mu, nu=0.5):
    law = LennardJones(1.0, number ** (2 / 3) / mu)
    return Problem(NeoHookean((1.0 - nu**2) / number, nu), Ball(1.0), law)


@pytest.mark.parametrize("tension", [4.0, 12.0, 40.0])
def test_volumes_have_a_stiffness_under_a_mean_tension_of_many_moduli(tension):
    """What the pressures do not resolve, of an incompressible solid with the shear modulus 1."""

    def incompressible(z):
        return np.ones_like(z), np.zeros_like(z)

    core = core_of(uniform_grid(1.0, 1), incompressible, 5, True, tension)
    pressures = core.no_pressure()
    pressures[:, 0] = tension
    K, _ = core._linearised(slice(None), np.zeros(core.size), pressures, 1.0)
    inside = slice(core.sides.shape[1], None)
    assert np.linalg.eigvalsh(K[0, inside, inside]).min() > 0.0


def state_on(grid, order, mixed=True):
    """A state of any displacement and pressure, without a punch."""
    block = block_of(grid, NeoHookean(1.0, 0.5 if mixed else 0.3), order, mixed)
    random = np.random.default_rng(4)
    u, pressures = random.normal(size=block.core.size), block.core.no_pressure()
    u[block.fixed] = 0.0
    pressures += random.normal(size=pressures.shape)
    return State(block, object(), u, pressures, -0.1)


@pytest.mark.parametrize("mixed", [True, False])
def test_a_state_is_the_same_on_elements_that_contain_its_functions(mixed):
    grid = edge_grid(1.0, 0.3, 0.3, 4.0, 0.8)
    coarse, fine = state_on(grid, 3, mixed), state_on(grid, 5, mixed)
    there = carried_over(coarse, fine.block, fine.surface)
    back = carried_over(there, coarse.block, coarse.surface)
    assert there.block is fine.block
    assert there.surface is fine.surface
    assert there.delta == coarse.delta
    assert np.abs(back.u - coarse.u).max() < 1e-10
    s = np.linspace(0.0, 4.0, 37)
    for component in (0, 1):
        values = [state.block.trace.evaluate(s) @ state.u[state.block.radial + component] for state in (coarse, there)]
        assert np.abs(values[0] - values[1]).max() < 1e-10
    if mixed:
        assert np.abs(back.pressures - coarse.pressures).max() < 1e-10
        assert np.linalg.norm(there.pressures) > 0.1


def test_a_smooth_state_is_near_on_other_elements_and_zero_where_it_is_fixed():
    fine, coarse = (state_on(edge_grid(1.0, 0.3, 0.3, 4.0, density), 5) for density in (0.7, 0.9))
    assert np.all(carried_over(fine, coarse.block, coarse.surface).u[coarse.block.fixed] == 0.0)
    smooth = np.zeros_like(fine.u)
    nodes = fine.block.trace.nodes
    smooth[fine.block.radial[: nodes.size] + 1] = np.exp(-nodes)
    there = carried_over(replace(fine, u=smooth), coarse.block, coarse.surface)
    s = np.linspace(0.0, 4.0, 37)
    exact = fine.block.trace.evaluate(s) @ smooth[fine.block.radial + 1]
    assert np.abs(coarse.block.trace.evaluate(s) @ there.u[coarse.block.radial + 1] - exact).max() < 0.05


def test_what_other_elements_lose_of_a_displacement_is_orthogonal_to_their_functions():
    fine, coarse = (state_on(edge_grid(1.0, 0.3, 0.3, 4.0, density), 4) for density in (0.7, 0.9))
    core = coarse.block.core
    X, W = gauss_product(core.order + 1, core.order + 1)
    values, _ = _fields(fine, core, X)
    N = unit_functions(core.grid.quads(), core.order, X)[0]
    nearest = _projected(core, X, W, values)[core.rows].reshape(core.rows.shape[0], -1, 2)
    lost = N.T @ (W[:, None] * (values - N @ nearest))
    for component in (0, 1):
        numbers = core.rows[:, component::2]
        sums, sizes = (np.bincount(numbers.ravel(), part[..., component].ravel()) for part in (lost, np.abs(lost)))
        assert np.abs(sums).max() < 1e-12
        assert sizes.max() > 0.01


@pytest.mark.heavy
def test_an_event_is_sought_near_that_of_other_elements():
    """The first state needs fewer steps from it than from that of small strain."""
    problem = ball(5e-3, 2.0)
    linear = linear_event(problem, "pull_off")
    elements = _discretisation(problem, linear, "none", "auto", "auto")
    coarse = Family(replace(elements, spec=replace(elements.spec, order=4)), linear)
    finer = replace(elements, spec=replace(elements.spec, order=5))
    state = coarse.state(0.0)
    there = finer.carried(state, linear.radius, coarse._condition(0.0)[1])
    assert there.iterations < state.iterations
    assert there.load == pytest.approx(state.load, rel=1e-4)


@pytest.mark.heavy
@pytest.mark.parametrize(("number", "mu"), [(1e-3, 20.0), (5e-3, 20.0)])
def test_forces_at_large_tabor_numbers_are_bounded(number, mu):
    solution = solve_large_strain(ball(number, mu), "pull_off_force")
    assert solution.u_num < 1e-4 * solution.value
