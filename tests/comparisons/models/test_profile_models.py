"""JKR and Maugis-Dugdale of any profile: their closed forms, their limits of the full model, what they refuse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from comparisons import create, evaluate
from comparisons.description.strain_errors import ball_on
from comparisons.model import NotApplicable
from comparisons.models.plane_profile import PlaneProfile
from comparisons.problem import Problem, Section
from tests.comparisons.models.profiles import MIE, on_solid, power_law
from tests.marks import heavy

MODEL = create("jkr-profile")
#: Models and their closed forms for power laws and the 9-3 law.
CLOSED = [("jkr-profile", "jkr"), ("md-profile", "md-original")]
QUANTITIES = ("pull_off_force", "pull_off_displacement", "jump_out_displacement", "zero_load_displacement")
NINE_THREE = Section("lennard-jones-9-3", {"work_of_adhesion": 1.0, "z0": 1.0})
TIP = Section("rounded-cone", {"R": 20.0, "slope": 0.4})


def table(heights: np.ndarray, radii: np.ndarray, **values: float) -> Section:
    """A measured profile."""
    return Section("table", {"file": "tip.csv", **values}, {"r": tuple(radii), "height": tuple(heights)})


POWER_LAWS = [(2.0, 0.0, 3.0), (1.0, 0.0, 1.0), (1.5, 0.4, 3.0), (3.0, 0.8, 0.5), (5.0, 0.3, 3.0), (2.0, 1.0, 3.0)]


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize(("n", "k", "mu"), POWER_LAWS)
@pytest.mark.parametrize(("name", "closed"), CLOSED)
def test_a_power_law_is_that_of_the_closed_form(
    name: str, closed: str, n: float, k: float, mu: float, quantity: str
) -> None:
    model, problem, posed = create(name), power_law(n, k, mu), Problem.dimensionless(n, k, mu)
    if name == "md-profile" and k == 1.0:
        with pytest.raises(NotApplicable, match="k < 1"):
            model.evaluate(problem, quantity)
        return
    try:
        exact = create(closed).evaluate(posed, quantity)
    except NotApplicable:
        with pytest.raises(NotApplicable, match="no fold in contact"):
            model.evaluate(problem, quantity)
        return
    by_profile = model.evaluate(problem, quantity)
    assert abs(by_profile.value - exact.value) <= by_profile.u_num + exact.u_num
    # Measured 4e-12, and 5e-6 where the radius is that of the least load.
    largest = 3e-5 if quantity == "pull_off_displacement" else 2e-11
    assert by_profile.u_num <= largest * (1.0 + abs(exact.value))


def test_without_contact_the_force_is_that_at_first_touch() -> None:
    """Of a rigid solid: the strength of the law on the disc where the gap is less than w over it."""
    problem = power_law(3.0, 0.0, 1e-4)
    exact = create("md-original").evaluate(Problem.dimensionless(3.0, 0.0, 1e-4), "pull_off_force")
    result = create("md-profile").evaluate(problem, "pull_off_force")
    assert abs(result.value - exact.value) <= result.u_num + exact.u_num


def test_maugis_dugdale_is_the_limit_of_a_trapezoidal_law() -> None:
    """Of a rounded cone by the full model, to the second order of the ramps."""
    forces = []
    for ramp in (0.05, 0.025):
        values = {"work_of_adhesion": 1.0, "strength": 1.0, "rise_end": ramp, "fall_start": 1.0 - ramp}
        problem = on_solid(TIP, 4.0, 0.0, Section("cohesive-trapezoid", values))
        forces.append(evaluate("fscm", "pull_off_force", problem).value)
    exact = evaluate("md-profile", "pull_off_force", problem).value
    assert abs(forces[0] / exact - 1.0) > 5e-3
    # Measured 2e-4.
    assert 2.0 * forces[1] - forces[0] == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_ball_is_that_of_maugis(quantity: str) -> None:
    ball = ball_on(5e-3, 100.0, 0.3)
    by_profile, exact = (evaluate(name, quantity, ball) for name in ("jkr-profile", "jkr-sphere-projected"))
    assert abs(by_profile.value - exact.value) <= by_profile.u_num + exact.u_num


@pytest.mark.parametrize("k", [0.0, 0.5, 1.0])
def test_the_plane_profile_of_a_kink_is_its_integral(k: float) -> None:
    """A cone outside of a flat end, by the incomplete beta function."""
    from scipy.special import beta, betaincc

    s, radius = 0.5 * (1.0 - k), 3.0
    profile, _ = PlaneProfile(lambda r: np.maximum(r - 1.0, 0.0), lambda r: np.where(r > 1.0, 1.0, 0.0), (1.0,), k).at(
        radius
    )
    exact = 0.5 * radius * float(beta(0.5, 1.0 - s) * betaincc(0.5, 1.0 - s, 1.0 / radius**2))
    assert profile == pytest.approx(exact, rel=1e-13)


@pytest.mark.parametrize(
    ("reference", "k", "modulus", "largest"),
    [("fscm", 0.0, 0.1, 2e-3), *heavy(("fscm", 0.3, 0.05, 2e-3), ("fem", 0.0, 1.0, 5e-3))],
)
def test_it_is_the_limit_of_both_references_for_soft_solids(
    reference: str, k: float, modulus: float, largest: float
) -> None:
    """Of a rounded cone; the difference falls from one Tabor number to a larger one."""
    errors = []
    for softer in (1.0, 0.1):
        problem = on_solid(TIP, softer * modulus, k, NINE_THREE)
        errors.append(abs(force_of(problem) / evaluate(reference, "pull_off_force", problem).value - 1.0))
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < largest


def force_of(problem: Problem) -> float:
    """The pull-off force in the unit of the problem."""
    return evaluate(MODEL, "pull_off_force", problem).value


def test_a_smoothed_table_of_a_paraboloid_is_the_paraboloid() -> None:
    radii = np.linspace(0.0, 300.0, 100)
    tip = table(radii**2 / 200.0, radii, smoothing=1e-3)
    assert force_of(on_solid(tip, 3e-3)) == pytest.approx(150.0 * np.pi, rel=1e-6)


def test_the_least_load_may_be_at_a_kink() -> None:
    """Rows as straight lines; the force of 60 rows is within a hundredth of that of the smooth profile."""
    radii = np.linspace(0.0, 300.0, 60)
    problem = on_solid(table(radii**2 / 200.0, radii), 3e-3)
    assert force_of(problem) == pytest.approx(150.0 * np.pi, rel=2e-2)
    curve = MODEL.curve(problem)
    assert -curve.load.min() == pytest.approx(MODEL.evaluate(problem, "pull_off_force").value, rel=1e-12)


RIPPLES = np.linspace(0.0, 300.0, 200)
RIPPLED = table(RIPPLES**2 / 200.0 + 5.0 * (1.0 - np.cos(RIPPLES / 5.0)), RIPPLES)
EXPONENTIAL = Section("exponential", {"E_surface": 1.0, "E_depth": 2.0, "length": 1.0, "nu": 0.3})
BARRIER = Section("dlvo", {"hamaker_constant": 50.0, "z0": 1.0, "double_layer": 2.7, "debye_length": 1.0})
OF_BODY = replace(MIE, values={**MIE.values, "interaction": "body"})


@pytest.mark.parametrize(
    ("problem", "reason"),
    [
        (Problem.dimensionless(2.0, 0.0, 1.0), "closed forms"),
        (on_solid(RIPPLED, 3e-3), "falls at the radius"),
        (replace(ball_on(5e-3, 100.0, 0.3), law=OF_BODY), "vertical"),
        (replace(on_solid(TIP, 0.1), solid=EXPONENTIAL), "exponential"),
        (on_solid(TIP, 0.1, law=BARRIER), "barrier"),
        (ball_on(10.0, 100.0, 0.3), "smaller than the contact"),
    ],
)
def test_what_is_not_a_disc_or_known_by_its_work_of_adhesion_is_refused(problem: Problem, reason: str) -> None:
    with pytest.raises(NotApplicable, match=reason):
        MODEL.evaluate(problem, "pull_off_force")
