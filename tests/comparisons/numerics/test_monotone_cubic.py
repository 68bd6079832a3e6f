"""The monotone cubic at one place against that of SciPy."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from comparisons.numerics.monotone_cubic import monotone_cubic


@pytest.mark.parametrize("count", [2, 3, 4, 9])
def test_it_is_the_curve_of_scipy(count):
    """Values that rise, fall, turn and stay, inside and beyond both ends."""
    rng = np.random.default_rng(count)
    for _ in range(40):
        x = np.cumsum(rng.uniform(0.1, 2.0, count))
        y = np.round(rng.normal(size=count), 1) * rng.choice([1e-6, 1.0, 1e4])
        curve = PchipInterpolator(x, y)
        for at in [*x, *rng.uniform(x[0] - 0.2, x[-1] + 0.2, 20)]:
            assert monotone_cubic(x.tolist(), y.tolist(), at) == pytest.approx(
                float(curve(at)), rel=1e-12, abs=1e-13 * np.abs(y).max()
            )
