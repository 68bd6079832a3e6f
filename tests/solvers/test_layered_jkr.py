"""JKR contact with layers: exact limits, identities, digits of stiff coatings, and the references that approach it."""

import math

import numpy as np
import pytest

import fscm
from tests.solvers.layered_jkr import Medium, Stack, half_space_radius, jkr, minima_with_error

RADIUS, WORK = 5e-6, 0.05
SOFT = (1.5e6, 0.49)

COATINGS = {
    (1e9, 0.4, 100e-9): [(7.6644e-8, 3.209445e-7, 3.209e-7), (7.6513e-7, 6.600370e-7, 6.587e-7)],
    (10e9, 0.4, 30e-9): [(2.0737e-8, 1.535842e-7, 1.534e-7), (9.4083e-7, 8.437974e-7, 8.429e-7)],
    (100e6, 0.4, 100e-9): [(1.09515e-6, 9.926561e-7, 9.91e-7)],
}
"""Contact radii (m) and pulling forces (N) of all minima, equal in all digits with 12, 16 and 24 Gauss points; and the
forces by another method: 120 rings of uniform pressure, compliance from the Hankel transform."""


def coated(modulus_ratio: float, thickness_ratio: float, poisson: float = 0.4) -> Stack:
    """One coating on the soft substrate; its thickness in contact radii at pull-off from the substrate."""
    thickness = thickness_ratio * half_space_radius(Medium(*SOFT), WORK, RADIUS)
    return Stack(((modulus_ratio * SOFT[0], poisson, thickness),), SOFT)


THREE_LAYERS = Stack(((1e8, 0.3, 5e-8), (1e5, 0.45, 2e-7), (3e7, 0.1, 4e-7)), SOFT)
STACKS = {
    "equal": coated(1.0, 0.1, SOFT[1]),
    "soft incompressible": coated(1e-2, 0.3, 0.49),
    "three layers": THREE_LAYERS,
}


def test_loads_of_a_stiff_coating() -> None:
    coating, minima = next(iter(COATINGS.items()))
    path = jkr(Stack((coating,), SOFT), WORK, RADIUS)
    for radius, force, _ in minima:
        assert -path.state(radius).load == pytest.approx(force, rel=4e-7)


@pytest.mark.heavy
@pytest.mark.parametrize("coating", COATINGS, ids=str)
def test_minima_of_stiff_coatings(coating) -> None:
    minima = minima_with_error(Stack((coating,), SOFT), WORK, RADIUS)
    radii, forces, by_rings = np.array(COATINGS[coating]).T
    assert [minimum.contact_radius for minimum in minima] == pytest.approx(radii, rel=1e-4)
    assert [-minimum.load for minimum in minima] == pytest.approx(forces, rel=4e-7)
    assert [-minimum.load for minimum in minima] == pytest.approx(by_rings, rel=2.5e-3)
    assert all(minimum.error < -1e-10 * minimum.load for minimum in minima)


def test_equal_moduli_are_a_half_space() -> None:
    """P = 4 E* a^3 / (3 R) - (8 pi w E* a^3)^(1/2), at its least -(3/2) pi w R."""
    E, radius = Medium(*SOFT).plane_strain, half_space_radius(Medium(*SOFT), WORK, RADIUS)
    path = jkr(STACKS["equal"], WORK, RADIUS)
    for a in radius * np.array([0.3, 1.0, 2.0]):
        load = 4 * E * a**3 / (3 * RADIUS) - np.sqrt(8 * np.pi * WORK * E * a**3)
        assert path.state(a).load == pytest.approx(load, rel=1e-9)
    assert path.state(radius).load == pytest.approx(-1.5 * np.pi * WORK * RADIUS, rel=1e-9)


@pytest.mark.parametrize("name", STACKS)
def test_edge_and_load_belong_to_one_energy(name: str) -> None:
    """d^2 U / da d delta both ways: the derivative of the load is the product of the values of phi at the edge."""
    path = jkr(STACKS[name], WORK, RADIUS)
    for a in np.array([0.03, 0.3, 2.0]) * half_space_radius(Medium(*SOFT), WORK, RADIUS):
        _, edge = path.solutions(a)
        step = 1e-2 * a
        nearby = [path.solutions(a + i * step)[0] for i in (-2, -1, 1, 2)]
        derivative = (nearby[0] - 8 * nearby[1] + 8 * nearby[2] - nearby[3]) / (12 * step)
        np.testing.assert_allclose(derivative, edge[0] * edge, rtol=2e-6)


@pytest.mark.parametrize("ratio", [1e-4, 1e-2, 1e2, 1e4])
def test_compliance_of_extreme_contrasts(ratio: float) -> None:
    """Neither the thickness nor the number of layers matters to a material, and far waves see the substrate alone."""
    single = Stack(((ratio, 0.4, 3.0),), (1.0, 0.49))
    parts = Stack(((ratio, 0.4, 1.0), (ratio, 0.4, 0.5), (ratio, 0.4, 1.5)), (1.0, 0.49))
    xi = np.logspace(-12, 4, 60)
    np.testing.assert_allclose(parts.relative_compliance(xi), single.relative_compliance(xi), rtol=1e-9)
    moduli = [medium.plane_strain for medium in single.media]
    assert single.relative_compliance(xi)[0] == pytest.approx(moduli[0] / moduli[1], rel=1e-6)
    assert single.relative_compliance(xi)[-1] == pytest.approx(1.0, abs=1e-12)


NU = 0.3


def pull_off(ratio, thickness):
    """By JKR in pi w R, of a coating on a substrate so many times as stiff; thickness in (w R^2/E*)^(1/3)."""
    stack = Stack(((1.0 - NU**2, NU, thickness),), ((1.0 - NU**2) * ratio, NU))
    return -min(state.load for state in minima_with_error(stack, 1.0, 1.0)) / math.pi


def limit(mu, forces):
    """The constant beside mu^-2 ln mu, mu^-2, mu^-3 ln mu and mu^-3, and the bound that those of the forces give it."""
    log = np.log(mu)
    terms = np.stack([np.ones_like(mu), log / mu**2, 1.0 / mu**2, log / mu**3, 1.0 / mu**3], axis=1)
    weights = np.linalg.inv(terms)[0]
    return weights @ forces[:, 0], np.abs(weights) @ forces[:, 1]


@pytest.mark.heavy
@pytest.mark.parametrize(("ratio", "thickness"), [(1.0, 0.5), (4.0, 0.5), (0.25, 0.5), (100.0, 0.3)])
def test_a_coated_solid_approaches_its_own_limit(ratio, thickness):
    """The cohesive zone is about L mu^(-3/2) wide, and its tension decays so slowly that a logarithm remains."""
    mu = np.array([2.0, 4.0, 8.0, 16.0, 32.0, 64.0])
    solids = [fscm.Coating(1.0, ratio, thickness * x**0.5, 0.0, NU) for x in mu]
    solutions = [
        fscm.solve(fscm.Problem(2.0, 0.0, x, graded=solid), "pull_off_force")
        for x, solid in zip(mu, solids, strict=True)
    ]
    forces = np.array([(solution.value, solution.u_num) for solution in solutions])
    (before, _), (value, u_forces) = limit(mu[:-1], forces[:-1]), limit(mu[1:], forces[1:])
    bound = abs(value - before) + u_forces
    assert abs(value - pull_off(ratio, thickness)) <= bound < 1e-5
    # A coating that is one in a thousand thicker is told apart.
    assert ratio == 1.0 or abs(value - pull_off(ratio, 1.001 * thickness)) > bound
