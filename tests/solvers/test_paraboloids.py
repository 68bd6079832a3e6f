"""The potential of a paraboloid without end, in both references: against rays, its limits, agreement, refusals."""

import math

import numpy as np
import pytest

import fem_reference
import fem_reference.interaction
import fscm
import fscm.interaction
from tests.refusals import refused
from tests.solvers.agreement import agreeing

PACKAGES = [fscm, fem_reference]
by_both = pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.__name__)
EXPONENTS = [(9.0, 3.0), (7.0, 5.0)]


def body_of(package, R, exponents=(9.0, 3.0)):
    """Force of a paraboloid under a law of w = z0 = 1."""
    return package.interaction.interaction_of(package.PowerPunch(2.0, R), package.Mie(1.0, 1.0, *exponents), "body")


def rates(body, r, H):
    """dp/dr at a fixed gap, and dp/dH."""
    return body.slopes(r, H) if hasattr(body, "slopes") else (body.drift(r, H) / r, body.slope(r, H))


def power_by_rays(R, m, x, v):
    """Power m of the law: atoms on rays from the point, between where these enter the paraboloid and leave it."""
    node, weight = np.polynomial.legendre.leggauss(160)
    w, weight = 0.5 * (1.0 + node), 0.5 * weight
    phi = 2.0 * math.pi * (np.arange(240) + 0.5)[:, None] / 240
    outside = 2.0 * R * v  # x^2 - 2 R z of the point
    limb = np.arctan2(R, math.sqrt(outside) + x * np.cos(phi))  # the ray that touches
    theta = limb * (1.0 - w**2)
    b = R * np.cos(theta) - x * np.sin(theta) * np.cos(phi)
    root = np.sqrt(np.maximum(b * b - np.sin(theta) ** 2 * outside, 0.0))
    entry, exit_ = outside / (b + root), (b + root) / np.sin(theta) ** 2
    density = (entry**-m - exit_**-m) * np.sin(theta) * 2.0 * w * limb
    return (m + 1.0) / (2.0 * math.pi) * float(np.sum(density @ weight)) * 2.0 * math.pi / 240


@by_both
@pytest.mark.parametrize("exponents", EXPONENTS)
@pytest.mark.parametrize("R", [3.0, 50.0])
def test_the_traction_is_that_of_all_atoms_on_rays(package, exponents, R):
    body, (m, n) = body_of(package, R, exponents), exponents
    strength = (m - 1.0) * (n - 1.0) / (m - n)
    for x, v in ((0.0, 0.9), (0.3 * R, 1.2), (0.9 * R, 2.5), (1.5 * R, 1.5 * R)):
        repulsion, attraction = (power_by_rays(R, a, x, v) for a in exponents)
        exact = strength * (repulsion - attraction)
        traction = float(body.traction(np.array(x), np.array(v - 1.0)))
        assert traction == pytest.approx(exact, abs=2e-10 * strength * (repulsion + attraction))


@by_both
@pytest.mark.parametrize("R", [5.0, 1000.0])
@pytest.mark.parametrize("gap", [0.0, 3.0])
def test_over_a_plane_the_load_is_that_of_vertical_gaps(package, R, gap):
    """Slices of the punch are parallel to the plane: 2 pi R times the energy of the law."""
    body, law = body_of(package, R), package.LennardJones(1.0, 1.0)
    node, weight = np.polynomial.legendre.leggauss(24)
    half = 0.4
    log_r = math.log(math.sqrt(R)) + np.arange(-12.0, 24.0, 2.0 * half)[:, None] + half * (1.0 + node)
    r = np.exp(log_r)
    pressure = body.traction(r, gap + body.punch.height(r))
    load = 2.0 * math.pi * half * float(np.sum(pressure * r**2 @ weight))
    assert load == pytest.approx(2.0 * math.pi * R * float(law.energy(np.array(gap))), rel=1e-9)


