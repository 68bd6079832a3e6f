"""Line and object on the error of the assumptions beside a printed force."""

import json
from dataclasses import replace

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.description import budget as module
from comparisons.description.budget import budget, budget_line, line_of_results
from comparisons.description.shared_errors import ASSUMPTIONS
from comparisons.problem import Problem, Section
from tests.comparisons.problems import on_solid

#: A bead of 10 um on a gel of 5 kPa, whose contact is half as wide as the bead.
GEL = """
solid = {kind = "homogeneous", E = "5 kPa", nu = 0.5}
punch = {kind = "sphere", R = "10 um"}
law = {kind = "lennard-jones-9-3", work_of_adhesion = "5 mJ/m^2", z0 = "0.4 nm"}
"""
RUBBER = on_solid("homogeneous", {"E": 1.5e6, "nu": 0.5}, R=5e-6)
LINE = "assumptions of all models"


@pytest.fixture
def gel(tmp_path):
    path = tmp_path / "gel.toml"
    path.write_text(GEL)
    return path


@pytest.fixture
def no_solver(monkeypatch):
    """Solvers that refuse to run."""

    def refuse(*_, **__):
        raise AssertionError("a solver was started")

    for name in ("fscm.solve", "fscm.profile", "fscm.trace", "fem_reference.solve", "fem_reference.solve_large_strain"):
        monkeypatch.setattr(name, refuse)


def printed(capsys, *arguments):
    assert main([*map(str, arguments)]) == 0
    return capsys.readouterr()


def test_a_force_is_printed_with_the_error_of_the_assumptions(gel, capsys, no_solver):
    command = ("solve", "--model", "jkr", "--quantity", "pull_off_force", "--problem", gel)
    (line,) = [line for line in printed(capsys, *command).out.splitlines() if LINE in line]
    content = json.loads(printed(capsys, *command, "--format", "json").out)["assumptions"]
    assert set(content) == {*ASSUMPTIONS, "total"}
    assert content["geometry"]["error"] > 0.1
    assert content["derjaguin"]["error"] < -0.1
    assert f"{100.0 * content['total']['error']:.1f}(" in line
    assert content["total"]["error"] < -0.03
    before = pd.read_csv(pd.io.common.StringIO(printed(capsys, *command, "--format", "csv").out))
    assert not [name for name in before.columns if "assum" in name]


def test_other_quantities_and_dimensionless_problems_have_no_line(gel, capsys):
    command = ("solve", "--model", "jkr", "--quantity", "pull_off_displacement", "--problem", gel)
    assert LINE not in printed(capsys, *command).out
    assert "assumptions" not in json.loads(printed(capsys, *command, "--format", "json").out)
    dimensionless = ("solve", "--model", "jkr", "--quantity", "pull_off_force", "--n", 2, "--k", 0, "--mu", 3)
    assert LINE not in printed(capsys, *dimensionless).out
    assert "assumptions" not in json.loads(printed(capsys, *dimensionless, "--format", "json").out)


def test_curve_notes_it_beside_its_points(gel, capsys):
    streams = printed(capsys, "curve", "--model", "jkr", "--problem", gel)
    assert LINE in streams.err
    assert LINE not in streams.out


def test_sweep_and_compare_state_the_largest_one(gel, capsys, tmp_path):
    varied = ("--problem", gel, "--vary", "punch.R=20, 10, 40 um")
    for command in (("sweep", "--model", "jkr"), ("compare", "bradley", "--reference", "jkr")):
        streams = printed(capsys, *command, *varied, "--out", tmp_path / command[0], "--jobs", 1)
        _, line, after = " ".join(streams.out.split()).partition(LINE)
        assert line
        assert LINE not in after
        assert "10 um" in after


def test_a_model_has_only_the_assumptions_that_it_makes():
    ball = replace(RUBBER, punch=Section("ball", {"R": 5e-6}))
    assert budget(ball, "jkr-sphere")["derjaguin"]["error"] == 0.0
    assert budget(ball, "jkr-sphere-projected")["derjaguin"]["error"] < -0.01
    large = budget(ball, "fem-large-strain")
    assert (large["derjaguin"]["error"], large["strain"]["error"]) == (0.0, 0.0)
    of_paraboloid = budget(RUBBER, "fem-large-strain")
    assert of_paraboloid["strain"]["error"] == 0.0
    assert of_paraboloid["derjaguin"]["error"] < -0.01
    assert budget(RUBBER, "of-somebody-else") is None
    assert budget(Problem.dimensionless(2, 0, 1)) is None


@pytest.mark.parametrize(("share", "is_stated"), [(0.05, True), (0.2, False)])
def test_it_is_stated_from_ten_bounds_on(share, is_stated):
    assumed = budget(RUBBER)
    total = assumed["total"]
    line = budget_line(assumed, share * (abs(total["error"]) + total["u_num"]))
    assert (line is not None) is is_stated


def test_a_contact_beyond_the_table_is_stated_and_so_is_one_of_another_shape():
    soft = replace(RUBBER, solid=Section("homogeneous", {"E": 5e4, "nu": 0.5}))
    assert "unknown" in budget_line(budget(soft), 1e-9)
    cone = replace(RUBBER, punch=Section("cone", {"half_angle": 1.2}))
    assert "error unknown, it is known for spheres, not for the punch of the kind cone" in budget_line(
        budget(cone), 1e-9
    )
    dimensionless = budget(Problem.dimensionless(1, 0, 1))
    assert budget_line(dimensionless, 1e-9) is None


def test_an_unknown_error_counts_as_the_largest(monkeypatch):
    soft = replace(RUBBER, name="soft", solid=Section("homogeneous", {"E": 5e4, "nu": 0.5}))
    rubber = replace(RUBBER, name="rubber")
    rows = [
        {"quantity": "pull_off_force", "model": "jkr", "problem": name, "value": value, "u_num": 1e-20}
        for name, value in (("soft", 1e-6), ("rubber", 1e-6), ("failed", float("nan")))
    ]
    assert "soft" in line_of_results([rubber, soft], pd.DataFrame(rows))
    assert line_of_results([], pd.DataFrame(rows)) is None
    monkeypatch.setattr(module, "budget", lambda *_: None)
    assert line_of_results([rubber, soft], pd.DataFrame(rows)) is None
