"""Figs. 4 and 6: families that fold above the critical Tabor number, in the order of the paper."""

import numpy as np
import pytest

from comparisons.paper.figures import fig04_06_force_curves as force_curves
from comparisons.paper.paper_figure import PaperFigure


@pytest.fixture(scope="module")
def family(tables_of):
    def of(*cases):
        figure = PaperFigure(
            "x",
            "x",
            "x",
            lambda: force_curves._tasks(cases),
            lambda results: force_curves._tables(cases, results),
            None,
        )
        return tables_of(figure)[""]

    return of


def test_over_tabor_numbers(family):
    table = family((2.0, 0.4, 0.3), (2.0, 0.4, 1.0), (5.0, 0.4, 0.3))
    rigid, soft = (table[(table["n"] == 2) & (table["mu"] == mu)] for mu in (0.3, 1.0))
    # The critical Tabor number is 0.78.
    assert (np.diff(rigid["displacement"]) > 0).all()
    assert (np.diff(soft["displacement"]) < 0).any()
    # Sec. 3.2.1: for n = 2 the pull-off force falls with mu, and so does the displacement there.
    lowest = [part.loc[part["load"].idxmin()] for part in (rigid, soft)]
    assert lowest[0]["load"] < lowest[1]["load"]
    assert lowest[0]["displacement"] > lowest[1]["displacement"]
    assert (table[["u_displacement", "u_load"]] > 0).all(axis=None)
    assert (table[["u_displacement", "u_load"]] < 1e-5).all(axis=None)


@pytest.mark.heavy
def test_over_gradients(family):
    table = family(*((2.0, k, 0.5) for k in (0.0, 0.6, 1.0)))
    # Sec. 3.2.2: the pull-off force grows with k, to 2 in the Gibson limit of a paraboloid.
    forces = -table.groupby("k")["load"].min()
    assert forces.is_monotonic_increasing
    assert forces[1.0] == pytest.approx(2, rel=1e-4)


def test_a_curve_that_is_refused_is_named(family):
    table = family((2.0, 1.0, 0.5), (0.6, 0.4, 1.0))
    assert list(table[table["n"] == 0.6]["status"]) == ["failed"]
    assert table[table["n"] == 0.6]["load"].isna().all()


def test_the_figures_have_every_curve():
    assert len(force_curves.OVER_TABOR_NUMBERS.tasks()) == 28
    assert len(force_curves.OVER_GRADIENTS.tasks()) == 10
