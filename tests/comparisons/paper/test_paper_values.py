"""Verdicts on paper values, and what one scheme for each figure gives."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.data.paper_values import PaperValue, paper_values
from comparisons.numerics.number_text import short
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.cache import CallCache
from comparisons.paper.figures.fig11_gradient_effect import insensitive_regions, largest_chi
from comparisons.paper.values import comparison
from comparisons.paper.values.causes import GRID, Repeated, frame
from comparisons.paper.values.comparison import judged, readable
from comparisons.paper.values.sampling import LAST_K, first_or_last_step
from comparisons.registry import create
from comparisons.runs.cases import Case

ROOT = Path(__file__).parents[3]
FOLDER = ROOT / PAPER_BASELINE
DIRECT = [number for number in paper_values() if number.name in comparison._DIRECT]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    cache = CallCache(tmp_path_factory.mktemp("numbers") / "tasks.jsonl", "test")
    list(cache.work(map(comparison._critical, paper_values("critical_tabor_number")), 1))
    return cache.results


@pytest.mark.parametrize(
    "paper_value", DIRECT, ids=lambda paper_value: f"{paper_value.name}-{paper_value.n}-{paper_value.k}"
)
def test_closed_forms_agree_to_every_printed_digit(paper_value, results):
    row = judged(paper_value, results, [])
    assert (row["verdict"], row["scheme"], row["scheme_verdict"]) == ("agrees", "", "")
    assert row["u"] < 1e-13 * abs(row["computed"])


def test_critical_tabor_numbers_agree_to_every_printed_digit(results):
    rows = [judged(paper_value, results, []) for paper_value in paper_values("critical_tabor_number")]
    assert [(row["printed"], row["verdict"]) for row in rows] == [
        (text, "agrees") for text in ("0.70", "0.75", "0.78", "0.78")
    ]


@pytest.mark.parametrize("paper_value", paper_values("largest_chi"), ids=lambda paper_value: str(paper_value.n))
def test_chi_has_every_printed_digit(paper_value):
    expected = "agrees if truncated" if paper_value.n == 1.5 else "agrees"
    assert paper_value.verdict(100 * largest_chi(paper_value.n)[0], 1e-11) == expected


@pytest.mark.parametrize(
    ("model", "mu", "verdict"), [("md-original", 0.246, "agrees if truncated"), ("md-improved", 0.836, "agrees")]
)
def test_largest_errors_of_the_flattest_punch_have_every_printed_digit(model, mu, verdict):
    (paper_value,) = [c for c in paper_values("largest_relative_error") if (c.model, c.n) == (model, 5.0)]
    kappa = []
    for place in (0.9 * mu, mu, 1.1 * mu):
        force = {
            name: create(name).evaluate(Case(5.0, 0.4, place).problem(), "pull_off_force").value
            for name in (model, "fscm")
        }
        kappa.append(100 * (force[model] / force["fscm"] - 1))
    assert kappa[1] == max(kappa)
    assert paper_value.verdict(kappa[1], 1e-4) == verdict


PRINTED = PaperValue("largest_relative_error", "", "error", "1.7", "%", model="m", n=1.5, k=0.4)


def repeated(ingredient, value, stated=True):
    return Repeated(PRINTED, ingredient, value, 1e-6, 1.0, stated)


def test_causes_tell_what_each_ingredient_shifts():
    table = frame([repeated("converged", -1.8354), repeated("cut", -1.6478)])
    assert table["shift"].to_numpy() == pytest.approx([0.0, 0.1876])
    assert table["verdict"].tolist() == ["differs", "differs"]


def test_for_reading_a_number_keeps_the_digits_its_uncertainty_leaves(results):
    rows = [judged(paper_value, results, []) for paper_value in paper_values("critical_tabor_number")]
    shown = readable(pd.DataFrame(rows))
    assert shown["case"].tolist()[1] == "n = 2, k = 0.2"
    assert shown["computed"].tolist()[0] == short(rows[0]["computed"], 5e-10)


def test_one_end_of_the_regions_differs():
    ends = insensitive_regions()
    verdicts = [
        paper_value.verdict(end, 1e-9)
        for paper_value, end in zip(paper_values("insensitive_region"), ends, strict=True)
    ]
    assert verdicts == ["agrees", "agrees if truncated", "agrees", "differs"]
    # A gradient exponent that stops short of the Gibson limit gives the last end its printed digits; farther from 1 the
    # end before it loses its own.
    short_of_one = [
        [
            paper_value.verdict(end, 1e-9)
            for paper_value, end in zip(paper_values("insensitive_region"), ends, strict=True)
        ]
        for ends in (insensitive_regions(0.9995), insensitive_regions(0.999))
    ]
    assert short_of_one == [
        ["agrees", "agrees if truncated", "agrees", "agrees"],
        ["agrees", "agrees if truncated", "differs", "agrees if truncated"],
    ]


def committed(name):
    return pd.read_csv(FOLDER / f"{name}.csv", dtype={"printed": str}).fillna(
        {"model": "", "unit": "", "scheme": "", "scheme_verdict": ""}
    )


def test_the_committed_verdicts_are_counted_as_the_results_page_says():
    counts = committed("paper_values")["verdict"].value_counts().to_dict()
    assert counts == {"agrees": 24, "agrees if truncated": 4, "differs": 6}
    text = " ".join((ROOT / "docs" / "results.md").read_text(encoding="utf-8").split())
    assert "of 34 numbers 24 agree, 4 agree if truncated (40.8 %, 1.056, 3.5 %, 15.9 %) and 6 differ" in text


def test_a_run_and_the_table_have_one_verdict_on_a_number():
    """The maxima of a run and the numbers of the paper are compared with the same digits in the same words."""
    for row in committed("paper_values").itertuples():
        assert paper_value_of(row).verdict(abs(row.computed), row.u) == row.verdict


def test_one_scheme_gives_all_maxima_but_those_of_the_cone():
    table = committed("paper_values")
    maxima = table[table["quantity"] == "largest relative error of the pull-off force"]
    assert maxima["scheme"].str.fullmatch(r"f\(r_max\) = 50, nothing beyond; sigma_0 = [\d.]+ as printed").all()
    by_scheme = dict(zip(maxima["printed"], maxima["scheme_verdict"], strict=True))
    assert by_scheme == {
        "65.0": "differs",
        "5.8": "differs",
        **dict.fromkeys(("21.2", "3.5", "15.9", "1.7", "0.73", "6.7"), "agrees"),
    }
    text = " ".join((ROOT / "docs" / "results.md").read_text(encoding="utf-8").split())
    cone = maxima[maxima["n"] == 1.0]
    for row in cone.itertuples():
        assert f"{abs(row.by_scheme):.2f} % for {row.printed} %" in text


def test_one_grid_gives_all_numbers_of_the_change_by_the_gradient():
    table = committed("paper_values")
    rows = table[table["scheme"] == GRID]
    assert len(rows) == 8
    assert set(rows["scheme_verdict"]) == {"agrees"}
    assert [first_or_last_step(end, first=i % 2 == 0) for i, end in enumerate(insensitive_regions(LAST_K))] == [
        0.974,
        1.056,
        3.335,
        6.219,
    ]


def test_the_committed_texts_are_those_of_the_committed_table():
    texts = comparison.PAPER_VALUES.texts({"": committed("paper_values")})
    assert set(texts) == {".md", ".tex"}
    for suffix, text in texts.items():
        assert (FOLDER / f"paper_values{suffix}").read_text(encoding="utf-8") == text


@pytest.fixture(scope="module")
def stored_repetitions():
    return [
        Repeated(paper_value_of(row), row.ingredient, row.computed, row.u, row.mu, row.stated_in_paper, row.scheme)
        for row in committed("paper_values_causes").itertuples()
    ]


def test_the_committed_schemes_are_those_of_the_committed_repetitions(stored_repetitions):
    for row in committed("paper_values").itertuples():
        of_value = [again for again in stored_repetitions if again.paper_value == paper_value_of(row)]
        scheme = comparison._of_scheme(of_value)
        assert (row.scheme, row.scheme_verdict) == (scheme["scheme"], scheme["scheme_verdict"])
        if of_value:
            assert (row.computed, row.by_scheme) == (of_value[0].value, scheme["by_scheme"])
        else:
            assert np.isnan(row.by_scheme)


def test_a_number_without_a_case_equals_itself_and_another_object_of_the_same_number():
    one, same = (PaperValue("a", "b", "c", "1", n=float("nan")) for _ in range(2))
    assert one == same
    assert hash(one) == hash(same)
    assert one != PaperValue("a", "b", "c", "2")


def paper_value_of(row):
    """The paper value of a row of a committed table."""
    (found,) = [
        paper_value
        for paper_value in paper_values()
        if (paper_value.quantity, paper_value.model, paper_value.text) == (row.quantity, row.model, row.printed)
        and np.array_equal([paper_value.n, paper_value.k], [row.n, row.k], equal_nan=True)
    ]
    return found


def test_the_verdicts_of_the_repetitions_are_those_on_their_values():
    for row in committed("paper_values_causes").itertuples():
        assert paper_value_of(row).verdict(abs(row.computed), row.u) == row.verdict


def test_the_steps_beyond_the_printed_ends_are_outside():
    inside = [largest_chi(n, LAST_K)[0] for n in (0.974, 1.056, 3.335, 6.219)]
    outside = [largest_chi(n, LAST_K)[0] for n in (0.973, 1.057, 3.334, 6.220)]
    assert max(inside) <= 0.1 < min(outside)
