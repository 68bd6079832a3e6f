"""Events of graded solids, other laws and other punches: inside the bounds of routes that share nothing with the mesh.

Hankel transforms, the integral equation (punches and laws on a power law), limits in which two solids are one, units,
and finer meshes.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

import fscm
from fem_reference import (
    LennardJones,
    MeasuredPunch,
    Mie,
    NoSuchEvent,
    PowerLaw,
    PowerPunch,
    PowerSum,
    Problem,
    RoundedCone,
    TabulatedLaw,
    solve,
    solve_together,
)
from fem_reference.coating import CoatingModulus
from fem_reference.depth_profiles import ExponentialModulus, TableModulus, TablePoisson
from fem_reference.modulus import OffsetPowerLawModulus, PowerLawModulus
from fem_reference.poisson import CoatingPoisson, CustomPoisson
from tests.fem_reference.hankel_reference import pull_off
from tests.fem_reference.profile_solid import ProfileSolid
from tests.fem_reference.solved_together import COARSEST, pull_off_on_the_coarsest_mesh
from tests.fem_reference.test_coatings import HANKEL_ERROR

NU = 0.3
LAW = LennardJones(1.0, 1.0)
SPHERE, CONE = PowerPunch(2.0, 1.0), PowerPunch(1.0, 1.0)
FORCE, DISPLACEMENT = "pull_off_force", "pull_off_displacement"
JUMPS = ("jump_in_displacement", "jump_out_displacement")
SOFT = PowerLaw(1.0, 1.0, 0.0, NU)
NUS = CoatingPoisson(0.2, 0.45, 1.0)
LAYERS_OF_NU = ProfileSolid(PowerLawModulus(1.0, 1.0, 0.0), NUS)


def _uniform(z):
    return 1.0 + 0.0 * z


def _agree(found, reference, other=0.0):
    """Within the sum of the bounds, for every quantity that both have."""
    assert found.keys() == reference.keys()
    for name, value in found.items():
        if isinstance(value, NoSuchEvent):
            assert isinstance(reference[name], NoSuchEvent)
        else:
            assert abs(value.value - reference[name].value) <= value.u_num + reference[name].u_num + other


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("solid", "nu", "options"),
    [
        pytest.param(LAYERS_OF_NU, NUS, {}, id="nu of layers"),
        pytest.param(ProfileSolid(CoatingModulus(10.0, 1.0, 1.0), NUS), NUS, {"radius": 22.0}, id="both"),
        pytest.param(
            ProfileSolid(TableModulus((0.0, 1.0, 2.0), (1.0, 1.5, 4.0)), TablePoisson((0.0, 2.0), (0.4, 0.1))),
            TablePoisson((0.0, 2.0), (0.4, 0.1)),
            {},
            id="table",
        ),
    ],
)
def test_poissons_ratio_of_depth_against_hankel_transforms(solid, nu, options):
    """Force and displacement (measured difference: 9e-8)."""
    sharp = (1.0,) if nu is NUS else ()
    reference = pull_off(solid.modulus, nu, lambda r: r**2 / 2, sharp=sharp, **options)
    found = solve_together(Problem(solid, SPHERE, LAW), (FORCE, DISPLACEMENT), "quick")
    for name, exact in ((FORCE, reference.force), (DISPLACEMENT, reference.displacement)):
        assert abs(found[name].value - exact) <= found[name].u_num + HANKEL_ERROR
        assert found[name].u_num <= 1e-5


def _integral_equation(punch=None, law=None, mu=(1.0 - NU**2) ** (2.0 / 3.0)):
    """Pull-off force on the soft homogeneous solid by the integral equation, in the units of the finite elements."""
    found = fscm.solve(fscm.Problem(n=2.0, k=0.0, mu=mu, punch=punch, law=law), FORCE)
    return math.pi * found.value, math.pi * found.u_num


RADII = (0.0, 0.8, 1.6, 2.5, 4.0)
HEIGHTS = tuple(r**2 / 2 for r in RADII)
GAPS = np.geomspace(0.75, 20.0, 80)


def test_a_measured_punch_on_the_coarsest_mesh_against_the_integral_equation():
    """Its kinks are nodes of the mesh; the next test has the bounds, other punches and laws."""
    exact, _ = _integral_equation(punch=fscm.MeasuredPunch(RADII, HEIGHTS))
    state = pull_off_on_the_coarsest_mesh(Problem(SOFT, MeasuredPunch(RADII, HEIGHTS), LAW))
    assert -state.load == pytest.approx(exact, rel=COARSEST)


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("punch", "law", "other"),
    [
        pytest.param(MeasuredPunch(RADII, HEIGHTS), LAW, {"punch": fscm.MeasuredPunch(RADII, HEIGHTS)}, id="measured"),
        pytest.param(RoundedCone(0.5, 1.0), LAW, {"punch": fscm.RoundedCone(0.5)}, id="rounded cone"),
        pytest.param(
            PowerSum((0.5, 0.1), (2.0, 4.0)),
            LAW,
            {"punch": fscm.PowerSum((0.5, 0.1), (2.0, 4.0))},
            id="sum of powers",
        ),
        pytest.param(SPHERE, Mie(1.0, 1.0, 12.0, 6.0), {"law": fscm.Mie(m=12.0, n=6.0)}, id="Mie"),
        pytest.param(
            SPHERE,
            TabulatedLaw(GAPS, GAPS**-9 - GAPS**-3, z0=1.0, tail_exponent=3.0, work=1.0),
            {"law": fscm.TabulatedLaw(GAPS, GAPS**-9 - GAPS**-3, tail_exponent=3.0)},
            id="table",
        ),
    ],
)
def test_punches_and_laws_against_the_integral_equation(punch, law, other):
    exact, u_exact = _integral_equation(**other)
    found = solve(Problem(SOFT, punch, law), FORCE, "quick")
    assert abs(found.value - exact) <= found.u_num + u_exact
    assert found.u_num <= 1e-5 * found.value


def _in_two_units():
    """An exponential solid under a sphere of 100 nm without units, the same in newtons and metres; the unit of load."""
    E, R, z0 = 2e9, 1e-7, 3e-10
    unit = math.sqrt(R * z0)
    work = E * z0**1.5 / math.sqrt(R)
    dimensionless = Problem(ProfileSolid(ExponentialModulus(1.0, 4.0, 2.0), NU), SPHERE, LAW)
    solid = ProfileSolid(ExponentialModulus(E, 4.0 * E, 2.0 * unit), NU)
    physical = Problem(solid, PowerPunch(2.0, R), LennardJones(work, z0))
    return dimensionless, physical, work * R


@pytest.mark.heavy
def test_the_bound_has_the_unit_of_the_load():
    *problems, newton = _in_two_units()
    first, second = (solve(problem, FORCE, "quick") for problem in problems)
    assert second.value == pytest.approx(first.value * newton, rel=1e-9)
    assert second.u_num == pytest.approx(first.u_num * newton, rel=1e-2)


HOMOGENEOUS = [
    ProfileSolid(CoatingModulus(1.0, 1.0, 0.7), NU),
    ProfileSolid(ExponentialModulus(1.0, 1.0, 1.0), NU),
    ProfileSolid(TableModulus((0.0, 1.0, 2.0), (1.0, 1.0, 1.0)), TablePoisson((0.0, 1.0), (NU, NU))),
    ProfileSolid(PowerLawModulus(1.0, 1.0, 0.0), CustomPoisson(lambda z: NU + 0.0 * z)),
]


@pytest.mark.heavy
@pytest.mark.parametrize("solid", HOMOGENEOUS)
@pytest.mark.parametrize(
    ("punch", "stiffness"),
    [
        (SPHERE, 0.3),
        (SPHERE, 3.0),
        (CONE, 0.3),
        (CONE, 3.0),
    ],
)
def test_homogeneous_limits(solid, punch, stiffness):
    """All events on the mesh of one size against those of the solid that scales."""
    law = LennardJones(1.0 / stiffness, 1.0)
    names = (FORCE, *JUMPS)
    scaling = solve_together(Problem(SOFT, punch, law), names, "quick")
    _agree(solve_together(Problem(solid, punch, law), names, "quick"), scaling)


@pytest.mark.heavy
@pytest.mark.parametrize("k", [0.3, 0.6])
def test_a_vanishing_offset_is_the_power_law(k):
    """The pull-off force of offsets 1e-3, 1e-4 and 1e-5 falls towards that of the power law."""
    exact = solve(Problem(PowerLaw(1.0, 1.0, k, NU), SPHERE, LAW), FORCE, "quick")
    away = []
    for z_s in (1e-3, 1e-4, 1e-5):
        offset = ProfileSolid(OffsetPowerLawModulus(1.0, 1.0, k, z_s), NU)
        found = solve(Problem(offset, SPHERE, LAW), FORCE, "quick")
        away.append((found.value - exact.value, found.u_num + exact.u_num))
    differences, bounds = np.array(away).T
    assert np.all(np.abs(differences[1:]) <= 0.6 * np.abs(differences[:-1]) + bounds[1:])


CERTAIN = [
    (ProfileSolid(CoatingModulus(10.0, 1.0, thickness=1.0), NU), SPHERE),
    (ProfileSolid(CoatingModulus(10.0, 1.0, thickness=1.0, transition=0.02), NU), SPHERE),
    (ProfileSolid(CoatingModulus(1.0, 10.0, 1.0), NU), CONE),
    (ProfileSolid(CoatingModulus(0.2, 2.0, 1.0, 0.1), NU), SPHERE),
    (ProfileSolid(CoatingModulus(2.0, 0.2, 0.1), NUS), SPHERE),
    (ProfileSolid(TableModulus((0.0, 0.5, 1.0, 3.0), (2.0, 1.0, 3.0, 0.5)), NU), SPHERE),
]


@pytest.mark.heavy
@pytest.mark.parametrize(("solid", "punch"), CERTAIN)
def test_finer_meshes_are_more_certain(solid, punch):
    quick, default, fine = (solve(Problem(solid, punch, LAW), FORCE, name) for name in ("quick", "default", "fine"))
    assert fine.u_num <= default.u_num <= quick.u_num
    for coarse in (quick, default):
        assert abs(coarse.value - fine.value) <= coarse.u_num + fine.u_num


@pytest.mark.heavy
def test_the_thin_stiff_layer_of_a_smooth_transition():
    """20 nm of 1 GPa on 10 GPa under a sphere: once 27.17 +- 0.04 nN, and 27.12 +- 0.31 nN on a finer mesh."""
    solid = ProfileSolid(CoatingModulus(1e9, 1e10, 2e-8, transition=2e-9), NU)
    problem = Problem(solid, PowerPunch(2.0, 1e-7), LennardJones(0.05, 3e-10))
    default, fine = (solve(problem, FORCE, name) for name in ("default", "fine"))
    assert fine.u_num <= default.u_num <= 1e-6 * default.value
    assert abs(default.value - fine.value) <= default.u_num


@pytest.mark.heavy
def test_kinks_on_a_graded_solid():
    """A profile of many points is the smooth shape, up to the square of their distance."""
    solid = ProfileSolid(ExponentialModulus(1.0, 4.0, 2.0), NU)
    smooth = solve(Problem(solid, SPHERE, LAW), FORCE, "quick")
    away = []
    for count in (6, 11):
        r = np.linspace(0.0, 5.0, count)
        profile = MeasuredPunch(r, r**2 / 2)
        away.append(solve(Problem(solid, profile, LAW), FORCE, "quick").value - smooth.value)
    assert abs(away[1]) <= 0.4 * abs(away[0])
    assert replace(profile, growth=2.0) == profile
