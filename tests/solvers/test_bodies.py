"""Surface tension and two elastic bodies, of every kind of solid, by both references."""

import pytest

from tests.marks import heavy
from tests.solvers.agreement import agreeing

QUANTITIES = ("pull_off_force", "pull_off_displacement")


def homogeneous(E, nu=0.3, tension=0.0):
    return lambda package: package.Homogeneous(E, nu, surface_tension=tension)


def graded(E0, k, nu=0.3, tension=0.0):
    return lambda package: package.PowerLaw(E0, 1.0, k, nu, surface_tension=tension)


def coating(tension=0.0):
    return lambda package: package.Coating(10.0, 1.0, 1.0, 0.0, 0.2, 0.45, surface_tension=tension)


def layers(tension=0.0):
    return lambda package: package.Layers((1.0, 5.0, 2.0), (0.3, 0.2, 0.4), (0.5, 0.7), surface_tension=tension)


def exponential(tension=0.0):
    return lambda package: package.Exponential(3.0, 1.0, 2.0, 0.3, surface_tension=tension)


def offset(tension=0.0):
    return lambda package: package.OffsetPowerLaw(1.0, 1.0, 0.5, 1.0, 0.3, surface_tension=tension)


#: A solid with surface tension on a rigid punch, or two bodies.
CASES = {
    "homogeneous with tension": (homogeneous(0.3, tension=0.1), None),
    "two homogeneous": (homogeneous(0.8, 0.2), homogeneous(1.3, 0.45)),
    "little tension": (homogeneous(0.5, tension=0.01), None),
    "much tension": (homogeneous(0.2, 0.45, 1.0), None),
    "nearly a liquid": (homogeneous(0.1, 0.2, 5.0), None),
    "k = 0.4 with tension": (graded(0.3, 0.4, tension=0.1), None),
    "k = 0.6 with tension": (graded(0.5, 0.6, tension=0.5), None),
    "coating with tension": (coating(0.1), None),
    "layers with tension": (layers(0.3), None),
    "exponential with tension": (exponential(0.2), None),
    "offset with tension": (offset(0.1), None),
    "two halves": (homogeneous(1.0), homogeneous(1.0)),
    "k = 0.4 twice": (graded(1.0, 0.4), graded(0.5, 0.4, 0.2)),
    "k = 0.4 on homogeneous": (graded(1.0, 0.4), homogeneous(2.0)),
    "k = 0.2 on 0.6": (graded(0.6, 0.2), graded(1.0, 0.6)),
    "coating on layers": (coating(), layers()),
    "layers on homogeneous": (layers(), homogeneous(3.0)),
    "exponential on offset": (exponential(), offset()),
    "tension of both": (homogeneous(1.0, tension=0.1), homogeneous(0.5, tension=0.3)),
    "coating with tension on k = 0.3": (coating(0.1), graded(2.0, 0.3)),
}


@pytest.mark.parametrize("name", [*list(CASES)[:2], *heavy(*list(CASES)[2:])])
def test_both_references_agree(name):
    solid, punch_solid = CASES[name]

    def posed(package):
        punch, law = package.PowerPunch(2.0, 1.0), package.LennardJones(1.0, 1.0)
        return package.Problem(solid(package), punch, law, punch_solid and punch_solid(package))

    for of_integral, _ in agreeing(posed, QUANTITIES, "quick").values():
        assert of_integral.u_num < 1e-7
