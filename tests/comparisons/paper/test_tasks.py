"""Tasks of the figures: results of models unchanged, and the reason of a refusal."""

import json

import numpy as np
import pytest

from comparisons.paper.tasks import curve, profile, quantity
from comparisons.registry import create
from fscm.problem import Problem


def test_a_quantity_is_that_of_the_model():
    found = quantity("jkr", "pull_off_force", 2, 0.0, 1.0)
    # Closed form: 3/2 for a paraboloid on a homogeneous solid.
    assert found["value"] == pytest.approx(1.5, rel=1e-14)
    assert 0 < found["u_num"] < 1e-13
    assert (found["status"], found["reason"]) == ("ok", "")


@pytest.mark.parametrize(
    ("found", "status", "reason"),
    [
        (quantity("bradley", "jump_in_gap", 2, 0.4, 1), "not-applicable", "rigid pair"),
        (quantity("fscm", "pull_off_force", 0.5, 0.4, 1), "failed", "diverges"),
        (curve("dmt", 0.4, 0.1, 1), "failed", "shape index"),
        (profile("bradley", 2, 0.4, 1), "not-applicable", "no profile"),
        (profile("fscm", 2, 0.4, -1), "failed", "Tabor number"),
    ],
)
def test_a_refusal_is_a_result(found, status, reason):
    assert found["status"] == status
    assert reason in found["reason"]
    assert found.get("value") is None


def test_a_curve_holds_the_pull_off_force():
    found = curve("fscm", 2, 0.4, 0.5)
    direct = quantity("fscm", "pull_off_force", 2, 0.4, 0.5)["value"]
    assert -min(found["load"]) == pytest.approx(direct, abs=found["u_load"] + 1e-9)
    # The bounds are the fraction of the picture times its size.
    ratio = np.ptp(found["load"]) / np.ptp(found["displacement"])
    assert found["u_load"] / found["u_displacement"] == pytest.approx(ratio)
    # The edge is not defined before contact.
    assert found["columns"]["edge_radius"][0] is None
    assert found["columns"]["edge_radius"][-1] > 0
    json.dumps(found, allow_nan=False)


def test_a_profile_carries_the_pull_off_force():
    found = profile("fscm", 2, 0.4, 0.5)
    assert max(found["gap"]) <= 10
    whole = create("fscm").pull_off_profile(Problem(2, 0.4, 0.5))
    assert found["pressure"] == whole.pressure[: len(found["pressure"])].tolist()
    # P is the integral of p d(r^2) (Eq. 31); beyond a gap of 10 the tail of -(8/3) H^-3 holds 0.01 of it.
    load = np.trapezoid(found["pressure"], np.square(found["radius"]))
    force = quantity("fscm", "pull_off_force", 2, 0.4, 0.5)["value"]
    assert -load == pytest.approx(force, abs=0.03)
    json.dumps(found, allow_nan=False)
