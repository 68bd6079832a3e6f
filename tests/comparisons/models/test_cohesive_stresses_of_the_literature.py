"""M-D-n-k with the cohesive stress 1, and DMT with the theoretical strength."""

from __future__ import annotations

import math

import numpy as np
import pytest

import fscm
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.dmt import DMT
from comparisons.models.dmt_strength import DMTStrength
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.jkr import JKR
from comparisons.models.maugis_dugdale import MaugisDugdaleImproved, MaugisDugdaleOriginal
from comparisons.models.maugis_dugdale_jin import MaugisDugdaleJin
from comparisons.problem import Problem
from fscm import LennardJones, PowerLaw, PowerPunch

contact = Problem.dimensionless


@pytest.mark.parametrize(("n", "k", "nu"), [(2.0, 0.4, 0.3), (1.5, 0.2, 0.1), (5.0, 0.6, 0.45)])
def test_the_maugis_number_of_jin_is_his_tabor_number(n: float, k: float, nu: float) -> None:
    """Eqs. 30 and 68 in physical units without b/(1-k): their ratio is sigma_0 z0 / dgamma, as with the factor."""
    Q, E0, c0, dgamma, z0, sigma = 1.3, 2.0, 0.7, 0.11, 0.05, 0.11 / 0.05
    modulus, root = E0 / (1 - nu**2), 1 / (2 * n + k - 1)
    tabor = (Q ** (1 - k) * c0 ** (n * k) * dgamma**n / (modulus**n * z0 ** (2 * n + k - 1))) ** root
    maugis = sigma * (Q ** (1 - k) * c0 ** (n * k) * dgamma ** (1 - n - k) / modulus**n) ** root
    assert maugis == pytest.approx(tabor, rel=1e-13)
    ours = fscm.Problem(PowerLaw(E0, c0, k, nu), PowerPunch(n, Q), LennardJones(dgamma, z0)).mu
    assert not math.isclose(ours, tabor, rel_tol=1e-3)
    model = MaugisDugdaleJin()
    assert model.cohesive_stress(contact(n, k, ours)) == pytest.approx(maugis / tabor, rel=1e-13)


@pytest.mark.parametrize(("n", "k", "mu"), [(1.0, 0.0, 0.1), (1.5, 0.4, 0.5), (5.0, 0.2, 0.3), (2.0, 0.6, 1.0)])
def test_jin_lies_beside_the_original_towards_the_improved(n: float, k: float, mu: float) -> None:
    """1 lies between eta(n) and 1.026, and the pull-off force is monotonic in the stress."""
    problem = contact(n, k, mu)
    original, jin, improved = (
        model.evaluate(problem, "pull_off_force").value
        for model in (MaugisDugdaleOriginal(), MaugisDugdaleJin(), MaugisDugdaleImproved())
    )
    assert 0.0 < (jin - original) / (improved - original) < 0.2


@pytest.mark.parametrize(("n", "k"), [(1.0, 0.0), (2.0, 0.4), (5.0, 0.6)])
def test_jin_tends_to_jkr_and_to_dmt_with_its_stress(n: float, k: float) -> None:
    soft, stiff = contact(n, k, 300.0), contact(n, k, 1e-8)
    jkr = JKR().evaluate(soft, "pull_off_force").value
    assert MaugisDugdaleJin().evaluate(soft, "pull_off_force").value == pytest.approx(jkr, rel=1e-4)
    # Eq. 75 with sigma_0 = 1.
    assert MaugisDugdaleJin().evaluate(stiff, "pull_off_force").value == pytest.approx(n ** (2 / n), rel=1e-4)


@pytest.mark.parametrize(("n", "k"), [(0.7, 0.4), (1.0, 0.0), (1.5, 0.4), (2.0, 0.0), (5.0, 0.2)])
def test_dmt_strength_is_the_limit_of_the_original(n: float, k: float) -> None:
    problem = contact(n, k, 1e-9)
    dmt, original = (m.evaluate(problem, "pull_off_force").value for m in (DMTStrength(), MaugisDugdaleOriginal()))
    assert dmt == pytest.approx(original, rel=1e-4)
    # The strength over the disc in which the undeformed gap r^n / n is below 1 / sigma_th.
    strength = 16 * math.sqrt(3) / 27
    assert dmt == pytest.approx(strength * (n / strength) ** (2 / n), rel=1e-13)


def test_dmt_strength_is_dmt_for_a_paraboloid() -> None:
    for quantity in ("pull_off_force", "zero_load_displacement"):
        ours, other = (model.evaluate(contact(2, 0.3, 0.7), quantity).value for model in (DMTStrength(), DMT()))
        assert ours == pytest.approx(other, rel=1e-13)


def test_curve_of_dmt_strength_is_the_limit_of_maugis_dugdale() -> None:
    """n = 5, where the strength decides: at a vanishing Tabor number the contact branches agree."""
    mu, n, k = 1e-6, 5.0, 0.2
    problem, punch = contact(n, k, mu), GradedPunch(n, k)
    scale = punch.scales(mu)
    state = CohesiveContact(punch, 16 * math.sqrt(3) / 27 * mu).at(np.linspace(-14.0, -1.0, 200))
    curve = DMTStrength().curve(problem)
    a = scale.radius * state.contact_radius
    inside = a < curve.columns["contact_radius"][-1]
    assert np.count_nonzero(inside) > 5
    power = n + k + 1
    load = np.interp(a[inside] ** power, curve.columns["contact_radius"] ** power, curve.load)
    np.testing.assert_allclose(scale.load * state.load[inside], load, atol=2e-2)
