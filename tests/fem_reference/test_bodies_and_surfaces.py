"""Values of two elastic bodies, of solids with surface tension, and of bonded surfaces."""

import math
from dataclasses import replace

import pytest

from fem_reference import Homogeneous, LennardJones, PowerLaw, PowerPunch, Problem, solve, solve_large_strain
from fem_reference._contact.mesh_lengths import scales
from fem_reference._contact.meshes import Meshes
from fem_reference.accuracy import level_for
from tests.marks import heavy
from tests.refusals import refused

FORCE = "pull_off_force"
PARTS = PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)

#: Relative rounding of two computations that differ in the order of sums only (measured: up to 1e-15).
ROUNDING = 1e-12


def _force(solid, punch_solid=None, **options):
    return solve(Problem(solid, *PARTS, punch_solid), FORCE, "quick", **options)


def _agree(one, other):
    return abs(one.value - other.value) <= one.u_num + other.u_num


def test_two_bodies_are_one_of_the_combined_modulus():
    """Of different bodies tests/solvers/test_bodies.py has a light test."""
    half = Homogeneous(1.0, 0.3)
    combined = _force(Homogeneous(0.5, 0.3))
    assert _force(half, half).value == pytest.approx(combined.value, rel=ROUNDING)


@pytest.mark.heavy
def test_two_bodies_of_different_ratios_are_one_of_the_combined_modulus():
    half, other = Homogeneous(1.0, 0.3), Homogeneous(1.3, 0.45)
    plane_strain = 1.0 / (0.91 / 1.0 + (1.0 - 0.45**2) / 1.3)
    assert _agree(_force(half, other), _force(Homogeneous(0.91 * plane_strain, 0.3)))


GRADED, UNIFORM = PowerLaw(1.0, 1.0, 0.4, 0.3), Homogeneous(2.0, 0.3)


def test_two_power_laws_of_one_exponent_scale_and_bodies_can_be_exchanged():
    """The mesh and what a load displaces on it are those of both bodies, whichever is the punch."""
    assert scales(Problem(GRADED, *PARTS, replace(GRADED, E0=0.5)))
    meshes, exchanged = (
        Meshes(Problem(solid, *PARTS, punch_solid), level_for("quick"))
        for solid, punch_solid in ((GRADED, UNIFORM), (UNIFORM, GRADED))
    )
    assert not meshes.scale
    spec, size = meshes.first()
    assert spec == exchanged.first()[0]
    both = (of_pair.contact(spec, size).compliance for of_pair in (meshes, exchanged))
    one, other = (compliance.factor(size) * compliance.matrix for compliance in both)
    assert other == pytest.approx(one, rel=ROUNDING, abs=ROUNDING * one.max())


@pytest.mark.heavy
def test_exchanged_bodies_have_one_force():
    solution, exchanged = _force(GRADED, UNIFORM), _force(UNIFORM, GRADED)
    assert exchanged.value == pytest.approx(solution.value, rel=ROUNDING)
    assert min(solution.iterations, exchanged.iterations) > 5


def test_a_small_surface_tension_changes_little():
    plain = _force(Homogeneous(0.3, 0.3))
    assert _agree(_force(Homogeneous(0.3, 0.3, surface_tension=1e-9)), plain)


@pytest.mark.heavy
def test_a_large_surface_tension_makes_a_liquid():
    """The pull-off force is pi R w in the limit of a short range, a third below 3/2 pi R w of a solid.

    A solid of some tension is computed by both references in tests/solvers/test_bodies.py.
    """
    # Measured: 1.0673 here, 1.0289 and 1.0148 where tension and modulus are smaller.
    liquid = _force(Homogeneous(1e-4, 0.3, surface_tension=0.05))
    assert 1.0 < liquid.value / math.pi < 1.08


@pytest.mark.parametrize("nu", [0.0, *heavy(0.49)])
def test_a_bonded_homogeneous_solid_is_a_stiffer_one(nu):
    stiffer = 4.0 * (1.0 - nu) ** 2 / (3.0 - 4.0 * nu)
    assert _agree(_force(Homogeneous(0.5, nu), friction="bonded"), _force(Homogeneous(0.5 * stiffer, nu)))


def test_what_has_no_answer_is_refused():
    solid = PowerLaw(1.0, 1.0, 0.0, 0.3)
    pair, tense = Problem(solid, *PARTS, solid), Problem(replace(solid, surface_tension=0.1), *PARTS)
    refused("punch_solid = 3.0 is not a solid", Problem, solid, *PARTS, 3.0)
    refused("friction 'glued' is unknown", solve, pair, FORCE, friction="glued")
    refused("needs a rigid punch", solve, pair, FORCE, friction="bonded")
    for problem in (pair, tense):
        refused("critical modulus", solve, problem, "critical_modulus")
    refused("punch_solid = .* finite strain", solve_large_strain, pair, FORCE)
