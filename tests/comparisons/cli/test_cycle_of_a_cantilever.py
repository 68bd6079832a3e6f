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


def test_the_picture_tells_approach_from_retreat(probe, tmp_path, monkeypatch):
    """By the dashes and in the legend; models by their colour."""
    drawn = []
    monkeypatch.setattr("comparisons.cli.commands.curve.save", lambda figure, path: drawn.append(figure))
    options = ["--problem", str(probe), "--stiffness", "1 N/m", "--plot", str(tmp_path / "a.png")]
    assert main(["curve", "--model", "jkr", "dmt", *options]) == 0
    (legend,) = drawn[0].legends
    assert [text.get_text() for text in legend.get_texts()] == [
        f"{model}, {branch}" for model in ("dmt", "jkr") for branch in ("approach", "retreat")
    ]
    lines = [container[0] for container in drawn[0].axes[0].containers]
    assert [line.get_linestyle() for line in lines] == ["--", "-"] * 2
    assert len({line.get_color() for line in lines[:2]}) == len({line.get_color() for line in lines[2:]}) == 1
    assert lines[0].get_color() != lines[2].get_color()


def test_a_soft_cantilever_holds_on_to_pull_off_and_misses_the_rest(capsys, probe):
    _, stiff, _ = cycle(capsys, probe, "1e6 N/m", "fscm")
    _, soft, said = cycle(capsys, probe, "0.5 N/m", "fscm")
    lowest = stiff["load [N]"].min()
    assert ends(soft, "retreat")[1] == pytest.approx(lowest, rel=1e-2)
    assert ends(soft, "approach")[1] > ends(stiff, "approach")[1]
    assert np.allclose(soft["position [m]"] - soft["displacement [m]"], soft["load [N]"] / 0.5)
    assert "fscm: snaps in" in said
    assert said.count("solving probe.toml with fscm: this may take a minute") == 1
    # The largest tension; a stiffer cantilever lets go later, at less.
    assert "pull-off force 59.8" in said


def test_a_model_of_the_contact_alone_snaps_in_where_the_surfaces_touch(capsys, probe):
    status, table, said = cycle(capsys, probe, "1 N/m", "jkr", "dmt")
    assert "a minute" not in said
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
        (["--max-load", "0 nN"], "(0, inf)"),
        (["--max-load", "2"], "unit"),
        (["--max-load", "2 nN", "--quantity", "pull_off_gap"], "--quantity"),
        (["--stiffness", "2 N/m", "--quantity", "pull_off_gap"], "--quantity"),
    ],
)
def test_what_is_no_stiffness_or_load_is_refused(capsys, probe, options, word):
    assert main(["curve", "--model", "jkr", "--problem", str(probe), *options]) == 2
    captured = capsys.readouterr()
    assert not captured.out
    assert word in captured.err


def test_a_cycle_is_drawn_over_the_position_of_the_base(capsys, probe, tmp_path):
    drawn = tmp_path / "cycle.svg"
    options = ["--stiffness", "1 N/m", "--plot", str(drawn), "--csv", str(tmp_path / "cycle.csv")]
    assert main(["curve", "--model", "jkr", "--problem", str(probe), *options]) == 0
    assert "position of the cantilever" in drawn.read_text(encoding="utf-8")
    assert list(pd.read_csv(tmp_path / "cycle.csv").columns)[1:3] == ["branch", "position [m]"]


@pytest.mark.parametrize("largest", [0.3, 9.0])
def test_a_curve_ends_at_the_load_that_is_asked_for(capsys, largest):
    """The contact radius there is that of the states at this load; a model that cannot go on says where it ends."""
    case = {"n": 2.0, "k": 0.4, "mu": 1.0}
    options = [part for name, value in case.items() for part in (f"--{name}", str(value))]
    models = ["fscm", "jkr", "dmt", "md-improved", "bradley"]
    assert main(["curve", "--model", *models, *options, "--max-load", str(largest)]) == 0
    captured = capsys.readouterr()
    last = pd.read_csv(io.StringIO(captured.out)).groupby("model").tail(1).set_index("model")
    going_on = [model for model in models if model != "bradley" or largest < 1.0]
    assert np.allclose(last.loc[going_on, "load"], largest, rtol=1e-9)
    assert ("bradley: its curve ends below --max-load" in captured.err) == (largest > 1.0)
    state = fscm.equilibria(fscm.Problem(**case), "load", largest)[-1]
    assert last.loc["fscm", "contact_radius"] == pytest.approx(state.edge_radius, rel=1e-5)
    noted = captured.err.partition("fscm: contact radius ")[2].split()[0]
    assert float(noted) == pytest.approx(state.edge_radius, rel=1e-5)
    assert last.loc["fscm", "displacement"] == pytest.approx(state.displacement, abs=1e-5)
    of_cohesive_zone = last.loc["md-improved"]
    assert of_cohesive_zone["contact_radius"] < state.edge_radius < of_cohesive_zone["cohesive_radius"]


