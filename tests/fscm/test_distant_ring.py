"""Displacement at the center by distant rings: both ways against a stack in closed form and against limits."""

import numpy as np
import pytest

from fscm import CustomSolid, Layers, OffsetPowerLaw, PowerLaw
from fscm._surface.kernel import ring_response
from fscm._surface.response import response_of
from tests.fscm.distant_stack import Stiff, response_at_center
from tests.marks import heavy

#: Relative error by images: measured worst 2e-11; by the waves, whose compliance is interpolated: 3e-9.
BY_IMAGES, BY_WAVES = 1e-10, 1e-8
#: Distance from the power law far below of the response of an offset one at 1e5 offsets: measured 3e-6.
LIMIT = 1e-5


def test_both_ways_against_the_closed_form_of_a_stiff_layer() -> None:
    """From a hundredth of the thickness, where the layer bends, to 500 times it."""
    rings = response_of(Layers(*Stiff.solid)).distant
    radii = Stiff.thickness * np.array([0.01, 0.3, 1.0, 8.0, 70.0, 500.0])
    exact = np.array([response_at_center(t) for t in radii])
    assert exact[-2] > 100.0 * exact[0]
    assert rings.by_images(radii) == pytest.approx(exact, rel=BY_IMAGES)
    assert rings.by_waves(radii) == pytest.approx(exact, rel=BY_WAVES)


@pytest.mark.parametrize("k", [0.5, *heavy(0.1, 0.9)])
def test_far_away_an_offset_power_law_is_a_power_law(k: float) -> None:
    """Both ways, and the power of the radius beyond the reach of the images."""
    solid, limit = OffsetPowerLaw(1.0, 1.0, k, 1.0, 0.3), PowerLaw(1.0, 1.0, k, 0.3)
    rings = response_of(solid).distant
    t = np.array([1e5, 1e3 * rings.reach])
    expected = (1.0 - k) * limit.response_factor / (1.0 - k) * t * ring_response(k, np.zeros(2), t) / t
    assert rings.by_images(t) == pytest.approx(expected, rel=LIMIT)
    assert rings.by_waves(t[:1]) == pytest.approx(expected[:1], rel=LIMIT)


def test_the_interpolation_is_the_kernel() -> None:
    response = response_of(CustomSolid(lambda z: 1.0 + np.log1p(z), 0.3, length=1.0))
    radii = np.geomspace(0.1, 1e6, 40)
    exact = response.kernel.response(np.zeros(40), radii)
    assert response.distant.by_images(radii) == pytest.approx(exact, rel=1e-11)
    assert response.distant.by_waves(radii) == pytest.approx(exact, rel=BY_WAVES)
