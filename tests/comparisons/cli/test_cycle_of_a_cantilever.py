"""`curve --stiffness`: the cycle that a cantilever records, without a record."""

import io

import numpy as np
import pandas as pd
import pytest

import fscm
from comparisons.cli.main import main
from comparisons.problem import Problem

PROBE = """
solid = {kind = "homogeneous", E = "1 GPa", nu = 0.45}
punch = {kind = "sphere", R = "200 nm"}
law = {kind = "lennard-jones-9-3", work_of_adhesion = "60 mJ/m^2", z0 = "0.4 nm"}
"""
#: Between neighbouring points of a curve a fold is as far from the nearest one, in z0.
SPACING = 0.01


@pytest.fixture(name="probe")
def _probe(tmp_path):
    path = tmp_path / "probe.toml"
    path.write_text(PROBE, encoding="utf-8")
    return path


def cycle(capsys, probe, stiffness, *models):
    status = main(["curve", "--model", *models, "--problem", str(probe), "--stiffness", stiffness])
    captured = capsys.readouterr()
    return status, pd.read_csv(io.StringIO(captured.out)), captured.err


def ends(table, branch):
    """Positions before and after the jump of a branch: the largest step of the load at one position."""
    rows = table[table["branch"] == branch]
    position, load = rows["position [m]"].to_numpy(), rows["load [N]"].to_numpy()
    (at,) = np.flatnonzero(np.diff(position) == 0.0)
    return position[at], load[at], load[at + 1]


def test_a_stiff_cantilever_jumps_where_the_displacement_folds(capsys, probe):
    status, table, _ = cycle(capsys, probe, "1e6 N/m", "fscm")
    assert status == 0
    assert list(table.columns) == ["model", "branch", "position [m]", "displacement [m]", "load [N]"]
    problem = Problem.load(probe)
    jumps = fscm.solve_together(problem.posed, ["jump_in_displacement", "jump_out_displacement"], "quick")
    z0 = problem.units["displacement"]
    for branch, jump in zip(("approach", "retreat"), jumps.values(), strict=True):
        position, before, after = ends(table, branch)
        assert position == pytest.approx(jump.value * z0, abs=SPACING * z0)
        assert (after < before < 0.0) if branch == "approach" else (before < after < 0.0)


def test_a_soft_cantilever_holds_on_to_pull_off_and_misses_the_rest(capsys, probe):
    _, stiff, _ = cycle(capsys, probe, "1e6 N/m", "fscm")
    _, soft, said = cycle(capsys, probe, "0.5 N/m", "fscm")
    lowest = stiff["load [N]"].min()
    assert ends(soft, "retreat")[1] == pytest.approx(lowest, rel=1e-2)
    assert ends(soft, "approach")[1] > ends(stiff, "approach")[1]
    assert np.allclose(soft["position [m]"] - soft["displacement [m]"], soft["load [N]"] / 0.5)
    assert "fscm: snaps in at" in said


def test_a_model_of_the_contact_alone_snaps_in_where_the_surfaces_touch(capsys, probe):
    status, table, _ = cycle(capsys, probe, "1 N/m", "jkr", "dmt")
    assert status == 0
    for _, rows in table.groupby("model"):
        position, before, after = ends(rows, "approach")
        assert (position, before) == (0.0, 0.0)
        assert after < 0.0
    of_dmt = ends(table[table["model"] == "dmt"], "retreat")
    assert of_dmt[1] == pytest.approx(-2.0 * np.pi * 0.06 * 200e-9, rel=1e-6)


def test_the_contact_radius_has_one_name(capsys):
    assert main(["curve", "--model", "fscm", "jkr", "dmt", "--n", "2", "--k", "0", "--mu", "1"]) == 0
    table = pd.read_csv(io.StringIO(capsys.readouterr().out))
    for _, rows in table.groupby("model"):
        assert rows["contact_radius"].max() > 2.0
    of_fscm = table[table["model"] == "fscm"]
    assert of_fscm["contact_radius"].equals(of_fscm["edge_radius"])


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (["--stiffness", "2"], "unit"),
        (["--stiffness", "-2 N/m"], "above 0"),
        (["--stiffness", "2 m"], "2 m"),
        (["--stiffness", "2 N/m", "--plot", "cycle.png"], "--plot"),
        (["--stiffness", "2 N/m", "--quantity", "pull_off_gap"], "--quantity"),
    ],
)
def test_what_is_no_stiffness_is_refused(capsys, probe, options, word):
    assert main(["curve", "--model", "jkr", "--problem", str(probe), *options]) == 2
    captured = capsys.readouterr()
    assert not captured.out
    assert word in captured.err


def test_a_cantilever_needs_a_contact_with_units(capsys):
    assert main(["curve", "--model", "jkr", "--n", "2", "--k", "0", "--mu", "1", "--stiffness", "2 N/m"]) == 2
    assert "--problem" in capsys.readouterr().err
