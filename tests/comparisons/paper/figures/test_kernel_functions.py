"""Fig. 2: the derivative of Phi, and the limit k -> 1."""

import numpy as np
import pytest

from comparisons.paper.figures.fig02_kernel_functions import _RATIOS, values


def as_arrays(k):
    return {name: np.array(column, float) for name, column in values(k).items()}


@pytest.mark.parametrize("k", [0.0, 0.4, 0.8])
def test_the_slope_is_the_derivative(k):
    found = as_arrays(k)
    even = np.isclose(np.mod(_RATIOS, 0.02), 0.0, atol=1e-9) | np.isclose(np.mod(_RATIOS, 0.02), 0.02, atol=1e-9)
    s = _RATIOS[even]
    numerical = np.gradient(found["phi"][even], s)
    away = (np.abs(s - 1) > 0.3) & (s > 0.1) & (s < 2.9)
    assert found["slope"][even][away] == pytest.approx(numerical[away], rel=5e-3)
    assert np.isnan(found["slope"][_RATIOS == 1]).all()


@pytest.mark.parametrize("k", [0.0, 0.4, 0.8, 1.0])
def test_psi_is_phi_less_the_power(k):
    found = as_arrays(k)
    positive = _RATIOS > 0
    assert found["psi"][positive] == pytest.approx((found["phi"] - _RATIOS ** (1 - k))[positive], abs=1e-13)


def test_the_gibson_limit_is_the_limit():
    near, limit = as_arrays(0.99), as_arrays(1.0)
    away = (np.abs(_RATIOS - 1) > 0.05) & (_RATIOS > 0.01)
    # With 1-k = 0.01: s^(1-k) is off by (1-k) log s, the slope by (1-k) / 2 over the distance of the step.
    for name, tolerance in (("phi", 0.012), ("psi", 0.047), ("slope", 0.12)):
        assert np.abs(near[name] - limit[name])[away].max() < tolerance
    at_one = _RATIOS == 1
    assert near["phi"][at_one] == pytest.approx(limit["phi"][at_one], abs=1e-3)
    assert near["psi"][at_one] == pytest.approx(limit["psi"][at_one], abs=1e-3)
