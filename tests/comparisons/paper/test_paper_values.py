"""Verdicts on paper values, what one scheme for each figure gives, and the ingredients of the Stieltjes scheme."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.data.paper_values import PaperValue, paper_values
from comparisons.models.cohesive_stress import eta
from comparisons.models.maugis_dugdale import MaugisDugdaleImproved
from comparisons.numerics.number_text import short
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.figures.fig11_gradient_effect import insensitive_regions, largest_chi
from comparisons.paper.paper_figure import results_by
from comparisons.paper.studies.tabor_curve import RANGE, TaborCurve, largest_error, tabor_numbers
from comparisons.paper.values import comparison
from comparisons.paper.values.causes import LAST_K, Repeated, _region, cohesive_forces, frame
from comparisons.paper.values.comparison import judged, readable
from comparisons.paper.values.scheme_ingredients import HEIGHTS, exact_force, sampled_force, scheme_force
from comparisons.problem import Problem
from comparisons.registry import create

ROOT = Path(__file__).parents[3]
FOLDER = ROOT / PAPER_BASELINE
CRITICAL = paper_values("critical_tabor_number")


@pytest.fixture(scope="module")
def results(made_of):
    return made_of(
        lambda: results_by({comparison._critical(number): comparison._critical(number) for number in CRITICAL})
    )


def test_closed_forms_and_critical_tabor_numbers_agree_to_every_printed_digit(results):
    direct = [number for number in paper_values() if number.name in comparison._DIRECT]
    assert len(direct) > 8
    for number in direct:
        row = judged(number, results, [])
        assert (row["verdict"], row["scheme"], row["scheme_verdict"]) == ("agrees", "", ""), number
        assert row["u"] < 1e-13 * abs(row["computed"])
    rows = [judged(number, results, []) for number in CRITICAL]
    assert [(row["printed"], row["verdict"]) for row in rows] == [
        (text, "agrees") for text in ("0.70", "0.75", "0.78", "0.78")
    ]
    shown = readable(pd.DataFrame(rows))
    assert shown["case"].tolist()[1] == "n = 2, k = 0.2"
    assert shown["computed"].tolist()[0] == short(rows[0]["computed"], 5e-10)


@pytest.mark.parametrize(
    ("model", "mu", "verdict"), [("md-original", 0.246, "agrees if truncated"), ("md-improved", 0.836, "agrees")]
)
def test_largest_errors_of_the_flattest_punch_have_every_printed_digit(model, mu, verdict):
    (paper_value,) = [c for c in paper_values("largest_relative_error") if (c.model, c.n) == (model, 5.0)]
    kappa = []
    for place in (0.9 * mu, mu, 1.1 * mu):
        own, exact = (
            create(name).evaluate(Problem.dimensionless(5.0, 0.4, place), "pull_off_force").value
            for name in (model, "fscm")
        )
        kappa.append(100 * (own / exact - 1))
    assert kappa[1] == max(kappa)
    assert paper_value.verdict(kappa[1], 1e-4) == verdict


def test_causes_tell_what_each_ingredient_shifts():
    printed = PaperValue("largest_relative_error", "", "error", "1.7", "%", model="m", n=1.5, k=0.4)
    table = frame([Repeated(printed, "converged", -1.8354, 1e-6), Repeated(printed, "cut", -1.6478, 1e-6)])
    assert table["shift"].to_numpy() == pytest.approx([0.0, 0.1876])
    assert table["verdict"].tolist() == ["differs", "differs"]


def test_a_gradient_exponent_that_stops_short_of_the_gibson_limit_gives_the_last_end_its_digits():
    verdicts = [
        [
            number.verdict(end, 1e-9)
            for number, end in zip(paper_values("insensitive_region"), insensitive_regions(last_k), strict=True)
        ]
        for last_k in (1.0, 0.9995, LAST_K)
    ]
    assert verdicts == [
        ["agrees", "agrees if truncated", "agrees", "differs"],
        ["agrees", "agrees if truncated", "agrees", "agrees"],
        ["agrees", "agrees if truncated", "differs", "agrees if truncated"],
    ]
    ends = zip(paper_values("insensitive_region"), insensitive_regions(LAST_K), strict=True)
    rows = [list(_region(number, {LAST_K: end}))[-1] for number, end in ends]
    assert [row.verdict for row in rows] == ["agrees"] * 4
    steps = [row.value for row in rows]
    assert steps == [0.974, 1.056, 3.335, 6.219]
    inside = [largest_chi(n, LAST_K)[0] for n in steps]
    outside = [largest_chi(n, LAST_K)[0] for n in (0.973, 1.057, 3.334, 6.220)]
    assert max(inside) <= 0.1 < min(outside)


def committed(name):
    return pd.read_csv(FOLDER / f"{name}.csv", dtype={"printed": str}).fillna(
        {"model": "", "unit": "", "scheme": "", "scheme_verdict": ""}
    )


def paper_value_of(row):
    """The paper value of a row of a committed table."""
    (found,) = [
        paper_value
        for paper_value in paper_values()
        if (paper_value.quantity, paper_value.model, paper_value.text) == (row.quantity, row.model, row.printed)
        and np.array_equal([paper_value.n, paper_value.k], [row.n, row.k], equal_nan=True)
    ]
    return found


def test_the_committed_verdicts_are_those_of_the_committed_numbers_and_of_the_results_page():
    table = committed("paper_values")
    repetitions = [
        Repeated(paper_value_of(row), row.ingredient, row.computed, row.u, row.mu, row.stated_in_paper, row.scheme)
        for row in committed("paper_values_causes").itertuples()
    ]
    assert [again.verdict for again in repetitions] == committed("paper_values_causes")["verdict"].tolist()
    for row in table.itertuples():
        assert paper_value_of(row).verdict(abs(row.computed), row.u) == row.verdict
        of_value = [again for again in repetitions if again.paper_value == paper_value_of(row)]
        scheme = comparison._of_scheme(of_value)
        assert (row.scheme, row.scheme_verdict) == (scheme["scheme"], scheme["scheme_verdict"])
        assert (row.computed, row.by_scheme) == (of_value[0].value, scheme["by_scheme"]) if of_value else True
    text = " ".join((ROOT / "docs" / "results.md").read_text(encoding="utf-8").split())
    assert table["verdict"].value_counts().to_dict() == {"agrees": 24, "agrees if truncated": 4, "differs": 6}
    assert "of 34 numbers 24 agree, 4 agree if truncated (40.8 %, 1.056, 3.5 %, 15.9 %) and 6 differ" in text
    # One scheme gives all numbers but those of the cone.
    of_scheme = table[table["scheme"] != ""]
    assert of_scheme.loc[of_scheme["scheme_verdict"] != "agrees", "printed"].tolist() == ["65.0", "5.8"]
    assert len(of_scheme) == 16
    for row in of_scheme[of_scheme["scheme_verdict"] != "agrees"].itertuples():
        assert f"{abs(row.by_scheme):.2f} % for {row.printed} %" in text
    for suffix, page in comparison.PAPER_VALUES.texts({"": table}).items():
        assert (FOLDER / f"paper_values{suffix}").read_text(encoding="utf-8") == page


@pytest.mark.parametrize("n", [1.5, pytest.param(5.0, marks=pytest.mark.heavy)])
def test_between_the_points_a_curve_over_the_tabor_number_is_the_model(n):
    curve = TaborCurve.through(np.array(cohesive_forces(n, 0.4, eta(n))))
    mu = np.exp(np.random.default_rng(7).uniform(*np.log(RANGE), 12))
    direct = [MaugisDugdaleImproved().evaluate(Problem.dimensionless(n, 0.4, x), "pull_off_force").value for x in mu]
    np.testing.assert_allclose(curve(mu), direct, rtol=curve.error + 1e-13)
    assert curve.error < 1e-8
    # A series that is too short has a large error.
    kink, at = TaborCurve.through(np.maximum(np.array(tabor_numbers(40)), 0.7)), np.geomspace(*RANGE, 999)
    assert 1e-3 < np.max(np.abs(kink(at) / np.maximum(at, 0.7) - 1)) < 10 * kink.error


def test_the_largest_error_is_found_between_samples_and_at_ends():
    """kappa = 0.1 / (1 + log(mu / 0.3)^2 / 2), largest at mu = 0.3."""
    mu = np.array(tabor_numbers(80))
    model = TaborCurve.through(1.0 + 0.1 / (1.0 + 0.5 * np.log(mu / 0.3) ** 2))
    exact = TaborCurve.through(np.ones(81))
    whole = largest_error(model, exact)
    assert (whole.kappa, whole.mu) == (pytest.approx(0.1, abs=1e-8), pytest.approx(0.3, rel=1e-5))
    end = largest_error(model, exact, low=1.0)
    assert (end.kappa, end.mu) == (pytest.approx(0.1 / (1 + 0.5 * np.log(0.3) ** 2), abs=1e-8), 1.0)
    sampled = largest_error(model, exact, sampled=np.array([0.1, 0.2, 0.5]))
    assert (sampled.mu, sampled.kappa < whole.kappa) == (0.2, True)


def test_what_a_stiff_punch_loses_beyond_the_domain():
    # p = -(8/3) (H0 + 1 + f)^-3 beyond f = 50, the repulsion being 1e-10 of it.
    cone, sphere = exact_force(1.0, 0.4, 1e-4), exact_force(2.0, 0.2, 1e-4)
    for height, lost, lost_by_sphere in zip(HEIGHTS, cone["beyond"], sphere["beyond"], strict=True):
        H = cone["central_gap"] + 1.0
        u = height + H
        assert lost == pytest.approx(16 / 3 * (1 / u - 0.5 * H / u**2), rel=2e-4)
        assert lost_by_sphere == pytest.approx(8 / 3 / (height + 1.0 + sphere["central_gap"]) ** 2, rel=2e-4)


@pytest.mark.parametrize(("n", "mu"), [(1.0, 0.236), (2.0, 0.668)])
def test_the_scheme_tends_to_the_converged_force_without_what_is_beyond(n, mu):
    """Two routes to the truncated force: the exact one without a part, and the sums of the scheme."""
    found = exact_force(n, 0.4, mu)
    truncated = found["force"] - found["beyond"][0]
    coarse, fine = (scheme_force(n, 0.4, mu, segments)["force"] - truncated for segments in (300, 600))
    # Second order: what is left after extrapolation is a small part of the error of the finer mesh.
    assert abs(fine + (fine - coarse) / 3) < 0.15 * abs(fine) + 1e-5
    assert 3.0 < coarse / fine < 5.0
    assert abs(fine) < 0.1 * found["beyond"][0] + 1e-3


@pytest.mark.heavy
def test_the_scheme_is_its_own_model():
    """The stationary load found from the accurate surface is that of the path followed from afar."""
    followed = create("fscm-stieltjes-400").evaluate(Problem.dimensionless(2.0, 0.4, 0.5), "pull_off_force").value
    direct = scheme_force(2.0, 0.4, 0.5, segments=400)
    assert direct["force"] == pytest.approx(followed, abs=direct["u_num"] + 1e-7)


@pytest.mark.heavy
def test_samples_of_the_central_gap_miss_the_largest_force():
    force, found = exact_force(5.0, 0.4, 0.836)["force"], sampled_force(5.0, 0.4, 0.836)
    lost = [force - sample for sample in found["sampled"]]
    assert min(lost) > 0.0
    # Gaps 0.1 apart lose a tenth; those 0.001 apart almost nothing.
    assert lost[0] > 0.1 * force
    assert lost[-1] < 3e-5 * force
    # The pull-off is before the last gap here, and beyond it for a cone on a stiff solid.
    assert found["at_last_gap"] == force
    assert sampled_force(1.0, 0.4, 0.1)["at_last_gap"] < exact_force(1.0, 0.4, 0.1)["force"] - 0.05
