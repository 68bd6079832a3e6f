"""The potential of all atoms of a punch, in both references: quadratures, limits, derivatives, agreement, refusals."""

import numpy as np
import pytest

import fem_reference
import fscm
from tests.marks import heavy
from tests.refusals import refused
from tests.solvers.agreement import agreeing
from tests.solvers.potentials import (
    PACKAGES,
    both,
    check_derivatives,
    composite,
    force_of,
    of_powers,
    power_of_ball,
    power_of_profile,
    rates,
)


def kinked(package, curvature, at):
    """A paraboloid whose slope jumps at a radius."""

    def height(r):
        return curvature * r**2 + 0.3 * np.maximum(r - at, 0.0)

    return package.CustomPunch(height, 2.0, lambda r: 2.0 * curvature * r + 0.3 * (r >= at), kinks=(at,))


#: Punches without end, in ranges of the law.
SHAPES = {
    "cone": lambda package: package.PowerPunch(1.0, 2.0),
    "n = 1.5": lambda package: package.PowerPunch(1.5, 4.0),
    "paraboloid": lambda package: package.PowerPunch(2.0, 20.0),
    "n = 3": lambda package: package.PowerPunch(3.0, 300.0),
    "n = 6": lambda package: package.PowerPunch(6.0, 1e6),
    "slope 0.5": lambda package: package.RoundedCone(2.0, 0.5),
    "slope 2": lambda package: package.RoundedCone(2.0, 2.0),
    "sum": lambda package: package.PowerSum((0.025, 1e-4), (2.0, 4.0)),
    "measured": lambda package: package.MeasuredPunch((0.0, 2.0, 6.0, 12.0), (0.0, 0.1, 1.0, 4.0)),
    "own": lambda package: kinked(package, 1.0 / 40.0, 6.0),
}
#: Relative error of the quadrature over the volume; measured worst 7e-10 (slope 2), of most shapes 2e-13.
VOLUME = 2e-9
EXPONENTS = [(9.0, 3.0), (12.0, 6.0), (8.2, 2.7)]

#: The integral equation has a table of each potential, which takes seconds where it is needed at many places.
OFTEN = [*((fem_reference, shape) for shape in SHAPES), (fscm, "paraboloid"), *heavy((fscm, "n = 1.5"))]


@both
@pytest.mark.parametrize("exponents", [*EXPONENTS[:2], (9.0, 2.5), (5.0, 4.0)])
@pytest.mark.parametrize("R", [3.0, 200.0])
def test_the_traction_of_a_ball_is_that_of_its_atoms(package, exponents, R):
    """Near the surface, beyond the sphere of the shape, and where the ball is nearly a point."""
    ball = force_of(package, package.Ball(R), exponents)
    for share in (0.0, 0.3, 0.8, 0.97, 2.0, 14.0):
        r = np.array(share * R)
        for level in (0.9, 3.0, 2.0 * R):  # above the height of the apex
            powers = [power_of_ball(R, m, float(np.hypot(r, R + level))) for m in exponents]
            exact, size = of_powers(exponents, powers)
            gap = np.array(level - 1.0 + float(ball.punch.height(r)))
            assert float(ball.traction(r, gap)) == pytest.approx(exact, abs=1e-12 * size)
            if package is fscm:
                assert float(ball.size(r, gap)) == pytest.approx(size, rel=1e-11)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("exponents", EXPONENTS)
def test_the_traction_is_that_of_all_atoms_of_the_volume(exponents, shape):
    """In both references."""
    forces = [force_of(package, SHAPES[shape](package), exponents) for package in PACKAGES]
    for x, v in ((0.0, 0.9), (1.5, 1.1), (6.0, 1.4)):
        exact, size = of_powers(exponents, [power_of_profile(forces[0].punch, m, x, v) for m in exponents])
        for force in forces:
            assert float(force.traction(np.array(x), np.array(v - 1.0))) == pytest.approx(exact, abs=VOLUME * size)


