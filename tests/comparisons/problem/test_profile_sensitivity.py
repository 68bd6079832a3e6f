"""Sensitivity of the pull-off force to smoothing and continuation of a measured profile."""

import numpy as np
import pytest

from comparisons.description import forces as module
from comparisons.problem.reading import load_problem
from comparisons.runs.tasks import evaluate
from tests.comparisons.rows import row

TEXT = """
solid = { kind = "homogeneous", E = "2 GPa", nu = 0.3 }
law = { kind = "lennard-jones-9-3", work_of_adhesion = "50 mJ/m^2", z0 = "0.4 nm" }
"""


@pytest.fixture
def written(tmp_path):
    """A function that writes a file with keys of the punch and the heights of a noisy sphere of 100 nm."""
    r = np.arange(0.0, 41.0, 2.0)
    height = r**2 / 200.0 + np.random.default_rng(5).normal(0.0, 0.05, len(r))
    rows = np.transpose([r, height - height[0]])
    np.savetxt(tmp_path / "profile.csv", rows, "%.6f", ",", header="r [nm],height [nm]", comments="")

    def write(keys):
        (tmp_path / "mine.toml").write_text(f'{TEXT}punch = {{ kind = "table", file = "profile.csv", {keys} }}')
        return load_problem(tmp_path / "mine.toml")

    return write


@pytest.mark.heavy
def test_the_changes_are_those_of_other_files(written):
    force = evaluate("fscm", "pull_off_force", written('smoothing = "0.05 nm"'))
    changes = module.profile_sensitivity(written('smoothing = "0.05 nm"'), force)
    stated = [(change["key"], pytest.approx(change["value"])) for change in changes]
    assert stated == [("smoothing", 2.5e-11), ("smoothing", 1e-10), ("growth", 1.5), ("growth", 3.0)]
    changed_keys = ['smoothing = "0.025 nm"', 'smoothing = "0.05 nm", growth = 3']
    for keys, change in zip(changed_keys, (changes[0], changes[3]), strict=True):
        expected = evaluate("fscm", "pull_off_force", written(keys)).value / force.value - 1.0
        assert abs(change["change"] - expected) <= change["u_num"] + 1e-12
    # More attraction far away with a profile that is lower there.
    assert changes[2]["change"] > 0.0 > changes[3]["change"]


def test_a_failure_is_stated(written, monkeypatch):
    def solved(task):
        if task.problem.punch.get("growth") == 3.0:
            return row("fscm", value=None, u_num=None, status="failed", reason="not admissible")
        return row("fscm", value=2.0, u_num=0.0)

    monkeypatch.setattr(module, "evaluate_task", solved)
    content = module.profile_sensitivity(written('smoothing = "0.05 nm"'), row("fscm", value=1.0, u_num=0.0))
    assert [(change["status"], change["change"]) for change in content] == [("ok", 1.0)] * 3 + [("failed", None)]
