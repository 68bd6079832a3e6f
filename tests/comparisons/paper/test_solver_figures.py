"""Figs. 2 to 10: kernel functions, curves, jumps and surfaces of the FSCM against closed forms and identities."""

import math

import numpy as np
import pytest

from comparisons.model import NotApplicable
from comparisons.paper.figures import fig03_s_curve as s_curve
from comparisons.paper.figures import fig04_06_force_curves as force_curves
from comparisons.paper.figures import fig10_transition as transition
from comparisons.paper.figures.fig02_kernel_functions import _RATIOS, values
from comparisons.paper.figures.fig05_07_pull_off_surfaces import surface
from comparisons.paper.figures.fig08_jumps import jumps, near_critical
from comparisons.paper.figures.fig09_jump_asymptotes import asymptotes, coefficients
from comparisons.problem import Problem
from comparisons.registry import create

STRENGTH = 16 * math.sqrt(3) / 27


def functions(k):
    return {name: np.array(column, float) for name, column in values(k).items()}


@pytest.mark.parametrize("k", [0.0, 0.4, 1.0])
def test_psi_is_phi_less_the_power_and_the_slope_is_the_derivative(k):
    found, positive = functions(k), _RATIOS > 0
    assert found["psi"][positive] == pytest.approx((found["phi"] - _RATIOS ** (1 - k))[positive], abs=1e-13)
    even = np.flatnonzero(np.isclose(_RATIOS, np.round(_RATIOS / 0.02) * 0.02, atol=1e-9))
    s = _RATIOS[even]
    away = (np.abs(s - 1) > 0.3) & (s > 0.1) & (s < 2.9)
    numerical = np.gradient(found["phi"][even], s)
    assert found["slope"][even][away] == pytest.approx(numerical[away], rel=5e-3)
    assert np.isnan(found["slope"][_RATIOS == 1]).all()


def test_the_gibson_limit_of_the_functions_is_the_limit():
    near, limit = functions(0.99), functions(1.0)
    away = (np.abs(_RATIOS - 1) > 0.05) & (_RATIOS > 0.01)
    # With 1-k = 0.01: s^(1-k) is off by (1-k) log s, the slope by (1-k) / 2 over the distance of the step.
    for name, tolerance in (("phi", 0.012), ("psi", 0.047), ("slope", 0.12)):
        assert np.abs(near[name] - limit[name])[away].max() < tolerance
    for name in ("phi", "psi"):
        assert near[name][_RATIOS == 1] == pytest.approx(limit[name][_RATIOS == 1], abs=1e-3)


@pytest.fixture(scope="module")
def s_tables(tables_of):
    return tables_of(s_curve.S_CURVE)


def test_the_named_points_are_events_joined_by_vertical_jumps(s_tables):
    points = s_tables["points"].set_index("name")
    assert list(points.index) == ["B'", "A", "B", "A'", "C", "D"]
    assert points["central_gap"].is_monotonic_decreasing
    for name in s_curve._COORDINATES:
        assert points[f"u_{name}"].between(0, 1e-8, inclusive="neither").all()
    for start, end in (("A", "A'"), ("B", "B'")):
        u = points.loc[start, "u_displacement"] + points.loc[end, "u_displacement"]
        assert points.loc[start, "displacement"] == pytest.approx(points.loc[end, "displacement"], abs=u)
    force = create("fscm").evaluate(Problem.dimensionless(2, 0.4, 3), "pull_off_force")
    assert -points.loc["C", "load"] == pytest.approx(force.value, abs=force.u_num)
    assert points.loc["D", "load"] == pytest.approx(0, abs=points.loc["D", "u_load"])
    # Sec. 3.1: JKR predicts the jump-out well; Fig. 9a shows it within its line.
    jkr = create("jkr").evaluate(Problem.dimensionless(2, 0.4, 3), "jump_out_displacement").value
    assert points.loc["B", "displacement"] == pytest.approx(jkr, rel=0.01)


