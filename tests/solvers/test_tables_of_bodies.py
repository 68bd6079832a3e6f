"""The potential of a punch under a law that is no power, by both references: a ball exactly, others by curvature."""

import numpy as np
import pytest

import fscm
from tests.marks import heavy
from tests.refusals import refused
from tests.solvers.agreement import agreeing
from tests.solvers.potentials import PACKAGES, both, check_derivatives, force_of, rates, table_of

#: Convex faces, in ranges of the law.
FACES = {
    "paraboloid": lambda package: package.PowerPunch(2.0, 100.0),
    "n = 3": lambda package: package.PowerPunch(3.0, 1e4),
    "rounded cone": lambda package: package.RoundedCone(20.0, 2.0),
}


@both
def test_a_ball_under_any_law_is_that_of_its_atoms(package):
    law, name = package.LennardJones(1.0, 1.0), "BallUnderLaw" if package is fscm else "BodyUnderTable"
    under_any_law = getattr(package.interaction, name)
    ball = package.Ball(20.0)
    exact, force = package.interaction.interaction_of(ball, law, "body"), under_any_law(ball, law)
    r, gap = np.array([0.5, 2.0, 3.0, 30.0, 100.0, 250.0]), np.array([0.2, 0.5, 2.0, 400.0, 5000.0, 30000.0])
    assert force.traction(r, gap) == pytest.approx(exact.traction(r, gap), rel=1e-12)
    for rate, of_atoms in zip(rates(force, r, gap), rates(exact, r, gap), strict=True):
        assert rate == pytest.approx(of_atoms, rel=1e-9)
    assert force.energy(r, gap) == pytest.approx(exact.energy(r, gap), rel=1e-9)
    assert force.peak_gap(r[:3]) == pytest.approx(exact.peak_gap(r[:3]), abs=1e-10)
    assert isinstance(package.interaction.interaction_of(ball, table_of(package, law), "body"), under_any_law)


def curved(package, face, law=None):
    """The force of a face by its curvature, and what it leaves out at places."""
    force = package._curved_face.CurvedFace(FACES[face](package), law or package.LennardJones(1.0, 1.0))
    if package is fscm:
        return force, force.remainder
    return force, lambda r, gap: force.finer.traction(r, gap) - force.traction(r, gap)


@both
@pytest.mark.parametrize("face", FACES)
def test_curvatures_give_the_potential_within_their_estimate(package, face):
    exact, (force, remainder) = force_of(package, FACES[face](package)), curved(package, face)
    r, gap = np.meshgrid([1e-3, 1.0, 3.0, 10.0, 30.0, 100.0], [-0.1, 0.2, 1.0, 5.0])
    error, left_out = np.abs(force.traction(r, gap) - exact.traction(r, gap)), remainder(r, gap)
    assert np.all(error <= left_out)
    # Both the normal distance and the vertical gap leave more out.
    assert np.sum(error) < 0.1 * np.sum(np.abs(exact.law.traction(gap) - exact.traction(r, gap)))
    assert np.all(left_out[1] < 0.1 * np.abs(exact.traction(r, gap)[1]))


@both
@pytest.mark.parametrize("face", ["n = 3", "rounded cone"])
def test_slopes_energy_and_peak_of_a_table_belong_to_the_traction(package, face):
    force, _ = curved(package, face, table_of(package, package.LennardJones(1.0, 1.0)))
    check_derivatives(force, np.array([0.2, 3.0, 9.0]), np.array([0.3, 0.7, 5.0]))


@both
def test_a_table_needs_a_smooth_convex_face(package):
    law = table_of(package, package.LennardJones(1.0, 1.0))
    hollow = package.CustomPunch(lambda x: x**2 / 200 + 1 - np.cos(x / 5), 2.0, lambda x: x / 100 + np.sin(x / 5) / 5)
    measured = package.MeasuredPunch((0.0, 4.0, 9.0), (0.0, 0.5, 6.0))
    for punch, reason in ((package.PowerPunch(1.0, 2.0), "tip"), (hollow, "hollow"), (measured, "kink")):
        refused(reason, package.interaction.interaction_of, punch, law, "body")


#: Shapes, and the largest bound of the force, relative: measured 2.1e-3, 9.7e-4 and 1.8e-2 of distance and curvature.
PRESSED = {
    "ball": (lambda package: package.Ball(1.0), 1e-6),
    "paraboloid": (lambda package: package.PowerPunch(2.0, 1.0), 3e-3),
    "n = 3": (lambda package: package.PowerPunch(3.0, 1.0), 2e-3),
    "rounded cone": (lambda package: package.RoundedCone(0.1, 0.5), 3e-2),
}
#: Change of the force by the spline through the points of the table, measured as 1.6e-6 for the ball.
OF_THE_SPLINE = 4e-6


def posed(package, shape, tabulated):
    """W = 1e-3 and z0 = 0.01 on E* = 1."""
    law = package.LennardJones(1e-3, 0.01)
    law = table_of(package, law) if tabulated else law
    return package.Problem(package.PowerLaw(0.91, 1.0, 0.0, 0.3), PRESSED[shape][0](package), law, interaction="body")


@pytest.mark.parametrize("shape", PRESSED)
def test_both_references_have_one_traction(shape):
    elements, integral = (posed(package, shape, tabulated=True).force for package in PACKAGES)
    r, gap = np.meshgrid([0.05, 0.1, 0.3, 0.7], [-1e-3, 2e-3, 0.01, 0.1])
    (by_radius, by_gap), (of_elements, exact) = rates(integral, r, gap), rates(elements, r, gap)
    assert integral.traction(r, gap) == pytest.approx(elements.traction(r, gap), rel=1e-9)
    assert by_gap == pytest.approx(exact, rel=1e-7)
    size = np.abs(by_gap) * elements.punch.slope(r)
    assert np.all(np.abs(by_radius - of_elements) < 1e-6 * (np.abs(by_radius) + size))


@pytest.mark.parametrize("shape", ["ball", *heavy("paraboloid", "n = 3", "rounded cone")])
def test_the_pull_off_is_that_of_the_powers_within_the_estimate(shape):
    pair = agreeing(lambda package: posed(package, shape, tabulated=True), accuracy="quick")["pull_off_force"]
    exact = fscm.solve(posed(fscm, shape, tabulated=False), "pull_off_force")
    for solution in pair:
        difference = abs(solution.value - exact.value)
        assert difference < solution.u_num + exact.u_num + OF_THE_SPLINE * exact.value
        assert solution.u_num < PRESSED[shape][1] * exact.value
    # Both leave the same out, so that they are much nearer to each other than their bounds.
    assert pair[0].value == pytest.approx(pair[1].value, rel=2e-6)
