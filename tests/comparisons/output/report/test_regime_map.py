"""The map of regimes: cells, coverage, the model to use, shared ranks, choices, and the pages that begin with it."""

import math
import re

import pandas as pd
import pytest

from comparisons.judging.standing import inside
from comparisons.output.report.page import make_page
from comparisons.output.report.regime_map import STEPS, RegimeMap
from comparisons.output.report.render import render
from comparisons.output.report.stored_run import read_folder


def evaluations(*rows, quantity="pull_off_force"):
    """Evaluations from (model, n, k, mu, kappa); a kappa that is None has failed."""
    table = pd.DataFrame(
        [
            {"quantity": quantity, "model": model, "reference": "fscm", "n": n, "k": k, "mu": mu, "nu": math.nan}
            | {"status": "failed" if kappa is None else "ok", "kappa": math.nan if kappa is None else kappa}
            | {"u_kappa": 1e-3 if kappa is not None else math.nan}
            for model, n, k, mu, kappa in rows
        ]
    )
    return table.assign(inside=inside(table, table["model"], {}))


def view(regimes, *options):
    return regimes.views["pull-off force", "fscm", *options]


SPHERE = ("homogeneous", "n = 2", "k = 0")


def cells(regime, models):
    return dict(zip(models, regime.cells, strict=True))


def test_a_cell_has_the_error_and_a_number_beyond_the_declared_range_is_not_judged():
    rows = [("jkr", 2.0, 0.0, 0.01, -0.25), ("md-improved", 2.0, 0.0, 0.01, 0.12), ("jkr", 2.0, 0.0, 5.0, -0.017)]
    shown = view(RegimeMap(evaluations(*rows)), *SPHERE)
    stiff, soft = shown.regimes
    assert (stiff.label, soft.label) == ("μ = 0.01", "μ = 5")
    jkr = cells(stiff, shown.models)["jkr"]
    assert (jkr.text, jkr.step, jkr.use) == ("(−25.0)", None, False)
    assert "μ ≥ 5" in jkr.title
    soft_jkr = cells(soft, shown.models)["jkr"]
    assert (soft_jkr.text, soft_jkr.step, soft_jkr.use) == ("−1.70", sum(limit <= 0.017 for limit in STEPS), True)
    # No model is certainly within 5 %; that which is not judged is not the nearest either.
    assert (stiff.use, stiff.nearness) == ("", "none within 5 %; nearest md-improved")
    # Nothing is known of it.
    assert cells(soft, shown.models)["md-improved"].text == "–"


def test_a_bound_that_reaches_beyond_the_limit_is_not_within_it():
    for error, nearness in ((0.0089, "within 1 %"), (0.0091, "within 5 %"), (0.0489, "within 5 %")):
        (regime,) = view(RegimeMap(evaluations(("mine", 2.0, 0.0, 1.0, error))), *SPHERE).regimes
        assert (regime.use, regime.nearness) == ("mine", nearness)
    (regime,) = view(RegimeMap(evaluations(("mine", 2.0, 0.0, 1.0, 0.0491))), *SPHERE).regimes
    assert regime.use == ""


def test_models_whose_order_the_bounds_do_not_decide_share_a_rank():
    rows = [("a", 0.1), ("b", 0.1015), ("c", 0.2)]
    (regime,) = view(RegimeMap(evaluations(*((m, 2.0, 0.0, 1.0, kappa) for m, kappa in rows))), *SPHERE).regimes
    ranks = [re.search("(shared )?rank . of .", cell.title)[0] for cell in regime.cells]
    assert ranks == ["shared rank 1 of 3", "shared rank 1 of 3", "rank 3 of 3"]


def test_cases_together_have_the_largest_error_and_a_model_without_all_of_them_is_not_recommended():
    rows = [("part", 2.0, 0.0, 1.0, 0.001), ("part", 1.0, 0.4, 1.0, None)]
    rows += [("md-improved", 2.0, 0.0, 1.0, 0.02), ("md-improved", 1.0, 0.4, 1.0, -0.04)]
    regimes = RegimeMap(evaluations(*rows))
    shown = view(regimes, "every solid", "every punch", "every k")
    (regime,) = shown.regimes
    of = cells(regime, shown.models)
    assert (of["part"].text, of["part"].coverage, of["part"].use) == ("+0.100", "1/2", False)
    assert (of["md-improved"].text, of["md-improved"].coverage, of["md-improved"].use) == ("−4.00", "", True)
    assert "mean −1.00 %" in of["md-improved"].title
    (alone,) = view(regimes, *SPHERE).regimes
    assert alone.use == "part"
    (failed,) = view(regimes, "graded, E ~ z^k", "n = 1", "k = 0.4").regimes
    assert cells(failed, ["md-improved", "part"])["part"].text in ("failed", "−4.00")
    assert {cell.text for cell in failed.cells} == {"failed", "−4.00"}


def test_many_tabor_numbers_are_put_together_and_no_case_is_lost():
    rows = [("md-improved", 2.0, 0.0, 0.01 * 1.05**i, 0.0001 * i) for i in range(140)]
    shown = view(RegimeMap(evaluations(*rows)), *SPHERE)
    assert len(shown.regimes) <= 24
    counts = [re.search("largest of ([0-9]+) cases", regime.cells[0].title) for regime in shown.regimes]
    assert sum(int(match[1]) if match else 1 for match in counts) == 140
    assert shown.regimes[0].label == "0.01 ≤ μ < 0.02"


def test_problem_files_are_regimes_of_the_kind_of_their_solid():
    rows = evaluations(("jkr", math.nan, math.nan, math.nan, 0.02)).assign(problem="film.toml; punch.R=1 um")
    regimes = RegimeMap(rows, problems={"film.toml": ("layered", "sphere")})
    (regime,) = view(regimes, "layered", "sphere", "as in its file").regimes
    assert (regime.label, regime.use) == ("film.toml; punch.R=1 um", "jkr")


@pytest.fixture(scope="module")
def stored(run_folder):
    return read_folder(run_folder)


def test_the_page_begins_with_the_map_and_hostile_names_are_texts_in_it(stored):
    page = make_page(stored)
    assert next(iter(page.sections)) == "map"
    html = render(page).html
    table = html.partition('<table class="map">')[2].partition("</table>")[0]
    assert table.count("<tr>") == 1 + 22
    assert not re.search("<(script|img)", table)
    assert html.index('class="map"') < html.index("<nav")


def test_options_that_lead_nowhere_are_not_offered(stored):
    (regimes,) = make_page(stored).maps
    offered = dict(regimes.choices)
    assert offered["gradient"] == ["every k", "k = 0", "k = 0.4"]
    assert offered["punch"] == ["every punch", "n = 1", "n = 2"]
    assert regimes.first[2:] == SPHERE
    assert {options[0] for options in regimes.views} == set(offered["quantity"])
