"""The contract of every closed form: a value with a bound, or a reason."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal, localcontext

import numpy as np
import pytest

from comparisons import create, registry
from comparisons.model import Model, NotApplicable, Result
from comparisons.models.closed_form import ClosedForm, monomial
from comparisons.models.homogeneous_sphere import HomogeneousSphere
from comparisons.models.jkr_sphere import JKRSphere
from comparisons.problem import Problem, Section
from comparisons.quantities import QUANTITIES
from fscm.laws import LennardJones

#: Every closed form of the registry, also one that is new.
MODELS = {name: type(create(name)) for name in registry.MODELS if isinstance(create(name), ClosedForm)}
#: Models that have numbers only.
WITHOUT_CURVE = {"carpick-ogletree-salmeron", "jump-asymptotes"}


def test_closed_forms_are_found() -> None:
    assert MODELS.keys() >= {"jkr", "md-original", "md-improved", "dmt", "bradley", "semi-rigid"}


@pytest.fixture(params=MODELS)
def model(request: pytest.FixtureRequest) -> ClosedForm:
    return MODELS[request.param]()


def test_names(model: ClosedForm) -> None:
    assert isinstance(model, Model)
    assert MODELS[model.name] is type(model)
    assert model.citation
    assert model.domain


def problem_of(model: ClosedForm, mu: float) -> Problem:
    """A problem in the domain of the model."""
    if isinstance(model, JKRSphere):
        solid, law = {"E": math.sqrt(1e3 / mu**3), "nu": 0.0}, {"work_of_adhesion": 1.0, "z0": 1.0}
        return Problem(
            Section("homogeneous", solid), Section("ball", {"R": 1e3}), Section("lennard-jones-9-3", law), name="ball"
        )
    return Problem.dimensionless(2, 0.0 if isinstance(model, HomogeneousSphere) else 0.4, mu)


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_every_quantity_has_a_value_or_a_reason(model: ClosedForm, quantity: str) -> None:
    problem = problem_of(model, 5.0)  # at a small Tabor number some models lose their folds
    if not hasattr(model, quantity):
        with pytest.raises(NotApplicable, match=rf"^{model.name} does not define {quantity}: \w[^\n]+$"):
            model.evaluate(problem, quantity)
        return
    result = model.evaluate(problem, quantity)
    assert isinstance(result, Result)
    assert result.u_num <= 1e-11 * max(1.0, abs(result.value))


def test_unknown_quantity(model: ClosedForm) -> None:
    with pytest.raises(ValueError, match="'stickiness' is unknown"):
        model.evaluate(Problem.dimensionless(2, 0, 1), "stickiness")


@dataclass(frozen=True)
class Sinusoid:
    growth: float = 2.0

    def height(self, r: np.ndarray) -> np.ndarray:
        return r**2 / 2 + 0.01 * np.sin(r) ** 2

    def slope(self, r: np.ndarray) -> np.ndarray:
        return r + 0.01 * np.sin(2 * r)


class OtherLaw(LennardJones):
    """A subclass may override anything, so it is another law."""


def test_curves_are_consistent(model: ClosedForm) -> None:
    problem = problem_of(model, 1.5)
    if model.name in WITHOUT_CURVE:
        with pytest.raises(NotApplicable, match=rf"{model.name} has no[^\n]+$"):
            model.curve(problem)
        return
    curve = model.curve(problem)
    assert curve.displacement.shape == curve.load.shape
    assert all(column.shape == curve.load.shape for column in curve.columns.values())
    assert np.all(np.isfinite(curve.displacement) & np.isfinite(curve.load))


def test_monomial_bound_covers_the_condition_of_a_large_exponent() -> None:
    """1 + eps to the power 1e6 moves by 1e6 eps, and so does the bound."""
    result = monomial((1.5, 1e3), (1.5, -1e3))
    assert abs(result.value - 1.0) <= result.u_num
    assert result.u_num > 1e-13


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
    both, first, second = monomial((3.0, 2.0), (5.0, -1.0)), monomial((3.0, 2.0)), monomial((5.0, -1.0))
    relative = first.u_num / first.value + second.u_num / second.value
    assert both.u_num / both.value == pytest.approx(relative, rel=1e-12, abs=0.0)
