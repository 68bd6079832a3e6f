"""Derivatives of values at events, against differences of solved problems, and dimensional identities."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

import fscm
from tests.marks import heavy
from tests.refusals import refused

#: Step of the differences of solved problems: their error is the third derivative times its square over 6, measured at
#: most 6e-7 of the derivative for these problems; the error of the sensitivities is far below.
STEP, DIFFERENCE = 1e-3, 2e-6
#: Of differences over five points: at most 1e-10 was measured where the value is extreme itself, 1e-7 elsewhere, where
#: the value of `solve` is as uncertain as the place of the extreme.
FINE = 1e-6
#: Of solids whose kernel is fitted: at most 8e-7 was measured over five points, at the pull-off displacement by nu.
#: Over two points the third derivative by nu leaves 1.4e-5 there.
FITTED = 2e-6
#: Of sensitivities that have to cancel: the differences of the kernels.
IDENTITY = 1e-6


def difference(value, at):
    """Central difference."""
    return (value(at + STEP) - value(at - STEP)) / (2.0 * STEP)


def five_points(value, at):
    """Central difference of fourth order."""
    values = [value(at + i * STEP) for i in (-2, -1, 1, 2)]
    return (values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (12.0 * STEP)


def close(value, expected, relative, scale=0.0):
    return abs(value - expected) <= relative * max(abs(expected), scale)


def test_a_power_law_by_all_its_numbers():
    problem = fscm.Problem(2, 0.4, 1.0)
    rates = fscm.sensitivity(problem, "pull_off_force")
    assert rates.solution.value == fscm.solve(problem, "pull_off_force").value
    assert list(rates.gradient) == ["mu", "k", "n"]
    numbers = {"n": 2.0, "k": 0.4, "mu": 1.0}
    for name, slope in rates.gradient.items():

        def value(x, name=name):
            return fscm.solve(fscm.Problem(**numbers | {name: x}), "pull_off_force").value

        assert close(slope, difference(value, numbers[name]), DIFFERENCE), name


@pytest.mark.parametrize("quantity", ["jump_in_gap", *heavy(*fscm.SENSITIVE)])
def test_every_quantity_by_the_tabor_number(quantity):
    # The third derivative of a gap at an extreme of the displacement is large near the critical number.
    expected = five_points(lambda mu: fscm.solve(fscm.Problem(2, 0.3, mu), quantity).value, 2.0)
    assert close(fscm.sensitivity(fscm.Problem(2, 0.3, 2.0), quantity).gradient["mu"], expected, FINE)


def test_another_law_and_another_punch():
    problem = fscm.Problem(1.0, 0.0, 1.5, fscm.RoundedCone(1.0), fscm.Mie(m=12, n=6))
    rates = fscm.sensitivity(problem, "pull_off_force")
    for posed, at in (
        (lambda x: replace(problem, law=fscm.Mie(m=x, n=6)), 12.0),
        (lambda x: replace(problem, punch=fscm.RoundedCone(x)), 1.0),
    ):
        slope = rates.derivative(posed, at, at)
        expected = difference(lambda x, posed=posed: fscm.solve(posed(x), "pull_off_force").value, at)
        assert close(slope, expected, DIFFERENCE, scale=0.1)


@pytest.mark.heavy
def test_the_state_follows_the_kinks_of_a_measured_punch():
    r = np.linspace(0.0, 4.0, 6)

    def posed(x):
        return fscm.Problem(2, 0.0, 1.0, fscm.MeasuredPunch((x * r).tolist(), (r**2 / 2).tolist()))

    slope = fscm.sensitivity(posed(1.0), "pull_off_force").derivative(posed, 1.0, 1.0)
    # A radius that is stretched by x is that of a sphere of radius x^2: the force is proportional to about x^2.
    expected = difference(lambda x: fscm.solve(posed(x), "pull_off_force").value, 1.0)
    assert close(slope, expected, DIFFERENCE)


def coated(E_coating=1.0, E_substrate=9.0, thickness=1.0, nu=0.3):
    return fscm.Problem(2, 0.0, 2.0, graded=fscm.Coating(E_coating, E_substrate, thickness, 0.1, nu))


@lru_cache(maxsize=4)
def quantities_of_a_coated_solid(name, value):
    return fscm.solve_together(coated(**{name: value}), tuple(fscm.SENSITIVE))


AT = {"thickness": 1.0, "E_coating": 1.0, "E_substrate": 9.0, "nu": 0.3}


def test_a_coating_that_is_slightly_thicker_changes_the_force():
    thin, thicker = (fscm.Problem(2, 0.0, 0.5, graded=fscm.Coating(1.0, 9.0, x, 0.0, 0.3)) for x in (1.0, 1.0 + STEP))
    rates = fscm.sensitivity(thin, "pull_off_force", "quick")
    change = fscm.solve(thicker, "pull_off_force", "quick").value - rates.solution.value
    assert rates.change(thicker) == pytest.approx(change, rel=3.0 * STEP)


@pytest.mark.heavy
@pytest.mark.parametrize("name", AT)
def test_quantities_of_a_coated_solid(name):
    rule = difference if name == "thickness" else five_points
    for quantity in fscm.SENSITIVE:
        slope = fscm.sensitivity(coated(), quantity).derivative(lambda x: coated(**{name: x}), AT[name], AT[name])

        def value(x, quantity=quantity):
            return quantities_of_a_coated_solid(name, x)[quantity].value

        assert close(slope, rule(value, AT[name]), FITTED, scale=0.1), quantity


def test_the_incompressible_linear_solid_has_no_neighbours():
    rates = fscm.sensitivity(fscm.Problem(2, 1.0, 0.1), "pull_off_force")
    # A paraboloid has the same force at any Tabor number.
    assert abs(rates.gradient["mu"]) < IDENTITY
    refused("no neighbours", rates.change, fscm.Problem(2, 0.9, 0.1))


def test_quantities_without_a_sensitivity():
    refused("hysteresis_energy is none of those", fscm.sensitivity, fscm.Problem(2, 0, 1.0), "hysteresis_energy")
    refused("unknown quantity", fscm.ValueSensitivity, fscm.Problem(2, 0, 1.0), "force")
    with pytest.raises(fscm.NoSuchEvent):
        fscm.sensitivity(fscm.Problem(2, 0, 0.1), "jump_in_gap")