@by_both
@pytest.mark.parametrize("exponents", EXPONENTS)
def test_slopes_energy_and_peak_belong_to_the_traction(package, exponents):
    body, step = body_of(package, 20.0, exponents), 1e-5
    r, gap = np.array([0.2, 3.0, 9.0, 30.0]), np.array([0.1, -0.1, 5.0, 30.0])
    by_radius, by_gap = rates(body, r, gap)
    ends = [body.traction(r, gap + sign * step * (1.0 + gap)) for sign in (1.0, -1.0)]
    assert by_gap == pytest.approx((ends[0] - ends[1]) / (2.0 * step * (1.0 + gap)), rel=1e-6)
    ends = [body.traction(r * (1.0 + sign * step), gap) for sign in (1.0, -1.0)]
    assert by_radius == pytest.approx((ends[0] - ends[1]) / (2.0 * step * r), rel=1e-5)
    ends = [body.energy(r, gap + sign * 10 * step * (1.0 + gap)) for sign in (1.0, -1.0)]
    assert body.traction(r, gap) == pytest.approx((ends[1] - ends[0]) / (20.0 * step * (1.0 + gap)), rel=1e-6)
    peak = body.peak_gap(r)
    by_gap = rates(body, r, peak)[1]
    assert np.all(np.abs(by_gap) < 1e-7 * np.abs(body.traction(r, peak)))


@by_both
def test_a_large_paraboloid_acts_as_its_law_at_the_vertical_gap(package):
    """The difference is of first order in z0/R and (r/R)^2."""
    gap, law = np.array([-0.1, 0.2, 3.0]), package.LennardJones(1.0, 1.0)
    for R in (1e4, 1e7):
        near = body_of(package, R).traction(np.full(3, 1e-4 * R**0.5), gap)
        assert near == pytest.approx(law.traction(gap), rel=10.0 / R)


@pytest.mark.parametrize("R", [5.0, 1e4])
def test_both_references_have_one_potential(R):
    integral, elements = (body_of(package, R) for package in PACKAGES)
    r = np.append(0.0, np.geomspace(1e-3 * R, 2.0 * R, 20))
    for gap in (np.full_like(r, -0.1), np.full_like(r, 2.0), integral.punch.height(r) + 0.5):
        difference = integral.traction(r, gap) - elements.traction(r, gap)
        assert np.max(np.abs(difference) / integral.size(r, gap)) < 1e-10
    assert integral.energy(r, gap) == pytest.approx(elements.energy(r, gap), rel=1e-8)
    assert integral.peak_gap(r) == pytest.approx(elements.peak_gap(r), rel=1e-6)


def paraboloid(package, softness, mu, k=0.0, interaction="body"):
    """R = 1 on a solid of E* = 1 at k = 0, of the Tabor number mu there."""
    solid, law = package.PowerLaw(0.91, 1.0, k, 0.3), package.LennardJones(softness, softness ** (2 / 3) / mu)
    return package.Problem(solid, package.PowerPunch(2.0, 1.0), law, interaction=interaction)


@pytest.mark.heavy
@pytest.mark.parametrize(("softness", "mu", "k"), [(1e-3, 1.0, 0.0), (5e-3, 2.0, 0.0), (1e-3, 1.0, 0.3)])
def test_the_force_of_a_paraboloid_by_both(softness, mu, k):
    quantities = ("pull_off_force", "pull_off_displacement", "zero_load_displacement")
    integral, elements = agreeing(lambda package: paraboloid(package, softness, mu, k), quantities)["pull_off_force"]
    assert integral.u_num < 1e-10 * integral.value
    assert elements.u_num < 2e-5 * elements.value
    vertical = fscm.solve(paraboloid(fscm, softness, mu, k, "derjaguin"), "pull_off_force")
    assert integral.value > vertical.value + elements.u_num  # the true area is larger than the projected one


@pytest.mark.heavy
def test_over_a_stiff_solid_the_state_has_the_load_of_vertical_gaps():
    stiff = fscm.Problem(
        fscm.Homogeneous(1e12, 0.3), fscm.PowerPunch(2.0, 20.0), fscm.LennardJones(), interaction="body"
    )
    (state,) = fscm.equilibria(stiff, "central_gap", 1.0)
    energy = float(fscm.LennardJones().energy(np.array(1.0)))
    assert state.load == pytest.approx(2.0 * math.pi * 20.0 * energy, rel=1e-8)


def test_the_aspect_has_to_be_known():
    refused("ratio of radii to heights", fscm.Problem, 2.0, 0.0, 1.0, interaction="body")
