"""The potential of punches of any shape, under any exponents, by both references: tractions and pull-off."""

import numpy as np
import pytest

import fem_reference
import fscm
from tests.solvers.agreement import agreeing


def own(package):
    """A paraboloid whose slope jumps."""
    return package.CustomPunch(
        lambda r: 0.5 * r**2 + 0.3 * np.maximum(r - 0.15, 0.0), 2.0, lambda r: r + 0.3 * (r >= 0.15), kinks=(0.15,)
    )


#: Shape and exponents; w = 1e-3 and z0 = 0.01 on E* = 1.
CASES = {
    "cone": (lambda package: package.PowerPunch(1.0, 2.0), (9.0, 3.0)),
    "n = 1.5": (lambda package: package.PowerPunch(1.5, 1.0), (9.0, 3.0)),
    "n = 3": (lambda package: package.PowerPunch(3.0, 1.0), (9.0, 3.0)),
    "n = 6": (lambda package: package.PowerPunch(6.0, 1.0), (9.0, 3.0)),
    "slope 0.5": (lambda package: package.RoundedCone(0.1, 0.5), (9.0, 3.0)),
    "slope 2": (lambda package: package.RoundedCone(0.1, 2.0), (9.0, 3.0)),
    "sum": (lambda package: package.PowerSum((0.5, 0.125), (2.0, 4.0)), (9.0, 3.0)),
    "own": (own, (9.0, 3.0)),
    "measured": (
        lambda package: package.MeasuredPunch((0.0, 0.05, 0.1, 0.2, 0.4), (0.0, 0.00125, 0.005, 0.02, 0.08)),
        (9.0, 3.0),
    ),
    "12-6": (lambda package: package.PowerPunch(2.0, 1.0), (12.0, 6.0)),
    "real": (lambda package: package.PowerPunch(2.0, 1.0), (8.2, 2.7)),
}


def posed(package, case):
    shape, exponents = CASES[case]
    solid, law = package.PowerLaw(0.91, 1.0, 0.0, 0.3), package.Mie(1e-3, 0.01, *exponents)
    return package.Problem(solid, shape(package), law, interaction="body")


@pytest.mark.parametrize(
    "case", [case if case in ("cone", "12-6") else pytest.param(case, marks=pytest.mark.heavy) for case in CASES]
)
def test_both_references_have_one_potential(case):
    integral, elements = (posed(package, case).force for package in (fscm, fem_reference))
    r = np.append(0.0, np.geomspace(1e-3, 1.0, 12))
    for gap in (np.full_like(r, -1e-3), np.full_like(r, 0.02), elements.punch.height(r) + 5e-3):
        size = np.abs(elements._powers(r, gap)[:, 0]).sum(axis=0) * elements.law.powers[0][0]
        difference = integral.traction(r, gap) - elements.traction(r, gap)
        assert np.max(np.abs(difference) / size) < 1e-9


@pytest.mark.heavy
@pytest.mark.parametrize("case", CASES)
def test_the_pull_off_by_both(case):
    integral, elements = agreeing(lambda package: posed(package, case))["pull_off_force"]
    assert elements.u_num < 2e-6 * elements.value
    assert integral.u_num < 2e-6 * integral.value
