"""Events of graded solids, other laws and other punches: inside the bounds of routes that share nothing with the mesh.

The integral equation (punches and laws on a power law), limits in which two solids are one, units, and finer meshes.
"""

import math

import numpy as np
import pytest

import fscm
from fem_reference import (
    LennardJones,
    MeasuredPunch,
    Mie,
    PowerLaw,
    PowerPunch,
    PowerSum,
    Problem,
    RoundedCone,
    TabulatedLaw,
    solve,
)
from fem_reference.coating import CoatingModulus
from fem_reference.modulus import OffsetPowerLawModulus
from tests.fem_reference.profile_solid import ProfileSolid
from tests.fem_reference.solved_together import COARSEST, pull_off_on_the_coarsest_mesh, sphere_on

NU = 0.3
LAW = LennardJones(1.0, 1.0)
SPHERE = PowerPunch(2.0, 1.0)
FORCE = "pull_off_force"
SOFT = PowerLaw(1.0, 1.0, 0.0, NU)


def _integral_equation(punch=None, law=None, mu=(1.0 - NU**2) ** (2.0 / 3.0)):
    """Pull-off force on the soft homogeneous solid by the integral equation, in the units of the finite elements."""
    force = fscm.solve(fscm.Problem(n=2.0, k=0.0, mu=mu, punch=punch, law=law), FORCE)
    return math.pi * force.value, math.pi * force.u_num


RADII = (0.0, 0.8, 1.6, 2.5, 4.0)
HEIGHTS = tuple(r**2 / 2 for r in RADII)
GAPS = np.geomspace(0.75, 20.0, 80)


#: Punch and law of the finite elements, and the arguments of the same problem of the integral equation.
OTHERS = {
    "measured": (MeasuredPunch(RADII, HEIGHTS), LAW, {"punch": fscm.MeasuredPunch(RADII, HEIGHTS)}),
    "Mie": (SPHERE, Mie(1.0, 1.0, 12.0, 6.0), {"law": fscm.Mie(m=12.0, n=6.0)}),
    "rounded cone": (RoundedCone(0.5, 1.0), LAW, {"punch": fscm.RoundedCone(0.5)}),
    "sum of powers": (PowerSum((0.5, 0.1), (2.0, 4.0)), LAW, {"punch": fscm.PowerSum((0.5, 0.1), (2.0, 4.0))}),
    "table": (
        SPHERE,
        TabulatedLaw(GAPS, GAPS**-9 - GAPS**-3, z0=1.0, tail_exponent=3.0, work=1.0),
        {"law": fscm.TabulatedLaw(GAPS, GAPS**-9 - GAPS**-3, tail_exponent=3.0)},
    ),
}


@pytest.mark.parametrize("name", list(OTHERS)[:2])
def test_other_punches_and_laws_on_the_coarsest_mesh(name):
    """The kinks of a measured punch are nodes of the mesh; the next test has the bounds."""
    punch, law, arguments = OTHERS[name]
    exact, _ = _integral_equation(**arguments)
    state = pull_off_on_the_coarsest_mesh(Problem(SOFT, punch, law))
    assert -state.load == pytest.approx(exact, rel=COARSEST)


@pytest.mark.heavy
@pytest.mark.parametrize("name", OTHERS)
def test_punches_and_laws_against_the_integral_equation(name):
    punch, law, arguments = OTHERS[name]
    exact, u_exact = _integral_equation(**arguments)
    force = solve(Problem(SOFT, punch, law), FORCE, "quick")
    assert abs(force.value - exact) <= force.u_num + u_exact
    assert force.u_num <= 1e-5 * force.value


@pytest.mark.heavy
@pytest.mark.parametrize("k", [0.3, 0.6])
def test_a_vanishing_offset_is_the_power_law(k):
    """The pull-off force of offsets 1e-3, 1e-4 and 1e-5 falls towards that of the power law."""
    exact = solve(sphere_on(PowerLaw(1.0, 1.0, k, NU)), FORCE, "quick")
    away = []
    for z_s in (1e-3, 1e-4, 1e-5):
        offset = ProfileSolid(OffsetPowerLawModulus(1.0, 1.0, k, z_s), NU)
        force = solve(sphere_on(offset), FORCE, "quick")
        away.append((force.value - exact.value, force.u_num + exact.u_num))
    differences, bounds = np.array(away).T
    assert np.all(np.abs(differences[1:]) <= 0.6 * np.abs(differences[:-1]) + bounds[1:])


@pytest.mark.heavy
def test_the_thin_stiff_layer_of_a_smooth_transition():
    """20 nm of 1 GPa on 10 GPa under a sphere: once 27.17 +- 0.04 nN, and 27.12 +- 0.31 nN on a finer mesh."""
    solid = ProfileSolid(CoatingModulus(1e9, 1e10, 2e-8, transition=2e-9), NU)
    problem = Problem(solid, PowerPunch(2.0, 1e-7), LennardJones(0.05, 3e-10))
    default, fine = (solve(problem, FORCE, name) for name in ("default", "fine"))
    assert fine.u_num <= default.u_num <= 1e-6 * default.value
    assert abs(default.value - fine.value) <= default.u_num
