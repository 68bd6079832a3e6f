"""Both references on other solids, punches and laws than power laws: inside the bounds of each other."""

import numpy as np
import pytest

from comparisons.problem.punch_shapes import SmoothedProfile
from tests.marks import heavy
from tests.solvers.agreement import agreeing

RADII = np.array([0.0, 0.8, 1.6, 2.5, 4.0])
GAPS = np.geomspace(0.75, 20.0, 80)
# A jump is the first, also where it does not exist.
QUANTITIES = (
    *("jump_out_displacement", "pull_off_force", "pull_off_displacement"),
    *("jump_in_gap", "zero_load_displacement"),
)
LARGEST_BOUND = 1e-5

SOLIDS = {
    "coating": lambda package: package.Coating(1.0, 10.0, 1.0, 0.0, 0.3),
    "smooth coating": lambda package: package.Coating(10.0, 1.0, 0.5, 0.1, 0.3),
    "stiff coating": lambda package: package.Coating(50.0, 40.0, 1.0, 0.0, 0.3),
    "coating of another ratio": lambda package: package.Coating(10.0, 1.0, 1.0, 0.0, 0.2, 0.45),
    "ratios alone": lambda package: package.Coating(1.0, 1.0, 1.0, 0.0, 0.2, 0.45),
    "table of two ratios": lambda package: package.TabulatedModulus((0.0, 1.0, 2.0), (1.0, 1.5, 4.0), (0.4, 0.25, 0.1)),
    "offset power law": lambda package: package.OffsetPowerLaw(0.91, 1.0, 0.4, 1.0, 0.3),
    "exponential": lambda package: package.Exponential(1.0, 3.0, 2.0, 0.3),
}
PUNCHES = {
    "measured": lambda package: package.MeasuredPunch(RADII, RADII**2 / 2.0),
    "rounded cone": lambda package: package.RoundedCone(0.5, 1.0),
    "sum of powers": lambda package: package.PowerSum((0.5, 0.1), (2.0, 4.0)),
}
#: Rows so far apart that the kinks between them are seen: those of the rate of the load decide the displacement.
WIDE_GAPS = np.linspace(-0.3, 4.0, 20)
MORSE = 3.0 * (np.exp(-3.0 * WIDE_GAPS) - np.exp(-1.5 * WIDE_GAPS))

LAWS = {
    "Mie": lambda package: package.Mie(1.0, 1.0, 12.0, 6.0),
    "table": lambda package: package.TabulatedLaw(GAPS, GAPS**-9 - GAPS**-3, z0=1.0, tail_exponent=3.0),
}


def posed(name):
    """The problem in which one of the three is that of the name."""

    def problem(package):
        solid = SOLIDS.get(name, lambda package: package.PowerLaw(1.0, 1.0, 0.0, 0.3))(package)
        punch = PUNCHES.get(name, lambda package: package.PowerPunch(2.0, 1.0))(package)
        law = LAWS.get(name, lambda package: package.LennardJones(1.0, 1.0))(package)
        return package.Problem(solid, punch, law)

    return problem


@pytest.mark.heavy
@pytest.mark.parametrize("name", SOLIDS)
def test_quantities_of_graded_solids(name):
    agreeing(posed(name), QUANTITIES, "quick")


@pytest.mark.parametrize("name", ["measured", *heavy("rounded cone", "sum of powers", *LAWS)])
def test_forces_of_other_punches_and_laws(name):
    """The kinks of a measured punch are nodes of the mesh."""
    integral, elements = agreeing(posed(name), accuracy="quick")["pull_off_force"]
    assert max(integral.u_num, elements.u_num) < LARGEST_BOUND * integral.value


def test_pull_off_of_a_profile_with_knots():
    """By the degrees of the elements alone, the forces were 5 times their bounds from each other."""
    growth, R, height = 1.7, 9.0, 32.0
    last = (growth * R ** (growth / 2.0) * height) ** (1.0 / growth)
    shares = np.linspace(0.0, 1.0, 33)
    profile = SmoothedProfile(tuple(last * shares), tuple(height * shares**growth), 0.002, growth)

    def problem(package):
        return package.Problem(package.Homogeneous(95.0, 0.3), profile, package.LennardJones(1.0, 1.0))

    integral, elements = agreeing(problem, ("pull_off_force",))["pull_off_force"]
    assert max(integral.u_num, elements.u_num) < LARGEST_BOUND * integral.value


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("solid", "punch"),
    [
        (lambda p: p.OffsetPowerLaw(1.0, 1.0, 0.41, 1.0, 0.1), lambda p: p.PowerPunch(4.0, 3.0)),
        (lambda p: p.Exponential(1.0, 0.6, 2.0, 0.45), lambda p: p.PowerPunch(1.0, 5.0)),
    ],
)
def test_pull_off_under_a_law_with_kinks(solid, punch):
    """By the degrees of the elements alone, the displacements were 20 and 89 times their bounds from each other."""

    def problem(package):
        return package.Problem(solid(package), punch(package), package.TabulatedLaw(WIDE_GAPS, MORSE, z0=1.0))

    agreeing(problem, ("pull_off_force", "pull_off_displacement"), "quick")


@pytest.mark.heavy
def test_pull_off_of_a_cone_on_stiff_layers():
    """The rates of the load on one mesh vanished where the load rises: 186 bounds from the displacement at pull-off."""

    def problem(package):
        layers = package.Layers((19.0, 92.85, 143.1, 1.208), (0.499, 0.1, 0.45, 0.3), (17.785, 26.01, 5.757))
        return package.Problem(layers, package.PowerPunch(1.0, 3.603), package.LennardJones(30.0, 0.8))

    agreeing(problem, ("pull_off_force", "pull_off_displacement"), "quick")
