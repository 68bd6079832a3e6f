"""The contract of every closed form: a value with a bound, or a reason."""

from __future__ import annotations

import math
from dataclasses import replace
from decimal import Decimal, localcontext

import numpy as np
import pytest

import fscm
from comparisons import create, registry
from comparisons.description.strain_errors import ball_on
from comparisons.model import NotApplicable
from comparisons.models import transition_formulas
from comparisons.models.closed_form import ClosedForm, monomial
from comparisons.models.jkr_sphere import JKRSphere
from comparisons.models.jkr_surface_tension import JKRSurfaceTension
from comparisons.models.profile_branch import ProfileModel
from comparisons.problem import Problem, Section
from comparisons.quantities import QUANTITIES
from tests.comparisons.models.profiles import power_law

#: Every closed form of the registry, also one that is new.
MODELS = [name for name in registry.MODELS if isinstance(create(name), ClosedForm)]
#: Relative error of a form that is no rounding: of its series, of the place of a minimum of the load.
ROUNDING = {"jkr-surface-tension": 4e-7, "jkr-profile": 1e-4, "md-profile": 1e-4}
#: Largest contact at the start of a curve that has no limit there in closed form, relative to the largest.
SMALLEST = {"jkr-surface-tension": 1e-4}
WITH_CURVES = [name for name in MODELS if {"force_curve", "pull_off_force"} <= set(dir(create(name)))]


@pytest.fixture(params=MODELS)
def model(request: pytest.FixtureRequest) -> ClosedForm:
    return create(request.param)


def problem_of(model: ClosedForm, mu: float, n: float = 2.0, k: float = 0.4) -> Problem:
    """A problem in the domain of the model, for a ball and formulas for a paraboloid with their only n and k."""
    if isinstance(model, JKRSphere | JKRSurfaceTension):
        ball = ball_on((mu / (30.0 * n**4)) ** 1.5, mu, 0.0)
        if isinstance(model, JKRSphere):
            return ball
        # Its length 2 Y/E* is about a contact radius.
        solid = Section(ball.solid.kind, {**ball.solid.values, "surface_tension": ball.solid["E"] ** (2.0 / 3.0)})
        return replace(ball, solid=solid, punch=Section("sphere", {"R": 1.0}))
    if isinstance(model, ProfileModel):
        # Maugis-Dugdale of any profile is for k < 1.
        return power_law(n, min(k, 0.95) if model.name == "md-profile" else k, mu)
    only = isinstance(model, transition_formulas._HomogeneousSphere)
    return Problem.dimensionless(*((2.0, 0.0) if only else (n, k)), mu)


def test_every_quantity_has_a_value_or_a_reason(model: ClosedForm) -> None:
    problem = problem_of(model, 5.0)  # at a small Tabor number some models lose their folds
    for quantity in QUANTITIES:
        if hasattr(model, quantity):
            result = model.evaluate(problem, quantity)
            assert result.u_num <= ROUNDING.get(model.name, 1e-11) * max(1.0, abs(result.value))
        else:
            with pytest.raises(NotApplicable, match=rf"^{model.name} does not define {quantity}: \w[^\n]+$"):
                model.evaluate(problem, quantity)
    if not hasattr(model, "force_curve"):
        with pytest.raises(NotApplicable, match=rf"^{model.name} does not define force_curve: \w[^\n]+$"):
            model.curve(problem)
    with pytest.raises(ValueError, match="'stickiness' is unknown"):
        model.evaluate(problem, "stickiness")


@pytest.mark.parametrize(
    ("n", "k", "mu"), [(1.0, 0.0, 0.03), (2.0, 0.4, 3.0), (5.0, 0.6, 3.0), (1.5, 0.95, 20.0), (2.0, 1.0, 0.5)]
)
@pytest.mark.parametrize("name", WITH_CURVES)
def test_a_curve_passes_the_events_of_its_model(name: str, n: float, k: float, mu: float) -> None:
    model = create(name)
    problem = problem_of(model, mu, n, k)
    curve = model.curve(problem)

    def value(quantity: str) -> float:
        return model.evaluate(problem, quantity).value

    force, lowest, extent = value("pull_off_force"), int(np.argmin(curve.load)), np.ptp(curve.displacement)
    assert (1.0 - 1e-3) * force <= -curve.load[lowest] <= force * (1.0 + 1e-12)
    assert curve.load[-1] > 0.0
    assert curve.displacement[lowest] == pytest.approx(value("pull_off_displacement"), abs=0.02 * extent)
    at_zero = np.interp(0.0, curve.load[lowest:], curve.displacement[lowest:])
    assert at_zero == pytest.approx(value("zero_load_displacement"), abs=5e-3 * extent)
    if "contact_radius" in curve.columns:
        contact = curve.columns["contact_radius"]
        assert contact[0] <= SMALLEST.get(name, 0.0) * contact[-1]
        assert np.all(np.diff(contact) > 0.0)
        assert np.all(curve.columns.get("cohesive_radius", contact) >= contact)
    if hasattr(model, "jump_out_displacement") and mu > 1.0:
        fold = value("jump_out_displacement")
        assert fold - 1e-12 * extent <= curve.displacement.min() < fold + 2e-3 * extent


def exact_power(base: float, exponent: float, wrong_base: float = 0.0, wrong_exponent: float = 0.0) -> Decimal:
    """base**exponent to 40 digits, with relative errors of both."""
    with localcontext() as context:
        context.prec = 40
        return (Decimal(base) * (1 + Decimal(wrong_base))) ** (Decimal(exponent) * (1 + Decimal(wrong_exponent)))


@pytest.mark.parametrize(("base", "exponent"), [(1.5, 2.0), (1e6, 1.3), (7.0, 1 / 3), (0.02, -2.5), (1e-9, 0.1)])
def test_monomial_bound_is_the_effect_of_a_factor_that_is_wrong_by_16_roundings_and_of_a_rounded_power(
    base: float, exponent: float
) -> None:
    """A factor of a special function is within 16 eps of the exact one, and a logarithm within eps of itself."""
    exact, result = exact_power(base, exponent), monomial((base, exponent))
    assert abs(Decimal(result.value) - exact) <= Decimal(result.u_num)
    rounded = math.copysign(2.0**-52, math.log(base))  # so that both errors have one sign
    worst = abs(exact_power(base, exponent, 16.0 * 2.0**-52, rounded) - exact)
    assert result.u_num == pytest.approx(float(worst), rel=1e-9, abs=0.0)


def test_monomial_bound_has_that_of_each_factor() -> None:
    both, square, inverse = monomial((3.0, 2.0), (5.0, -1.0)), monomial((3.0, 2.0)), monomial((5.0, -1.0))
    relative = square.u_num / square.value + inverse.u_num / inverse.value
    assert both.u_num / both.value == pytest.approx(relative, rel=1e-12, abs=0.0)


def test_a_problem_of_fscm_stands_for_its_numbers(model: ClosedForm) -> None:
    """As the gallery has it; without a profile or a size of the ball there are none of it."""
    if isinstance(model, ProfileModel | JKRSphere | JKRSurfaceTension):
        return
    problem = problem_of(model, 5.0)
    quantity = next(name for name in QUANTITIES if model.skip(problem, name) is None)
    posed = fscm.Problem(problem.n, problem.k, problem.mu)
    assert model.evaluate(posed, quantity) == model.evaluate(problem, quantity)
