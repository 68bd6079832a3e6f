"""Events on graded solids: limits, finite elements, exact rates, bounds, bad input."""

import numpy as np
import pytest

import fscm
from fscm._path.arc_length import parameter_of, rates_of
from fscm._path.continuation import moved
from fscm._path.pull_off_path import pull_off_path
from fscm._surface.mesh import PanelMesh
from fscm._surface.response import response_of
from fscm._surface.response.panels import remainder
from fscm.accuracy import Meshes
from fscm.analysis import Analysis
from fscm.stability import stability_of
from tests.fscm.solved_once import analysis_of
from tests.refusals import refused

SOFT_BELOW = fscm.Coating(5.0, 1.0, 0.7, 0.1, 0.3)
GRADED = fscm.Problem(2, 0.0, 0.3, graded=SOFT_BELOW)


def test_rates_along_the_path_are_exact():
    state = analysis_of(GRADED).event("pull_off").value
    rates, step = rates_of(state), 1e-3
    assert state.parameter == "log_scale"
    after, before = (moved(state, rates, parameter_of(state) + sign * step, 1e-12) for sign in (1.0, -1.0))
    for name in ("displacement", "central_gap", "load"):
        slope = (getattr(after, name) - getattr(before, name)) / (2.0 * step)
        # 1e-5: the third derivative times the square of the step
        assert slope == pytest.approx(getattr(rates, name), abs=1e-5)


def test_the_error_of_the_kernel_is_a_part_of_the_bound():
    parts = analysis_of(GRADED).solution("pull_off_force").parts
    assert 0.0 < parts["kernel"] < 1e-7
    assert fscm.solve(fscm.Problem(2, 0, 1.0), "pull_off_force").parts["kernel"] == 0.0


def test_a_refined_mesh_keeps_the_response_between_its_old_panels():
    ends = [-1.0, -0.75, -0.5, -0.1, 0.0, 0.25, 1.0, 3.0, 9.0]
    coarse, fine = (PanelMesh(np.array(x), 8, 1.0) for x in (ends, sorted({*ends, -0.3, 0.1} - {3.0})))
    table, length, step = response_of(SOFT_BELOW)._table(8), 0.6, 1e-4
    for c in (1.0, 20.0):
        full = remainder(table, length, fine, c)
        reused = remainder(table, length, fine, c, (coarse, remainder(table, length, coarse, c)))
        for name in ("matrix", "rate", "axis", "axis_rate"):
            # Products of matrices of other sizes are rounded in another order.
            assert np.allclose(getattr(full, name), getattr(reused, name), rtol=0.0, atol=1e-13)
        moved, computed = full.moved(step), remainder(table, length, fine, c * np.exp(step))
        # The second derivative times half the square of the step.
        assert np.allclose(moved.matrix, computed.matrix, rtol=0.0, atol=1e-7)
        assert np.array_equal(remainder(table, length, fine, c, (fine, moved)).matrix, moved.matrix)


def test_the_short_path_is_for_power_laws_alone():
    """On layers, for a law of the user and under another punch the load may have several minima."""
    assert pull_off_path(fscm.Problem(2, 0.0, 1.0), Meshes()) is not None
    gaps = np.geomspace(0.75, 20.0, 100)
    law = fscm.TabulatedLaw(gaps, gaps**-9 - gaps**-3, tail_exponent=3)
    assert pull_off_path(fscm.Problem(2, 0.0, 1.0, law=law), Meshes()) is None
    assert pull_off_path(GRADED, Meshes()) is None
    assert pull_off_path(fscm.Problem(1, 0.2, 1.0, punch=fscm.RoundedCone(2.0)), Meshes()) is None


def test_what_needs_a_power_law_is_refused_in_one_sentence():
    refused(r"k = 0.4 is outside \[0, 0\]", fscm.Problem, 2, 0.4, 1.0, graded=SOFT_BELOW)
    refused("is no graded solid", fscm.Problem, 2, 0.0, 1.0, graded=3.0)
    assert 0.0 < stability_of(analysis_of(GRADED).event("pull_off").value).margin < 1.0
    rough = fscm.PowerSum([1.0, -2.0, 1.05], [2, 3, 4])
    with pytest.raises(fscm.NotConverged, match="power-law modulus only"):
        Analysis(fscm.Problem(4, 0.0, 1.0, graded=SOFT_BELOW, punch=rough)).event("zero_load")