def test_the_area_of_the_loop_is_the_energy_lost(s_tables):
    curves = s_tables["curves"]
    x, y = s_curve._loop(curves[curves["model"] == "fscm"], s_tables["points"].set_index("name"))
    area = abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
    # The energy is the sum of two drops at constant displacement; the area is a sum over chords of the curve.
    energy = s_tables["hysteresis"].iloc[0]
    assert area == pytest.approx(energy["value"], rel=1e-3)
    assert energy["u_num"] < 1e-8


def test_curves_fold_above_the_critical_tabor_number_and_a_refused_one_is_named(made_of):
    cases = [(2.0, 0.4, 0.3), (2.0, 0.4, 1.0), (2.0, 1.0, 0.5), (0.6, 0.4, 1.0)]
    table = made_of(lambda: force_curves.curves(cases))[""]
    assert list(table.loc[table["n"] == 0.6, "status"]) == ["failed"]
    assert table.loc[table["n"] == 0.6, "load"].isna().all()
    known = table[table["status"] == "ok"]
    assert ((known[["u_displacement", "u_load"]] > 0) & (known[["u_displacement", "u_load"]] < 1e-5)).all(axis=None)
    rigid, soft = (known[(known["k"] == 0.4) & (known["mu"] == mu)] for mu in (0.3, 1.0))
    # The critical Tabor number is 0.78.
    assert (np.diff(rigid["displacement"]) > 0).all()
    assert (np.diff(soft["displacement"]) < 0).any()
    # Sec. 3.2.1 and 3.2.2: the pull-off force falls with mu, and is 2 in the Gibson limit of a paraboloid.
    assert rigid["load"].min() < soft["load"].min()
    assert known[known["k"] == 1.0]["load"].min() == pytest.approx(-2, rel=1e-4)


def surfaces(n, k, mu):
    found = surface(n, k, mu)
    delta = found.pop("displacement")
    return delta, {name: np.array(values) for name, values in found.items()}


@pytest.mark.parametrize(("n", "k", "mu"), [(2, 0.4, 0.1), (2, 0.4, 1.0), (2, 1.0, 1.0), (1, 1.0, 0.5)])
def test_the_surface_is_in_equilibrium(n, k, mu):
    delta, found = surfaces(n, k, mu)
    # Eq. 4 between the nodes too, where gap and deformation are interpolated each by itself, and Eq. 27.
    residual = found["gap"] - (found["radius"] ** n / n - delta + found["deformation"])
    assert np.abs(residual).max() < 1e-6
    q = 1 / (found["gap"] + 1)
    assert found["pressure"] == pytest.approx(8 / 3 * (q**9 - q**3), abs=1e-12)
    for name in ("gap", "pressure", "deformation"):
        assert found[f"u_{name}"].min() > 0
        assert found[f"u_{name}"].max() < 1e-5


def test_the_pressure_carries_the_pull_off_force_and_the_strength_is_reached():
    delta, found = surfaces(2, 0.4, 1.0)
    # p = -(8/3) (f + 1)^-3 beyond r = 6, where f is 18.
    load = np.trapezoid(found["pressure"], found["radius"] ** 2) - 8 / 3 / (18 + 1 - delta) ** 2
    force = create("fscm").evaluate(Problem.dimensionless(2, 0.4, 1.0), "pull_off_force").value
    assert -load == pytest.approx(force, abs=2e-3)
    assert found["pressure"].min() == pytest.approx(-STRENGTH, abs=1e-6)


@pytest.fixture(scope="module")
def critical():
    return near_critical(2.0, 0.4)


def test_the_branches_part_as_at_a_cusp(critical):
    assert round(critical["mu"], 2) == 0.78
    for row in critical["jumps"]:
        u = row["u_jump_in_displacement"] + row["u_jump_out_displacement"]
        assert row["jump_in_displacement"] - row["jump_out_displacement"] > 10 * u
    first, later = critical["jumps"][0], critical["jumps"][3]
    assert first["mu"] / critical["mu"] - 1 == pytest.approx(1e-4, rel=1e-6)
    ratio = (later["mu"] - critical["mu"]) / (first["mu"] - critical["mu"])
    # Two roots of a square part like its root, and their values like the power 3/2.
    for kind, power, tolerance in (("gap", 0.5, 0.02), ("displacement", 1.5, 0.05)):
        near, far = (row[f"jump_in_{kind}"] - row[f"jump_out_{kind}"] for row in (first, later))
        assert far / near == pytest.approx(ratio**power, rel=tolerance)


