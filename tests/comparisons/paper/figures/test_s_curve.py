"""Fig. 3: named points on the curve, and the lost energy as the area between them."""

import numpy as np
import pytest

from comparisons.paper.figures import fig03_s_curve as s_curve
from comparisons.registry import create
from fscm.problem import Problem


@pytest.fixture(scope="module")
def tables(tables_of):
    return tables_of(s_curve.S_CURVE)


@pytest.fixture(scope="module")
def points(tables):
    return tables["points"].set_index("name")


@pytest.mark.heavy
def test_the_path_meets_the_points_in_order(tables, points):
    assert list(points.index) == ["B'", "A", "B", "A'", "C", "D"]
    assert points["central_gap"].is_monotonic_decreasing
    fscm = tables["curves"][tables["curves"]["model"] == "fscm"]
    for name, point in points.iterrows():
        # Between neighbouring points of the curve the load is interpolated; the folds are points of it.
        near = (fscm["central_gap"] - point["central_gap"]).abs().argsort()[:2]
        low, high = fscm["load"].iloc[near].min(), fscm["load"].iloc[near].max()
        assert low - 1e-3 < point["load"] < high + 1e-3, name


def test_jumps_are_vertical(points):
    for start, end in (("A", "A'"), ("B", "B'")):
        u = points.loc[start, "u_displacement"] + points.loc[end, "u_displacement"]
        assert points.loc[start, "displacement"] == pytest.approx(points.loc[end, "displacement"], abs=u)


def test_points_are_events_of_the_model(points):
    model, problem = create("fscm"), Problem(2, 0.4, 3)
    force = model.evaluate(problem, "pull_off_force")
    assert -points.loc["C", "load"] == pytest.approx(force.value, abs=force.u_num)
    assert points.loc["D", "load"] == pytest.approx(0, abs=points.loc["D", "u_load"])
    # Sec. 3.1: JKR predicts the jump-out well; Fig. 9a shows it within its line.
    jkr = create("jkr").evaluate(problem, "jump_out_displacement").value
    assert points.loc["B", "displacement"] == pytest.approx(jkr, rel=0.01)


def test_every_coordinate_has_an_uncertainty(points):
    for name in ("central_gap", "displacement", "load"):
        assert (points[f"u_{name}"] > 0).all()
        assert (points[f"u_{name}"] < 1e-8).all()


def test_the_area_of_the_loop_is_the_energy_lost(tables, points):
    fscm = tables["curves"][tables["curves"]["model"] == "fscm"]
    x, y = s_curve._loop(fscm, points)
    area = abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
    # The energy is the sum of two drops at constant displacement; the area is a sum over chords of the curve.
    energy = tables["hysteresis"].iloc[0]
    assert area == pytest.approx(energy["value"], rel=1e-3)
    assert energy["u_num"] < 1e-8
