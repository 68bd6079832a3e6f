"""DMT against Hertz, Bradley, and the Maugis-Dugdale equations at a vanishing Maugis number."""

from __future__ import annotations

import numpy as np
import pytest

from comparisons import create
from comparisons.model import Result
from comparisons.models.dmt import DMT
from comparisons.problem import Problem

contact = Problem.dimensionless
BOTH = pytest.mark.parametrize("name", ["dmt", "dmt-strength"])


def force_of(name: str, problem: Problem) -> float:
    return create(name).evaluate(problem, "pull_off_force").value


@pytest.mark.parametrize("n", [0.8, 1.0, 2.0, 5.0, 10.0])
def test_pull_off(n: float) -> None:
    """Eq. 74, and the strength over the disc in which the undeformed gap r^n / n is below 1 / sigma_th."""
    problem, strength = contact(n, 0.4, 0.7), 16 * np.sqrt(3) / 27
    assert force_of("dmt", problem) == pytest.approx(force_of("bradley", problem), rel=1e-13)
    assert force_of("dmt-strength", problem) == pytest.approx(strength * (n / strength) ** (2 / n), rel=1e-13)
    assert DMT().evaluate(problem, "pull_off_displacement").value == 0.0


@BOTH
def test_homogeneous_sphere_is_hertz(name: str) -> None:
    """P = (4/3) E* a^3 / R - 2 pi R dgamma, delta = a^2 / R; E* = mu^(-3/2) for Q = z0 = dgamma = 1."""
    mu, model = 0.6, create(name)
    curve = model.curve(contact(2, 0, mu))
    a = curve.columns["contact_radius"]
    np.testing.assert_allclose(curve.load, (4 / 3) * mu**-1.5 * a**3 / np.pi - 2, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(curve.displacement, a**2, rtol=1e-14)
    zero = (1.5 * np.pi * mu**1.5) ** (2 / 3)
    assert model.evaluate(contact(2, 0, mu), "zero_load_displacement").value == pytest.approx(zero, rel=1e-13)


@pytest.mark.parametrize(("name", "finite"), [("dmt", "md-improved"), ("dmt-strength", "md-original")])
@pytest.mark.parametrize(("n", "k"), [(1.0, 0.2), (1.5, 0.0), (5.0, 0.6)])
def test_it_is_the_limit_of_maugis_dugdale(name: str, finite: str, n: float, k: float) -> None:
    """The difference vanishes like a positive power of mu: a thousandth of mu shrinks it manyfold."""
    for quantity in ("pull_off_force", "zero_load_displacement"):
        errors = []
        for mu in (1e-3, 1e-6):
            dmt, dugdale = (create(model).evaluate(contact(n, k, mu), quantity).value for model in (name, finite))
            errors.append(abs(dugdale / dmt - 1.0))
        assert errors[1] < 0.05 * errors[0] < 0.05


def test_the_zero_load_displacement_inherits_the_bound_of_the_adhesion(monkeypatch: pytest.MonkeyPatch) -> None:
    """It covers what an adhesion that is wrong by its bound changes, and little more."""
    problem, model, relative = contact(5.0, 0.6, 0.7), DMT(), 1e-6
    adhesion = model.pull_off_force(problem).value

    def estimate(factor: float, bound: float) -> Result:
        monkeypatch.setattr(model, "pull_off_force", lambda _: Result(factor * adhesion, bound * adhesion))
        return model.zero_load_displacement(problem)

    low, middle, high = (estimate(factor, relative) for factor in (1.0 - relative, 1.0, 1.0 + relative))
    change = max(high.value - middle.value, middle.value - low.value)
    assert change * (1.0 - 1e-5) < middle.u_num < 1.001 * change
    # With an exact adhesion: the rounding of the power n / (n + k + 1) and of two factors.
    exact, least = estimate(1.0, 0.0), 16.0 * 2.0**-52 * (1.0 + 2.0 * 5.0 / 6.6)
    assert least * exact.value < exact.u_num < 2.0 * least * exact.value
