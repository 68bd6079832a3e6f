"""Figures: their data, and the same file from the same data."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from comparisons.output.figures.of_run import draw_comparison, draw_values, figures_of
from comparisons.output.style import FORMATS, new_figure, save
from comparisons.registry import MODELS


def errors(models=("md-original", "md-improved"), shapes=(1.0, 2.0), numbers=(0.1, 1.0, 2.0)):
    grid = [(m, n, k, mu) for m in models for n in shapes for k in (0.0, 0.4) for mu in numbers]
    table = pd.DataFrame(grid, columns=["model", "n", "k", "mu"])
    same = {"quantity": "pull_off_force", "reference": "fscm", "nu": np.nan, "u_kappa": 1e-4}
    return table.assign(kappa=0.01 * table["mu"] * table["n"], **same)


def test_the_errors_of_both_models_have_a_panel_for_each_shape_at_one_k():
    ((stem, figure),) = figures_of({"kappa": errors(), "curves": pd.DataFrame()})
    assert (stem, [axes.get_xscale() for axes in figure.axes if axes.get_visible()]) == ("fig16b_kappa", ["log"] * 2)
    lines = [container[0] for container in figure.axes[1].containers]
    assert len(lines) == 2
    for line in lines:
        np.testing.assert_allclose(line.get_xydata(), [[0.1, 0.2], [1, 2], [2, 4]])
    assert lines[0].get_linestyle() != lines[1].get_linestyle()
    assert list(figures_of({"kappa": errors(["jkr"])})) == []


def test_an_external_model_stands_first_and_above_ours():
    figure = draw_comparison(errors(["jkr", "mine", "md-improved"]).assign(status="ok"))
    (legend,) = figure.legends
    assert [text.get_text().partition(",")[0] for text in legend.get_texts()] == ["mine", "jkr", "md-improved"]
    mine, *ours = [container[0] for container in figure.axes[0].containers]
    assert mine.get_zorder() > max(line.get_zorder() for line in ours)


def test_the_agreement_of_two_models_is_their_difference_over_its_bound():
    case = {"quantity": "pull_off_force", "model": "fem", "reference": "fscm", "k": 0.4, "mu": 1.0, "nu": 0.3}
    table = pd.DataFrame([case | {"n": 1.0, "en": -0.5}, case | {"n": 2.0, "en": 1.5}])
    ((stem, figure),) = figures_of({"agreement": table})
    assert stem == "agreement"
    np.testing.assert_allclose(figure.axes[0].get_lines()[0].get_xydata(), [[1, -0.5], [2, 1.5]])


def test_values_are_drawn_over_each_varied_number_in_units_of_their_own():
    cases = [(R, thickness) for R in (1e-6, 2e-6) for thickness in (1e-8, 5e-8, 1e-7)]
    table = pd.DataFrame(cases, columns=["punch.R [m]", "solid.thickness [m]"])
    table["problem"] = [f"pad.toml; punch.R={R}; solid.thickness={thickness}" for R, thickness in cases]
    same = {"quantity": "pull_off_force", "model": "fscm", "unit": "N", "status": "ok", "u_num": 1e-12}
    solved = table.assign(value=[R * 0.3 for R, _ in cases], **same)
    figure = draw_values(solved)
    drawn = [axes for axes in figure.axes if axes.get_visible()]
    assert [axes.get_ylabel() for axes in drawn] == ["pull-off force (nN)"] * 5
    np.testing.assert_allclose(drawn[4].containers[0][0].get_xydata(), [[10, 600], [50, 600], [100, 600]])
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["fscm"]
    assert draw_values(solved.head(1)) is None
    # Over more than a decade, 50 nm to 1 um, the axis is logarithmic.
    assert {axes.get_xscale() for axes in drawn} == {"linear"}
    wide = draw_values(solved.assign(**{"solid.thickness [m]": [5e-8, 1e-7, 1e-6] * 2}).head(3))
    assert [axes.get_xscale() for axes in wide.axes] == ["log"]


def test_the_curves_of_the_references_have_a_panel_for_each_case_with_the_tension():
    x = np.linspace(-50, 50, 1001)
    load = np.where(x > 0, x**2, 0) - 2 * np.exp(-(x**2))
    points = pd.DataFrame({"x": x, "y": load, "point": range(len(x))})
    case = {"quantity": "force_curve", "n": 2.0, "k": 0.0, "nu": np.nan, "status": "ok"}
    tables = [points.assign(model=m, mu=mu, **case) for m in ("fscm", "fem") for mu in (1.0, 2.0)]
    ((_, figure),) = figures_of({"curves": pd.concat(tables, ignore_index=True)})
    assert [len(axes.get_lines()) for axes in figure.axes] == [3, 3]
    assert figure.axes[1].get_title() == "n = 2, k = 0, mu = 2"
    for axes in figure.axes[:2]:
        assert axes.get_ylim() == pytest.approx((-2.3, 2.0))
        left, right = axes.get_xlim()
        assert -5 < left < -1.5
        assert 1 < right < 3


def test_the_same_data_give_the_same_bytes(tmp_path):
    for name in "ab":
        figure = new_figure(2.0, 1.0)
        figure.subplots().plot([1.0, 2.0], label="a")
        save(figure, *(tmp_path / f"{name}{suffix}" for suffix in FORMATS))
    for suffix in FORMATS:
        assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
    with pytest.raises(ValueError, match=r"\.png, \.pdf, \.svg"):
        save(figure, tmp_path / "a.gif")


def test_a_varied_key_is_the_axis_in_the_order_of_its_values_and_another_one_has_panels():
    rows = [
        {"model": "jkr", "quantity": "pull_off_force", "n": np.nan, "k": np.nan, "mu": np.nan, "nu": np.nan}
        | {"problem": f"pad.toml; law.z0={z0} nm; punch.R={R} nm", "law.z0 [m]": z0 * 1e-9, "punch.R [m]": R * 1e-9}
        | {"reference": "fscm", "kappa": -1e-3 * z0, "u_kappa": 1e-9}
        for z0 in (200.0, 20.0, 1000.0)
        for R in (1.0, 2.0)
    ]
    axes = draw_comparison(pd.DataFrame(rows)).axes
    assert [panel.get_title().partition("punch.R")[2].replace("\u00a0", " ") for panel in axes] == [
        " = 1 nm",
        " = 2 nm",
    ]
    assert {panel.get_xlabel() for panel in axes} == {"law.z0 (µm)"}
    assert {panel.get_xscale() for panel in axes} == {"log"}
    decade = pd.DataFrame([row for row in rows if row["law.z0 [m]"] < 0.9e-6])
    assert {panel.get_xscale() for panel in draw_comparison(decade).axes} == {"linear"}
    drawn = np.asarray(axes[0].containers[0][0].get_xdata(), float)
    np.testing.assert_allclose(drawn, [0.02, 0.2, 1.0])


def test_a_comparison_has_a_panel_for_each_case_and_a_legend_inside_the_figure():
    models = [name for name in MODELS if name != "fscm"]
    figure = draw_comparison(errors(models))
    FigureCanvasAgg(figure).draw()
    assert len(figure.axes) == 4
    assert "n = 2, k = 0.4" in figure.axes[3].get_title().replace("\n", " ").replace("\u00a0", " ")
    (legend,) = figure.legends
    box, whole = legend.get_window_extent(), figure.bbox
    assert whole.x0 <= box.x0 < box.x1 <= whole.x1
    assert whole.y0 <= box.y0 < box.y1 <= whole.y1
    # A bar of the bound is too small to be seen: the legend states it.
    assert "jkr, u ≤ 1.0e-02 %" in [text.get_text() for text in legend.get_texts()]
    assert len({(line.get_color(), line.get_marker()) for line in legend.get_lines()}) == len(models)
    # Two periods of dash and dot are longer than what their marker covers.
    assert legend.handlelength >= 4
    # More panels than a figure has room for: the cases are points of one.
    (axes,) = draw_comparison(errors(["jkr"], np.arange(1.0, 14.0), np.arange(1.0, 15.0))).axes
    assert axes.get_xlabel() == "case"
    assert not np.any(axes.get_xticks() % 1.0)