@pytest.mark.parametrize(("package", "shape"), OFTEN)
@pytest.mark.parametrize("exponents", EXPONENTS[1:])
@pytest.mark.parametrize("gap", [0.0, 3.0])
def test_over_a_plane_the_load_is_that_of_vertical_gaps(package, shape, exponents, gap):
    """Slices of the punch are parallel to the plane, whatever its shape."""
    force = force_of(package, SHAPES[shape](package), exponents)
    ends = np.concatenate([[0.0], np.geomspace(1e-5, 1.0, 12), np.geomspace(1.0, 1e14, 280), [2.0, 6.0, 12.0]])
    r, weight = composite(np.unique(ends), 10)
    height = force.punch.height(r)
    near = height < 1e14  # nothing is left farther away
    r, weight, height = r[near], weight[near], height[near]
    law = force.law.traction(gap + height)
    loads = [float((weight * r) @ p) for p in (force.traction(r, gap + height), law)]
    assert loads[0] == pytest.approx(loads[1], abs=1e-6 * float((weight * r) @ np.abs(law)))


@both
@pytest.mark.parametrize("exponents", [*EXPONENTS[:2], (9.0, 2.5), (5.0, 4.0)])
@pytest.mark.parametrize("R", [3.0, 1000.0])
def test_over_a_plane_the_load_of_a_ball_is_that_of_vertical_gaps_to_the_far_pole(package, exponents, R):
    ball = force_of(package, package.Ball(R), exponents)
    log_r, weight = composite(np.log(np.sqrt(R)) + np.linspace(-18.0, 40.0, 90))
    r = np.exp(log_r)
    for gap in (0.0, 0.5, 40.0):
        of_body = float((weight * r**2) @ ball.traction(r, gap + ball.punch.height(r)))
        D, of_gap = composite(np.geomspace(1.0 + gap, 1.0 + gap + 2.0 * R, 60))
        of_gaps = float((of_gap * (R - (D - 1.0 - gap))) @ ball.law.traction(D - 1.0))
        assert of_body == pytest.approx(of_gaps, rel=1e-12)


def profile_of_elements(ball):
    """The same shape as a function, with the growth of its far parabola."""
    far = np.array(1e4)
    return fem_reference.CustomPunch(ball.height, far * ball.slope(far) / ball.height(far), ball.slope, ball.kinks)


@both
def test_a_ball_by_quadrature_of_its_profile(package):
    """Under steep powers, which do not feel where the profile leaves the sphere."""
    ball, law = package.Ball(200.0), package.Mie(1.0, 1.0, 14.0, 10.5)
    profile = ball if package is fscm else profile_of_elements(ball)
    exact, force = force_of(package, ball, (14.0, 10.5)), package.interaction.BodyOfRevolution(profile, law)
    r, gap = np.array([0.1, 7.0, 30.0, 60.0]), np.array([0.1, -0.1, 3.0, 1.0])
    assert force.traction(r, gap) == pytest.approx(exact.traction(r, gap), rel=1e-8)
    for rate, of_ball in zip(rates(force, r, gap), rates(exact, r, gap), strict=True):
        assert rate == pytest.approx(of_ball, rel=1e-7)
    assert force.energy(r, gap) == pytest.approx(exact.energy(r, gap), rel=1e-8)
    assert force.peak_gap(r) == pytest.approx(exact.peak_gap(r), rel=1e-7)


@both
@pytest.mark.parametrize("punch", ["PowerPunch", "Ball"])
def test_a_large_punch_acts_as_its_law_at_the_vertical_gap(package, punch):
    """The difference is of first order in z0/R and (r/R)^2."""
    gap, law = np.array([-0.1, 0.2, 3.0]), package.LennardJones(1.0, 1.0)
    for R in (1e4, 1e7):
        shape = package.Ball(R) if punch == "Ball" else package.PowerPunch(2.0, R)
        near = force_of(package, shape).traction(np.full(3, 1e-4 * R**0.5), gap)
        assert near == pytest.approx(law.traction(gap), rel=10.0 / R)


