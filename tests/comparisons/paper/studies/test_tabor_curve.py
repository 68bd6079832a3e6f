"""Forces over the Tabor number between the points they were computed at, and their largest errors."""

import numpy as np
import pytest

from comparisons.models.cohesive_stress import eta
from comparisons.models.maugis_dugdale import MaugisDugdaleImproved
from comparisons.paper.studies.tabor_curve import RANGE, TaborCurve, crossing, largest_error, tabor_numbers
from comparisons.paper.values.causes import cohesive_forces
from comparisons.runs.cases import Case


@pytest.mark.parametrize("n", [1.5, pytest.param(5.0, marks=pytest.mark.heavy)])
def test_between_the_points_the_curve_is_the_model(n):
    curve = TaborCurve.through(np.array(cohesive_forces(n, 0.4, eta(n))))
    rng = np.random.default_rng(7)
    mu = np.exp(rng.uniform(*np.log(RANGE), 12))
    direct = [MaugisDugdaleImproved().evaluate(Case(n, 0.4, x).problem(), "pull_off_force").value for x in mu]
    np.testing.assert_allclose(curve(mu), direct, rtol=curve.error + 1e-13)
    assert curve.error < 1e-8


def test_a_series_that_is_too_short_has_a_large_error():
    kink = np.maximum(np.array(tabor_numbers(40)), 0.7)
    curve = TaborCurve.through(kink)
    mu = np.geomspace(*RANGE, 999)
    true_error = np.max(np.abs(curve(mu) / np.maximum(mu, 0.7) - 1))
    assert 1e-3 < true_error < 10 * curve.error


def error_curves():
    """kappa = 0.1 / (1 + log(mu / 0.3)^2 / 2), largest at mu = 0.3."""
    mu = np.array(tabor_numbers(80))
    hump = 1.0 + 0.1 / (1.0 + 0.5 * np.log(mu / 0.3) ** 2)
    return TaborCurve.through(hump), TaborCurve.through(np.ones(81))


def test_the_largest_error_is_found_between_samples_and_at_ends():
    model, exact = error_curves()
    whole = largest_error(model, exact)
    assert (whole.kappa, whole.mu) == (pytest.approx(0.1, abs=1e-8), pytest.approx(0.3, rel=1e-5))
    end = largest_error(model, exact, low=1.0)
    assert (end.kappa, end.mu) == (pytest.approx(0.1 / (1 + 0.5 * np.log(0.3) ** 2), abs=1e-8), 1.0)
    sampled = largest_error(model, exact, sampled=np.array([0.1, 0.2, 0.5]))
    assert sampled.mu == 0.2
    assert sampled.kappa < whole.kappa


def test_where_a_curve_passes_a_value():
    assert crossing(np.sqrt, 0.5) == pytest.approx(0.25, rel=1e-6)
    assert crossing(np.sqrt, 50.0) is None
