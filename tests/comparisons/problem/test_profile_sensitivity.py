"""Sensitivity of the pull-off force to smoothing and continuation of a measured profile."""

import json

import numpy as np
import pytest

from comparisons.cli.main import main
from comparisons.description import profile_sensitivity as module
from comparisons.description.text import profile_lines
from comparisons.problem.reading import load_problem
from comparisons.runs.tasks import evaluate
from tests.comparisons.rows import row

TEXT = """
[solid]
kind = "power-law"
E0 = "2 GPa"
c0 = "100 nm"
k = 0
nu = 0.3
[punch]
kind = "table"
file = "profile.csv"
{keys}
[law]
kind = "lennard-jones-9-3"
work_of_adhesion = "50 mJ/m^2"
z0 = "0.4 nm"
"""


@pytest.fixture
def written(tmp_path):
    """A function that writes a file with keys of the punch and the heights of a noisy sphere of 100 nm."""
    r = np.arange(0.0, 41.0, 2.0)
    height = r**2 / 200.0 + np.random.default_rng(5).normal(0.0, 0.05, len(r))
    rows = "\n".join(f"{a},{b:.6f}" for a, b in zip(r, height - height[0], strict=True))
    (tmp_path / "profile.csv").write_text(f"r [nm],height [nm]\n{rows}\n")

    def write(keys):
        (tmp_path / "mine.toml").write_text(TEXT.format(keys=keys))
        return load_problem(tmp_path / "mine.toml")

    return write


def force(problem):
    return evaluate("fscm", "pull_off_force", problem)


@pytest.mark.heavy
def test_the_changes_are_those_of_other_files(written, capsys):
    path = written('smoothing = "0.05 nm"').path
    assert main(["describe", str(path), "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    changes = content["profile_sensitivity"]
    assert [(change["key"], change["value"]) for change in changes] == [
        ("smoothing", pytest.approx(2.5e-11)),
        ("smoothing", pytest.approx(1e-10)),
        ("growth", 1.5),
        ("growth", 3.0),
    ]
    changed_keys = ['smoothing = "0.025 nm"', 'smoothing = "0.05 nm"\ngrowth = 3']
    for keys, change in zip(changed_keys, (changes[0], changes[3]), strict=True):
        with_keys = force(written(keys))
        expected = with_keys.value / content["pull_off_force"]["value"] - 1.0
        assert abs(change["change"] - expected) <= change["u_num"] + 1e-12
    # More attraction far away with a profile that is lower there.
    assert changes[2]["change"] > 0.0 > changes[3]["change"]


def counted(problem, monkeypatch, failing=None):
    """The changes without a computation; the value that fails is refused."""

    def solved(task):
        if failing in task.problem.punch.values.values():
            return row("fscm", value=None, u_num=None, status="failed", reason="not admissible")
        return row("fscm", value=2.0, u_num=0.0)

    monkeypatch.setattr(module, "evaluate_task", solved)
    return module.profile_sensitivity(problem, row("fscm", value=1.0, u_num=0.0))


def test_a_failure_is_stated(written, monkeypatch):
    content = counted(written('smoothing = "0.05 nm"'), monkeypatch, failing=3.0)
    assert [change["status"] for change in content] == ["ok", "ok", "ok", "failed"]
    assert profile_lines(content)[-1] == "    growth 3: failed: not admissible"
    assert content[-1]["change"] is None
