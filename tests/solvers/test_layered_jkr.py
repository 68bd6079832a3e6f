"""JKR contact with layers: exact limits, identities, and the digits of three stiff coatings on a soft substrate."""

import numpy as np
import pytest
from scipy.special import gamma

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
    thickness = thickness_ratio * half_space_radius(Medium(*SOFT), WORK, RADIUS, 2.0)
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


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0, 3.0])
def test_power_law_punches_on_equal_moduli(n: float) -> None:
    """P = 2 E* (n a s(a) / (n + 1) - sqrt(2 pi w a^3 / E*)), least where n s(a) = 3/2 sqrt(2 pi w a / E*)."""
    Q, edge = RADIUS ** (n - 1), np.sqrt(2 * np.pi * WORK / Medium(*SOFT).plane_strain)
    sneddon = np.sqrt(np.pi) * gamma(n / 2 + 1) / gamma(n / 2 + 0.5) / (n * Q)
    radius = (1.5 * edge / (sneddon * n)) ** (1 / (n - 0.5))
    load = 2 * Medium(*SOFT).plane_strain * (sneddon * radius ** (n + 1) * n / (n + 1) - edge * radius**1.5)
    assert jkr(STACKS["equal"], WORK, Q, n).state(radius).load == pytest.approx(load, rel=1e-9)


@pytest.mark.parametrize("name", STACKS)
def test_edge_and_load_belong_to_one_energy(name: str) -> None:
    """d^2 U / da d delta both ways: the derivative of the load is the product of the values of phi at the edge."""
    path = jkr(STACKS[name], WORK, RADIUS)
    for a in np.array([0.03, 0.3, 2.0]) * half_space_radius(Medium(*SOFT), WORK, RADIUS, 2.0):
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
