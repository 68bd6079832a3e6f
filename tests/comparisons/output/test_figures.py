"""Figures: their data, and the same file from the same data."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from comparisons.output.figures import comparison, curves
from comparisons.output.figures.of_run import draw_kappa, figures_of
from comparisons.output.style import FORMATS, save
from comparisons.quantities import CURVES, Points
from comparisons.registry import MODELS


def errors():
    grid = [
        (m, n, k, mu)
        for m in ("md-original", "md-improved")
        for n in (1.0, 2.0)
        for k in (0.0, 0.4)
        for mu in (0.1, 1, 2)
    ]
    table = pd.DataFrame(grid, columns=["model", "n", "k", "mu"])
    return table.assign(quantity="pull_off_force", kappa=0.01 * table["mu"] * table["n"], u_kappa=1e-4)


def test_fig_16b_shows_both_models_for_every_shape_at_one_k():
    ((_, figure),) = figures_of({"kappa": errors()})
    axes = figure.axes[0]
    assert axes.get_xscale() == "log"
    lines = {line.get_label(): line for line in axes.get_lines() if not line.get_label().startswith("_")}
    assert set(lines) == {f"$n$ = {n}, {model} M-D-$n$-$k$" for n in (1, 2) for model in ("original", "improved")}
    improved = "$n$ = 2, improved M-D-$n$-$k$"
    np.testing.assert_allclose(lines[improved].get_xdata(), [0.1, 1, 2])
    np.testing.assert_allclose(lines[improved].get_ydata(), [0.2, 2, 4])
    assert lines[improved].get_linestyle() != lines["$n$ = 2, original M-D-$n$-$k$"].get_linestyle()


def drawn(**curves_of):
    points = {name: Points(x.tolist(), y.tolist(), 0.0) for name, (x, y) in curves_of.items()}
    return curves.draw(points, CURVES["force_curve"], "n = 2")


def test_the_unstable_part_of_a_curve_is_thin():
    x = np.arange(6.0)
    marks = {"stable_under_displacement": [1.0, 1.0, 0.0, 0.0, 0.0, 1.0]}
    points = {"a": Points(x.tolist(), (-x).tolist(), 0.0, marks), "b": Points(x.tolist(), x.tolist(), 0.0)}
    axes = curves.draw(points, CURVES["force_curve"], "n = 2").axes[0]
    first, unstable, last, other = axes.get_lines()[:4]
    assert [line.get_xdata().tolist() for line in (first, unstable, last)] == [[0, 1, 2], [2, 3, 4], [4, 5]]
    assert unstable.get_linewidth() < first.get_linewidth() == last.get_linewidth() == other.get_linewidth()
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert texts[:2] == ["a", "b"]
    assert "unstable" in texts[2]


def test_a_figure_without_rows_is_not_drawn():
    others = errors().assign(model="jkr")
    drawn_stems = [stem for stem, _ in figures_of({"kappa": errors(), "curves": pd.DataFrame()})]
    assert "fig16b_kappa" in drawn_stems
    assert "references" not in drawn_stems
    assert list(figures_of({"kappa": others})) == []


def test_force_curves_are_shown_where_the_surfaces_pull():
    x = np.linspace(-50, 50, 1001)
    axes = drawn(a=(x, np.where(x > 0, x**2, 0) - 2 * np.exp(-(x**2)))).axes[0]
    assert axes.get_ylim() == (-2.3, 2.0)
    left, right = axes.get_xlim()
    assert -5 < left < -1.5
    assert 1 < right < 3


@pytest.mark.parametrize("suffix", FORMATS)
def test_the_same_data_give_the_same_bytes(tmp_path, suffix):
    for name in "ab":
        save(draw_kappa(errors()), tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


def test_an_unknown_format_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"\.png, \.pdf, \.svg"):
        save(draw_kappa(errors()), tmp_path / "a.gif")


def test_the_legend_of_a_comparison_of_many_models_is_inside_the_figure():
    models = [name for name in MODELS if name != "fscm"]
    case = {"quantity": "pull_off_force", "reference": "fscm", "n": 2.0, "k": 0.0, "u_kappa": 1e-9}
    table = pd.DataFrame([case | {"model": name, "mu": mu, "kappa": 0.1} for name in models for mu in (0.1, 1.0)])
    figure = comparison.draw(table)
    FigureCanvasAgg(figure).draw()
    (legend,) = figure.legends
    box, whole = legend.get_window_extent(), figure.bbox
    assert whole.x0 <= box.x0 < box.x1 <= whole.x1
    assert whole.y0 <= box.y0 < box.y1 <= whole.y1
    drawn = [(line.get_color(), line.get_marker()) for line in legend.get_lines()]
    assert len(set(drawn)) == len(models)
