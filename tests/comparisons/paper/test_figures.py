"""Figures of the paper: the data beside each picture against closed forms, limits, identities and the models."""

import math
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest

from comparisons.model import NotApplicable
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.figures import force_curves, pull_off_forces, studies
from comparisons.paper.figures.force_curves import fig03_s_curve, loop
from comparisons.paper.figures.surfaces import fig17_surface_models
from comparisons.paper.registry import paper_figures
from comparisons.paper.tasks import jumps, profile, quantity, surface
from comparisons.problem import Problem
from comparisons.registry import create
from tests.paths import ROOT

STRESSES = {"md-original": THEORETICAL_STRENGTH, "md-improved": eta(2.0)}


def of_model(model, name, *case):
    return create(model).evaluate(Problem.dimensionless(*case), name)


def test_a_refusal_is_a_result():
    force, shape = quantity("fscm", "pull_off_force", 0.5, 0.4, 1), profile("fscm", 2, 0.4, -1)
    assert (force["status"], shape["status"]) == ("failed", "failed")
    assert "diverges" in force["reason"]
    assert "Tabor number" in shape["reason"]


def test_the_named_points_are_events_and_their_loop_has_the_area_of_the_energy_lost(made_of):
    tables = made_of(fig03_s_curve)
    points = tables["points"].set_index("name")
    assert points["central_gap"].is_monotonic_decreasing
    assert points.filter(like="u_").stack().between(0, 1e-8, inclusive="neither").all()
    for start, end in (("A", "A'"), ("B", "B'")):
        u = points.loc[[start, end], "u_displacement"].sum()
        assert points.loc[start, "displacement"] == pytest.approx(points.loc[end, "displacement"], abs=u)
    force = of_model("fscm", "pull_off_force", 2, 0.4, 3)
    assert -points.loc["C", "load"] == pytest.approx(force.value, abs=force.u_num)
    assert points.loc["D", "load"] == pytest.approx(0, abs=points.loc["D", "u_load"])
    curves = tables["curves"]
    x, y = loop(curves[curves["model"] == "fscm"], points)
    area = abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
    # The energy is the sum of two drops at constant displacement; the area is a sum over chords of the curve.
    assert area == pytest.approx(tables["hysteresis"]["value"].item(), rel=1e-3)


def test_no_letter_of_a_named_point_is_on_a_curve_and_no_scale_has_a_kink():
    folder = ROOT / PAPER_BASELINE
    tables = {name: pd.read_csv(folder / f"fig03_s_curve_{name}.csv") for name in ("curves", "points", "hysteresis")}
    (paper_figure,) = [figure for figure in paper_figures() if figure.stem == "fig03_s_curve"]
    figure = paper_figure.draw(tables)
    figure.draw_without_rendering()
    for axes in figure.axes:
        curves = [axes.transData.transform(line.get_xydata()) for line in axes.lines if len(line.get_xydata()) > 10]
        for letter in axes.texts:
            box = letter.get_window_extent()
            inside = [points for points in curves if np.any(np.all((points > box.min) & (points < box.max), axis=1))]
            assert (letter.get_text(), inside) == (letter.get_text(), [])
        labels = [label.get_window_extent() for label in axes.get_xticklabels() if label.get_text()]
        assert not any(left.overlaps(right) for left, right in pairwise(labels))
        # A kink of the scale would be read as one of the curve.
        x = np.linspace(*axes.get_xlim(), 20_000)
        slope = np.diff(axes.transScale.transform(np.column_stack([x, x]))[:, 0])
        assert np.abs(np.diff(slope) / slope[:-1]).max() < 0.1
    (legend,) = figure.legends
    assert [type(handle).__name__ for handle in legend.legend_handles] == ["Line2D", "Line2D", "Rectangle"]


def test_a_curve_has_its_load_and_a_refused_one_is_named(made_of):
    keys = [{"n": 2.0, "k": 1.0, "mu": 0.5}, {"n": 0.6, "k": 0.4, "mu": 1.0}]
    table = made_of(lambda: force_curves.curves(keys))[""]
    assert list(table.loc[table["n"] == 0.6, "status"]) == ["failed"]
    assert table.loc[table["n"] == 0.6, "load"].isna().all()
    traced = table[table["status"] == "ok"]
    # The pull-off force is 2 in the Gibson limit of a paraboloid.
    assert traced["load"].min() == pytest.approx(-2, rel=1e-4)


