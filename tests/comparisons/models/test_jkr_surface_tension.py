"""JKR with surface tension: the series against the integral equation, its limits, and the events of its curve."""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons import create
from comparisons.model import NotApplicable
from comparisons.models.jkr_surface_tension import JKRSurfaceTension
from comparisons.models.surface_tension import LARGEST, SERIES_ERROR, contact
from comparisons.problem import Problem, Section
from tests.comparisons.models.surface_tension_series import constants
from tests.marks import heavy

MODEL = JKRSurfaceTension()
EVENTS = ("pull_off", "jump_out", "zero_load")

#: Work of adhesion, radius and E* of `sphere`; the unit of contact radii is (R^2 w/E*)^(1/3) = 1e-4.
WORK, RADIUS, MODULUS = 0.05, 1e-3, 5e4


def sphere(tension, **parts):
    """A sphere by L = 2 Y/(E* A)."""
    values = {"E": 0.75 * MODULUS, "nu": 0.5, "surface_tension": 0.5 * tension * MODULUS * 1e-4}
    law = Section("lennard-jones-9-3", {"work_of_adhesion": WORK, "z0": 1e-7})
    problem = Problem(Section("homogeneous", values), Section("sphere", {"R": RADIUS}), law)
    return replace(problem, **parts)


def share(tension):
    """The pull-off force in pi R w."""
    return MODEL.evaluate(sphere(tension), "pull_off_force").value


@pytest.mark.parametrize("ratio", [3e-6, 1.0, 9e4, *heavy(2e-5, 0.03, 40.0)])
def test_the_series_is_the_solution_of_the_equation(ratio):
    """Both right-hand sides of the equation give one load: reciprocity."""
    c, m, of_paraboloid = constants(ratio)
    assert of_paraboloid == pytest.approx(m, rel=1e-11)
    at = contact(ratio)
    assert float(at.c) == pytest.approx(c, rel=SERIES_ERROR)
    assert float(at.m) == pytest.approx(m, rel=SERIES_ERROR)


@pytest.mark.parametrize("ratio", [1e-6, 0.9e-5, 1.1e-5, 1e-2, 1.0, 1e3, 0.9e5])
def test_the_slopes_are_those_of_the_values(ratio):
    """By differences in ln x, to 1e-6."""
    step = 1e-4
    low, at, high = (contact(ratio * math.exp(shift)) for shift in (-step, 0.0, step))
    slope = {name: (getattr(high, name) - getattr(low, name)) / (2.0 * step) for name in ("c", "m", "k", "e")}
    assert float(at.k) == pytest.approx(float(at.c - slope["c"]), rel=1e-6)
    assert float(at.e) == pytest.approx(float(at.m - slope["m"] / 3.0), rel=1e-6)
    assert float(at.k_rate) == pytest.approx(float(slope["k"]), rel=1e-5, abs=1e-9)
    assert float(at.e_rate) == pytest.approx(float(slope["e"]), rel=1e-5, abs=1e-9)


def test_both_limits_of_the_stiffness():
    """A half-space, and a membrane of radius l/2 exp(gamma) around the contact."""
    bare, membrane = contact(0.0), contact(LARGEST)
    assert [float(bare.c), float(bare.m), float(bare.k), float(bare.e)] == [1.0] * 4
    assert float(membrane.c) == pytest.approx(
        0.5 * math.pi * LARGEST / (math.log(2.0 * LARGEST) - np.euler_gamma), rel=1e-5
    )
    assert float(membrane.m / membrane.c) == pytest.approx(1.5, rel=1e-5)


def test_without_surface_tension_it_is_jkr():
    for name in ("pull_off_force", *(f"{event}_displacement" for event in EVENTS)):
        result, jkr = (
            create(model).evaluate(sphere(0.0).without(*absent), name)
            for model, absent in (("jkr-surface-tension", ()), ("jkr", ("solid.surface_tension",)))
        )
        assert abs(result.value - jkr.value) <= result.u_num + jkr.u_num < 1e-12 * abs(jkr.value)


def test_the_pull_off_force_falls_from_that_of_jkr_to_that_of_a_liquid():
    tensions = np.geomspace(1e-4, 1e3, 15)
    shares = np.array([share(tension) for tension in tensions])
    assert (np.diff(shares) < 0.0).all()
    assert shares[0] == pytest.approx(1.5, rel=3e-4)
    assert shares[-1] == pytest.approx(1.0, rel=2e-5)
    with pytest.raises(NotApplicable, match="pi R w"):
        share(1e4)


@pytest.mark.parametrize("tension", [1e-3, 0.1, 30.0])
def test_events_are_the_extremes_of_the_curve(tension):
    """On a curve of 401 points: the least load and the least displacement, to the square of their distance."""
    problem = sphere(tension)
    curve, mu = MODEL.curve(problem), problem.without("solid.surface_tension").posed.mu
    force = MODEL.evaluate(problem, "pull_off_force")
    assert 0.0 < force.u_num < 1e-6 * force.value
    assert -force.value == pytest.approx(curve.load.min(), rel=1e-3)
    assert curve.load.min() >= -force.value - force.u_num
    jump = MODEL.evaluate(problem, "jump_out_displacement").value
    assert jump == pytest.approx(curve.displacement.min(), abs=1e-3 * mu)
    assert curve.displacement.min() >= jump - 1e-6 * mu
    beyond = curve.displacement > MODEL.evaluate(problem, "pull_off_displacement").value
    at_zero = np.interp(0.0, curve.load[beyond], curve.displacement[beyond])
    assert MODEL.evaluate(problem, "zero_load_displacement").value == pytest.approx(at_zero, abs=1e-3 * mu)
    assert 1.0 <= curve.load[-1] / force.value < 1.2


ELASTIC = Section("homogeneous", {"E": 1e9, "nu": 0.3})


@pytest.mark.parametrize(
    ("problem", "reason"),
    [
        (Problem.dimensionless(2, 0, 1), "rigid sphere"),
        (sphere(0.1, punch=Section("ball", {"R": RADIUS})), "a ball punch"),
        (sphere(0.1, punch_solid=ELASTIC), "of a homogeneous solid"),
        (sphere(0.1, solid=Section("homogeneous", ELASTIC.values | {"friction": "bonded"})), "with friction"),
        (
            sphere(
                0.1, solid=Section("power-law", {"E0": 1e5, "c0": 1e-3, "k": 0.3, "nu": 0.3, "surface_tension": 1.0})
            ),
            "k = 0.3",
        ),
        (sphere(0.1).without("solid.surface_tension"), "it is jkr"),
    ],
)
def test_refusals(problem, reason):
    with pytest.raises(NotApplicable, match=reason):
        MODEL.evaluate(problem, "pull_off_force")