def test_jumps_are_the_quantities_of_the_model_and_there_is_none_below_the_critical_tabor_number():
    found, model = jumps(2.0, 0.0, 1.5), create("fscm")
    for name in ("jump_in_displacement", "jump_out_gap"):
        result = model.evaluate(Problem.dimensionless(2, 0, 1.5), name)
        assert found[name] == pytest.approx(result.value, abs=result.u_num + found[f"u_{name}"])
    with pytest.raises(NotApplicable, match="monotonically"):
        jumps(2.0, 0.4, 0.7)


def test_coefficients_of_the_asymptotes():
    tables = {n: coefficients(n) for n in (1.0, 2.0, 5.0)}
    for rows in tables.values():
        assert [row["k"] for row in rows] == pytest.approx([i / 100 for i in range(101)])
        # Sec. 3.3: 8/3 and 2 as k -> 1, whatever n.
        assert (rows[-1]["C_in"], rows[-1]["C_out"]) == (pytest.approx(8 / 3), pytest.approx(2))
    # Eq. 49, and JKR's (3/4) (pi^2)^(1/3) of a sphere in our units.
    assert tables[2.0][0]["C_in"] == pytest.approx(1.4 * (5 * math.pi / math.sqrt(2)) ** (2 / 7), rel=1e-13)
    assert tables[2.0][0]["C_out"] == pytest.approx(0.75 * math.pi ** (2 / 3), rel=1e-13)


def test_the_asymptotes_beside_the_model():
    closed = {round(row["mu"], 9): row for row in asymptotes(2.0, 0.4)}
    found, row = jumps(2.0, 0.4, 5.0), closed[5.0]
    # Measured at mu = 5: Eq. 54 is off by 0.25 %, Eq. 47 by 6 %.
    assert row["jump_out_displacement"] == pytest.approx(found["jump_out_displacement"], rel=3e-3)
    assert 1.04 < row["jump_in_displacement"] / found["jump_in_displacement"] < 1.08
    # Eq. 46 gives no jump-in at a small Tabor number.
    assert closed[0.05]["jump_in_displacement"] is None
    assert closed[0.05]["jump_out_displacement"] < 0


@pytest.mark.heavy
def test_both_limits_of_the_transition(tables_of, monkeypatch):
    monkeypatch.setattr(transition, "_SHAPES", (2.0, 5.0))
    monkeypatch.setattr(transition, "_GRADIENTS", (0.4, 1.0))
    monkeypatch.setattr(transition, "_TABOR_NUMBERS", (0.01, 1.0, 10.0))
    table = tables_of(transition.TRANSITION)[""]
    force = table.set_index(["model", "n", "k", "mu"])["value"]
    for n, rigid in ((2.0, 2.0), (5.0, 1.669)):
        # Printed in the paper (Eq. 56).
        assert round(force["bradley", n, 0.0, 0.01], 3) == rigid
        assert force["fscm", n, 0.4, 0.01] == pytest.approx(rigid, rel=2e-3)
        # Within 1 % of JKR at mu = 10, and not yet at 1.
        jkr = [force["jkr", n, 0.4, 10.0] * (10.0 / mu) ** (1 - 2 / n) for mu in (1.0, 10.0)]
        assert force["fscm", n, 0.4, 10.0] == pytest.approx(jkr[1], rel=0.01)
        assert force["fscm", n, 0.4, 1.0] != pytest.approx(jkr[0], rel=0.03)
    # A paraboloid on the Gibson solid has 2 at every Tabor number.
    assert [force["fscm", 2.0, 1.0, mu] for mu in (0.01, 1.0, 10.0)] == pytest.approx([2, 2, 2], rel=1e-11)
