"""What a model answers reaches the figures unchanged, and a refusal says why."""

import json

import numpy as np
import pytest

from comparisons.paper import tasks as answers
from comparisons.registry import create
from fscm.problem import Problem


def test_a_quantity_is_what_the_model_says():
    said = answers.quantity("jkr", "pull_off_force", 2, 0.0, 1.0)
    # Closed form: 3/2 for a paraboloid on a homogeneous solid.
    assert said["value"] == pytest.approx(1.5, rel=1e-14)
    assert 0 < said["u_num"] < 1e-13
    assert (said["status"], said["reason"]) == ("ok", "")


@pytest.mark.parametrize(
    ("said", "status", "reason"),
    [
        (answers.quantity("bradley", "jump_in_gap", 2, 0.4, 1), "not-applicable", "rigid pair"),
        (answers.quantity("fscm", "pull_off_force", 0.5, 0.4, 1), "failed", "diverges"),
        (answers.curve("dmt", 0.4, 0.1, 1), "failed", "shape index"),
        (answers.profile("bradley", 2, 0.4, 1), "not-applicable", "no profile"),
        (answers.profile("fscm", 2, 0.4, -1), "failed", "Tabor number"),
    ],
)
def test_a_refusal_is_an_answer(said, status, reason):
    assert said["status"] == status
    assert reason in said["reason"]
    assert said.get("value") is None


def test_a_curve_holds_the_pull_off_force():
    said = answers.curve("fscm", 2, 0.4, 0.5)
    direct = answers.quantity("fscm", "pull_off_force", 2, 0.4, 0.5)["value"]
    assert -min(said["load"]) == pytest.approx(direct, abs=said["u_load"] + 1e-9)
    # The bounds are the fraction of the picture times its size.
    ratio = np.ptp(said["load"]) / np.ptp(said["displacement"])
    assert said["u_load"] / said["u_displacement"] == pytest.approx(ratio)
    # The edge is not defined before contact.
    assert said["columns"]["edge_radius"][0] is None
    assert said["columns"]["edge_radius"][-1] > 0
    json.dumps(said, allow_nan=False)


def test_a_profile_carries_the_pull_off_force():
    said = answers.profile("fscm", 2, 0.4, 0.5)
    assert max(said["gap"]) <= 10
    whole = create("fscm").pull_off_profile(Problem(2, 0.4, 0.5))
    assert said["pressure"] == whole.pressure[: len(said["pressure"])].tolist()
    # P is the integral of p d(r^2) (Eq. 31); beyond a gap of 10 the tail of -(8/3) H^-3 holds 0.01 of it.
    load = np.trapezoid(said["pressure"], np.square(said["radius"]))
    force = answers.quantity("fscm", "pull_off_force", 2, 0.4, 0.5)["value"]
    assert -load == pytest.approx(force, abs=0.03)
    json.dumps(said, allow_nan=False)