def test_a_curve_in_newtons_ends_at_a_load_in_newtons(capsys, probe):
    assert main(["curve", "--model", "jkr", "dmt", "--problem", str(probe), "--max-load", "80 nN"]) == 0
    last = pd.read_csv(io.StringIO(capsys.readouterr().out)).groupby("model").tail(1)
    assert np.allclose(last["load [N]"], 80e-9, rtol=1e-9)


def test_a_contact_radius_is_looked_for_in_the_curve(capsys):
    case = ["--n", "2", "--k", "0", "--mu", "1"]
    assert main(["solve", "--model", "jkr", "--quantity", "contact_radius", *case]) == 2
    assert "--max-load" in capsys.readouterr().err


def test_a_cantilever_needs_a_contact_with_units(capsys):
    assert main(["curve", "--model", "jkr", "--n", "2", "--k", "0", "--mu", "1", "--stiffness", "2 N/m"]) == 2
    assert "--problem" in capsys.readouterr().err


@pytest.fixture(name="wetted")
def _wetted(tmp_path):
    """A stiff bead whose barrier takes more on approach than the tension gives."""
    gap = np.linspace(0.75, 6.0, 300)
    well = 8.0 / 3.0 * (gap**-9 - gap**-3) * np.exp(-((gap - 1.0) ** 2))
    p = well + 0.125 * gap**2 * (1.0 - (gap / 6.0) ** 2) ** 4
    rows = "\n".join(f"{x:.12g},{y:.12g}" for x, y in zip(0.4 * gap, np.append(p[:-1], 0.0), strict=True))
    (tmp_path / "law.csv").write_text(f"gap [nm],traction [MPa]\n{rows}\n", encoding="utf-8")
    path = tmp_path / "bead.toml"
    bead = 'solid = {kind = "homogeneous", E = "30 MPa", nu = 0.45}\npunch = {kind = "sphere", R = "200 nm"}\n'
    path.write_text(f'{bead}law = {{kind = "table", file = "law.csv"}}\n', encoding="utf-8")
    return path


def test_a_bead_that_a_film_pushes_away(capsys, wetted):
    """Its soft cantilever squeezes the film out at one compression, and lets it back at a smaller one."""
    problem = Problem.load(wetted)
    law = problem.posed.law
    assert law.work_of_adhesion < 0.0
    assert float(np.max(law.energy(np.linspace(0.1, 20.0, 2000)))) + law.work_of_adhesion == pytest.approx(
        1.0, rel=1e-3
    )
    largest = float(np.min(law.traction(np.linspace(0.0, 3.0, 2000))))
    assert largest == pytest.approx(-1.0, rel=1e-3)  # z0 is the depth of the well over the largest tension
    assert main(["describe", str(wetted)]) == 0
    assert "not-applicable" in capsys.readouterr().out
    status, table, said = cycle(capsys, wetted, "0.01 N/m", "fscm")
    assert status == 0
    assert "snaps in" in said
    (_, into, _), (_, out, _) = ends(table, "approach"), ends(table, "retreat")
    assert into > out > 0.0
    # The cantilever is soft: the load turns where it is largest and least. A stiff bead has Derjaguin's loads.
    energy = law.energy(np.linspace(0.0, 20.0, 2000)) * problem.units["energy_per_area"]
    assert [into, out] == pytest.approx(
        [2.0 * np.pi * 200e-9 * energy.max(), 2.0 * np.pi * 200e-9 * energy[0]], rel=0.3
    )