@pytest.mark.parametrize(("n", "k", "mu"), [(2, 0.4, 0.1), (2, 0.4, 1.0), (2, 1.0, 1.0), (1, 1.0, 0.5)])
def test_the_surface_is_in_equilibrium(n, k, mu):
    shape = {name: np.array(values) for name, values in surface(n, k, mu).items()}
    # Eq. 4 between the nodes too, where gap and deformation are interpolated each by itself, and Eq. 27.
    residual = shape["gap"] - (shape["radius"] ** n / n - shape["displacement"] + shape["deformation"])
    assert np.abs(residual).max() < 1e-6
    q = 1 / (shape["gap"] + 1)
    assert shape["pressure"] == pytest.approx(8 / 3 * (q**9 - q**3), abs=1e-12)
    for name in ("gap", "pressure", "deformation"):
        assert 0 < shape[f"u_{name}"].min() <= shape[f"u_{name}"].max() < 1e-5


def test_jumps_are_the_quantities_of_the_model_and_there_is_none_below_the_critical_tabor_number():
    both = jumps(2.0, 0.0, 1.5)
    for name in ("jump_in_displacement", "jump_out_gap"):
        result = of_model("fscm", name, 2, 0, 1.5)
        assert both[name] == pytest.approx(result.value, abs=result.u_num + both[f"u_{name}"])
    with pytest.raises(NotApplicable, match="monotonically"):
        jumps(2.0, 0.4, 0.7)


def test_pull_off_forces_tend_to_both_limits_and_kappa_is_that_of_every_scale(made_of, monkeypatch):
    monkeypatch.setattr(pull_off_forces, "_SHAPES", (1.0, 2.0))
    by_limit = {}
    for limit, mu in (("bradley", 0.01), ("jkr", 10.0)):
        monkeypatch.setattr(pull_off_forces, "TABOR_NUMBERS", (mu,))
        by_limit[limit] = made_of(lambda limit=limit: pull_off_forces.by_limit(limit))
    rigid, soft = by_limit["bradley"], by_limit["jkr"]
    force, limit = (of_model(model, "pull_off_force", 1.0, 0.4, 10.0) for model in ("fscm", "jkr"))
    row = soft[""].query("model == 'fscm' and n == 1 and mu == 10").iloc[0]
    assert row["ratio"] == pytest.approx(force.value / limit.value)
    u_ratio = (force.u_num + row["ratio"] * limit.u_num) / limit.value
    assert row["u_ratio"] == pytest.approx(u_ratio, rel=1e-9, abs=0.0)
    ratios = rigid[""].set_index(["model", "n", "mu"])["ratio"]
    assert ratios["md-improved", :, 0.01].to_numpy() == pytest.approx(1.0, abs=0.02)
    # The model that ignores the rigid limit is off there, for the cone by two thirds.
    assert ratios["md-original", 1.0, 0.01] == pytest.approx(1.0 - 0.65, abs=0.01)
    assert soft[""]["ratio"].to_numpy() == pytest.approx(1.0, abs=6e-3)
    kappa = soft["kappa"].pivot(index=["n", "mu"], columns="model", values="kappa")
    ratio = soft[""].pivot(index=["n", "mu"], columns="model", values="ratio")
    for model in STRESSES:
        np.testing.assert_allclose(ratio[model] / ratio["fscm"] - 1.0, kappa[model], atol=1e-12)


def test_surfaces_touch_inside_a_and_part_by_the_work_of_adhesion_at_c(made_of):
    tables = made_of(fig17_surface_models)
    table, radii = tables[""], tables["radii"].set_index("model")
    for model, stress in STRESSES.items():
        surface_rows = table[table["model"] == model]
        a, c = radii.loc[model]
        assert (surface_rows["height"] == surface_rows["punch"])[surface_rows["radius"] < a].all()
        assert stress * np.interp(c, surface_rows["radius"], surface_rows["gap"]) == pytest.approx(1.0, abs=1e-6)


def test_geometry_and_strain_cancel_where_their_parts_are_equal():
    """kappa = 2 x^2 - 0.1 x of the root x vanishes at 0.05; the bound 1e-3 x moves it by 5e-4."""
    x = np.linspace(0.01, 0.2, 8)
    line = pd.DataFrame({"elasto_adhesion_number": x**3, "kappa": 2 * x**2 - 0.1 * x, "u_kappa": 1e-3 * x})
    with_error = line.assign(nu=0.3, kappa=line["kappa"] + 0.2 * x)
    table = pd.concat([line.assign(nu=0.5), with_error]).assign(model="fscm", mu=1.0)
    never, once = studies.meeting_points(table).itertuples()
    roots = np.cbrt([once.elasto_adhesion_number, once.lowest, once.highest])
    assert roots == pytest.approx([0.05, 0.0495, 0.0505])
    assert math.isnan(never.elasto_adhesion_number)


def test_jkr_finds_the_values_of_soft_spheres(monkeypatch):
    monkeypatch.setattr(studies, "_POINTS", 100)
    assert list(studies.fitted_by_jkr(0.0, 1.0, 10.0).values()) == pytest.approx([1.00632, 0.99938], abs=1e-4)
