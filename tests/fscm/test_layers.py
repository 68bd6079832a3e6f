"""Pull-off forces of layered solids: complete paths, against JKR on the same layers (tests/solvers/layered_jkr.py)."""

import math

import numpy as np
import pytest

from fscm import _events as events
from fscm._path_end import beyond_layers
from tests.fscm.solved_once import SUBSTRATE, WORK, R, stiff_on_soft
from tests.marks import heavy
from tests.solvers.layered_jkr import Stack, jkr
from tests.solvers.test_layered_jkr import COATINGS

UNIT = math.pi * R * WORK


def minima(analysis, unit):
    """Contact radii and loads of all minima of the load in contact, about."""
    pairs = events.brackets(analysis.points, events.load_fold, rising=True)
    states = [events.locate(*pair, events.load_fold) for pair in pairs]
    return [(state.scale * unit, state.load) for state in states if state.follows_edge]


def test_the_load_has_the_minima_of_jkr_and_the_deepest_is_the_pull_off():
    """1 GPa, 100 nm on 1.5 MPa: the first minimum, at 75 nm, has half of the load of the second one."""
    analysis, unit = stiff_on_soft()
    for minimum, expected in zip(minima(analysis, unit), COATINGS[1e9, 0.4, 100e-9], strict=True):
        radius, force, _ = expected
        assert minimum == (pytest.approx(radius, rel=0.1), pytest.approx(-force / UNIT, rel=0.03))
    force = analysis.solution("pull_off_force")
    assert force.value * UNIT == pytest.approx(663.18121e-9, rel=2e-7)
    assert force.u_num < 2e-7 * force.value


def test_a_compressive_load_does_not_end_the_path_above_a_stiff_layer():
    """The first compressive state is inside the radius over which the layer bends."""
    analysis, unit = stiff_on_soft()
    points = analysis.points
    compressive = [point.state for point in points if point.state.follows_edge and point.state.load > 0.0]
    assert not beyond_layers(compressive[0])
    assert beyond_layers(compressive[-1])
    # The layer bends up to 1.7 um, twice its thickness times the cube root of the contrast: the margin is above that.
    assert 1.9e-6 < compressive[-1].scale * unit < 5e-6
    assert not any(beyond_layers(state) for state in compressive if state.scale * unit < 1.9e-6)


@pytest.mark.parametrize(("E", "thickness"), [(1e9, 100e-9), *heavy((1e10, 3e-8), (1e9, 1.5e-7))])
def test_no_minimum_follows_the_end_of_a_path(E, thickness):
    """By JKR, up to three times the contact radius of the softest material: the load rises from the end on."""
    analysis, unit = stiff_on_soft(E, thickness)
    limit = jkr(Stack(((E, 0.4, thickness),), SUBSTRATE), WORK, R)
    radii = np.geomspace(analysis.points[-1].state.scale * unit, limit.reach, 6)
    loads = [limit.state(a).load for a in radii]
    assert loads[0] > 0.0
    assert np.all(np.diff(loads) > 0.0)
