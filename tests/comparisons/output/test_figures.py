"""Figures: their data, and the same file from the same data."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from comparisons.output.figures import curves
from comparisons.output.figures.of_run import draw_comparison, draw_kappa, figures_of
from comparisons.output.style import FORMATS, save
from comparisons.quantities import CURVES, Points
from comparisons.registry import MODELS


def errors(models=("md-original", "md-improved"), shapes=(1.0, 2.0), numbers=(0.1, 1.0, 2.0)):
    grid = [(m, n, k, mu) for m in models for n in shapes for k in (0.0, 0.4) for mu in numbers]
    table = pd.DataFrame(grid, columns=["model", "n", "k", "mu"])
    same = {"quantity": "pull_off_force", "reference": "fscm", "nu": np.nan, "u_kappa": 1e-4}
    return table.assign(kappa=0.01 * table["mu"] * table["n"], **same)


def test_fig_16b_shows_both_models_for_every_shape_at_one_k():
    ((stem, figure),) = figures_of({"kappa": errors(), "curves": pd.DataFrame()})
    axes = figure.axes[0]
    assert (stem, axes.get_xscale()) == ("fig16b_kappa", "log")
    lines = {line.get_label(): line for line in axes.get_lines() if not line.get_label().startswith("_")}
    assert set(lines) == {f"$n$ = {n}, {model} M-D-$n$-$k$" for n in (1, 2) for model in ("original", "improved")}
    improved = lines["$n$ = 2, improved M-D-$n$-$k$"]
    np.testing.assert_allclose(improved.get_xydata(), [[0.1, 0.2], [1, 2], [2, 4]])
    assert improved.get_linestyle() != lines["$n$ = 2, original M-D-$n$-$k$"].get_linestyle()
    assert list(figures_of({"kappa": errors(["jkr"])})) == []


def test_the_agreement_of_two_models_is_their_difference_over_its_bound():
    case = {"quantity": "pull_off_force", "model": "fem", "reference": "fscm", "k": 0.4, "mu": 1.0}
    table = pd.DataFrame([case | {"n": 1.0, "en": -0.5}, case | {"n": 2.0, "en": 1.5}])
    ((stem, figure),) = figures_of({"agreement": table})
    assert stem == "agreement"
    assert [list(line.get_ydata()) for line in figure.axes[0].get_lines()] == [[1, 1], [0.5], [1.5]]


def test_the_curves_of_the_references_have_a_panel_for_each_case_with_the_tension():
    x = np.linspace(-50, 50, 1001)
    load = np.where(x > 0, x**2, 0) - 2 * np.exp(-(x**2))
    points = pd.DataFrame({"x": x, "y": load, "point": range(len(x))})
    case = {"quantity": "force_curve", "n": 2.0, "k": 0.0, "nu": np.nan, "status": "ok"}
    tables = [points.assign(model=m, mu=mu, **case) for m in ("fscm", "fem") for mu in (1.0, 2.0)]
    ((_, figure),) = figures_of({"curves": pd.concat(tables, ignore_index=True)})
    assert [len(axes.get_lines()) for axes in figure.axes] == [3, 3]
    for axes in (*figure.axes, curves.draw({"a": Points(x, load, 0.0)}, CURVES["force_curve"], "n = 2").axes[0]):
        assert axes.get_ylim() == pytest.approx((-2.3, 2.0))
        left, right = axes.get_xlim()
        assert -5 < left < -1.5
        assert 1 < right < 3


def test_the_unstable_section_of_a_curve_is_thin():
    x = np.arange(6.0)
    marks = {"stable_under_displacement": [1.0, 1.0, 0.0, 0.0, 0.0, 1.0]}
    points = {"a": Points(x.tolist(), (-x).tolist(), 0.0, marks), "b": Points(x.tolist(), x.tolist(), 0.0)}
    axes = curves.draw(points, CURVES["force_curve"], "n = 2").axes[0]
    widths = [line.get_linewidth() for line in axes.get_lines()[:4]]
    assert widths[1] < widths[0] == widths[2] == widths[3]
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert (texts[:2], "unstable" in texts[2]) == (["a", "b"], True)


@pytest.mark.parametrize("suffix", FORMATS)
def test_the_same_data_give_the_same_bytes(tmp_path, suffix):
    for name in "ab":
        save(draw_kappa(errors()), tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
    with pytest.raises(ValueError, match=r"\.png, \.pdf, \.svg"):
        save(draw_kappa(errors()), tmp_path / "a.gif")


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
    assert len({(line.get_color(), line.get_marker()) for line in legend.get_lines()}) == len(models)
    # More panels than a figure has room for: the cases are points of one.
    (axes,) = draw_comparison(errors(["jkr"], np.arange(1.0, 14.0), np.arange(1.0, 15.0))).axes
    assert axes.get_xlabel() == "case"