@pytest.mark.parametrize(
    ("package", "shape"), [*((package, "ball") for package in PACKAGES), *OFTEN[: len(SHAPES)], *heavy(OFTEN[-2])]
)
def test_slopes_energy_and_peak_belong_to_the_traction(package, shape):
    punch = package.Ball(50.0) if shape == "ball" else SHAPES[shape](package)
    r, gap = np.array([0.2, 3.0, 9.0, 30.0]), np.array([0.1, -0.1, 5.0, 30.0])
    check_derivatives(force_of(package, punch, (8.2, 2.7)), r, gap)


@pytest.mark.parametrize("shape", ["paraboloid", "cone", *heavy(*(name for name in SHAPES if name[0] not in "pc"))])
def test_both_references_have_one_potential(shape):
    elements, integral = (force_of(package, SHAPES[shape](package), (8.2, 2.7)) for package in PACKAGES)
    r = np.append(0.0, np.geomspace(1e-2, 40.0, 12))
    for gap in (np.full_like(r, -0.1), np.full_like(r, 2.0), integral.punch.height(r) + 0.5):
        difference = integral.traction(r, gap) - elements.traction(r, gap)
        assert np.max(np.abs(difference) / integral.size(r, gap)) < 1e-9
    if shape == "paraboloid":
        # Few places: the table of the energy takes a second for each region.
        r, gap = r[::6], gap[::6]
        assert integral.energy(r, gap) == pytest.approx(elements.energy(r, gap), rel=1e-8)
        assert integral.peak_gap(r) == pytest.approx(elements.peak_gap(r), rel=1e-6)


#: Shape and exponents; w = 1e-3 and z0 = 0.01 on E* = 1.
PRESSED = {
    "cone": (lambda package: package.PowerPunch(1.0, 2.0), (9.0, 3.0)),
    "n = 1.5": (lambda package: package.PowerPunch(1.5, 1.0), (9.0, 3.0)),
    "n = 3": (lambda package: package.PowerPunch(3.0, 1.0), (9.0, 3.0)),
    "n = 6": (lambda package: package.PowerPunch(6.0, 1.0), (9.0, 3.0)),
    "slope 0.5": (lambda package: package.RoundedCone(0.1, 0.5), (9.0, 3.0)),
    "slope 2": (lambda package: package.RoundedCone(0.1, 2.0), (9.0, 3.0)),
    "sum": (lambda package: package.PowerSum((0.5, 0.125), (2.0, 4.0)), (9.0, 3.0)),
    "own": (lambda package: kinked(package, 0.5, 0.15), (9.0, 3.0)),
    "measured": (
        lambda package: package.MeasuredPunch((0.0, 0.05, 0.1, 0.2, 0.4), (0.0, 0.00125, 0.005, 0.02, 0.08)),
        (9.0, 3.0),
    ),
    "12-6": (lambda package: package.PowerPunch(2.0, 1.0), (12.0, 6.0)),
    "real": (lambda package: package.PowerPunch(2.0, 1.0), (8.2, 2.7)),
}


@pytest.mark.heavy
@pytest.mark.parametrize("case", PRESSED)
def test_the_pull_off_by_both(case):
    shape, exponents = PRESSED[case]

    def posed(package):
        solid, law = package.PowerLaw(0.91, 1.0, 0.0, 0.3), package.Mie(1e-3, 0.01, *exponents)
        return package.Problem(solid, shape(package), law, interaction="body")

    for solution in agreeing(posed)["pull_off_force"]:
        assert solution.u_num < 2e-6 * solution.value


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


def test_what_has_no_potential_is_refused():
    refused("ratio of radii to heights", fscm.Problem, 2.0, 0.0, 1.0, interaction="body")
    law = fem_reference.LennardJones(1.0, 1.0)
    refused("below", fem_reference.interaction.interaction_of, fem_reference.Ball(1.0), law, "below")
