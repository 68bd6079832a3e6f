"""Verdicts on paper values, and the causes of the differences."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.data.paper_values import PaperValue, paper_values
from comparisons.numerics.number_text import short
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.cache import CallCache
from comparisons.paper.figures.fig11_gradient_effect import insensitive_regions, largest_chi
from comparisons.paper.studies.tabor_curve import TaborCurve, tabor_numbers
from comparisons.paper.values import comparison
from comparisons.paper.values.causes import Repeated, frame
from comparisons.paper.values.comparison import BY_GRID, BY_SCHEME, cause, explained, judged, readable
from comparisons.paper.values.sampling import LAST_K, first_or_last_step, jin_start, rounding_starts, without_place
from comparisons.registry import create
from comparisons.runs.cases import Case

FOLDER = Path(__file__).parents[3] / PAPER_BASELINE
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
    assert (row["verdict"], row["cause"]) == ("agrees", "")
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


def test_no_cause_is_sought_where_the_digits_agree():
    assert cause([repeated("converged", -1.72), repeated("cut", -1.0)]) == ""


@pytest.mark.parametrize(
    ("others", "expected"),
    [
        ([repeated("cut", -1.71), repeated("grid", 1.72, False)], "reproduced by cut (1.71)"),
        (
            [repeated("cut", -9.0), repeated("rounded", -1.71)],
            "reproduced by rounded (1.71); cut alone gives 9",
        ),
        ([repeated("cut", -1.6), repeated("cut; rounded", -1.66)], "reproduced by cut; rounded (1.66)"),
        (
            [repeated("cut", -1.6), repeated("grid", -1.7, False)],
            "nothing the paper states gives it; these do: grid (1.7); cut alone gives 1.6",
        ),
        (
            [repeated("cut", -1.6), repeated("grid", -1.77, False)],
            "nothing the paper states gives it; these do: grid (1.77, agrees if truncated); cut alone gives 1.6",
        ),
        (
            [repeated("cut", -1.6), repeated("grid", -1.9, False)],
            "not reproduced; nearest is cut (1.6); cut alone gives 1.6",
        ),
    ],
)
def test_a_cause_is_an_ingredient_that_gives_the_printed_digits(others, expected):
    assert cause([repeated("converged", -1.8354), *others]) == expected


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
    return pd.read_csv(FOLDER / f"{name}.csv", dtype={"printed": str}).fillna({"model": "", "unit": "", "cause": ""})


def test_the_committed_verdicts_are_counted():
    counts = committed("paper_values")["verdict"].value_counts().to_dict()
    assert counts == {"agrees": 24, BY_SCHEME: 6, BY_GRID: 4}


def test_the_committed_texts_are_those_of_the_committed_table():
    texts = comparison.PAPER_VALUES.texts({"": committed("paper_values")})
    assert set(texts) == {".md", ".tex"}
    for suffix, text in texts.items():
        assert (FOLDER / f"paper_values{suffix}").read_text(encoding="utf-8") == text


@pytest.fixture(scope="module")
def stored_repetitions():
    return [
        Repeated(paper_value_of(row), row.ingredient, row.computed, row.u, row.mu, row.stated_in_paper)
        for row in committed("paper_values_causes").itertuples()
    ]


def test_the_committed_verdicts_and_causes_follow_from_the_committed_repetitions(stored_repetitions):
    for row in committed("paper_values").itertuples():
        paper_value = paper_value_of(row)
        of_value = [again for again in stored_repetitions if again.paper_value == paper_value]
        companions = [again for again in stored_repetitions if comparison._same_shape(again.paper_value, paper_value)]
        assert (cause(of_value, companions) if of_value else "") == row.cause
        plain = paper_value.verdict(abs(row.computed), row.u)
        assert (explained(of_value) if of_value else plain) == row.verdict
        assert of_value == [] or of_value[0].verdict == plain


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


@pytest.mark.parametrize(
    ("others", "expected"),
    [
        ([repeated("cut", -1.71)], BY_SCHEME),
        ([repeated("grid", -1.71, False)], BY_GRID),
        ([repeated("grid", -1.71, False), repeated("cut", -1.71)], BY_SCHEME),
        ([repeated("grid", -1.77, False), repeated("cut", -1.9)], "differs"),
    ],
)
def test_a_verdict_names_what_gives_the_printed_digits(others, expected):
    assert explained([repeated("converged", -1.8354), *others]) == expected
    assert explained([repeated("converged", -1.7), *others]) == "agrees"


def test_an_unstated_ingredient_that_contradicts_another_number_is_no_cause():
    other = replace(PRINTED, model="other", text="5.8")
    rows = [repeated("converged", -1.8354), repeated("far", -1.7, False), repeated("start", -1.71, False)]
    companions = [Repeated(other, "far", 6.02, 1e-6, 1.0, False), Repeated(other, "start", 5.81, 1e-6, 1.0, False)]
    assert cause(rows, companions) == (
        "nothing the paper states gives it; these do: start (1.71); not far (1.7), which gives 6.02 for the printed 5.8"
    )


def test_all_eight_numbers_of_one_figure_follow_from_one_grid(stored_repetitions):
    """The same gradient exponents and steps for the maxima of chi and for the ends of its regions."""
    rows = [row for row in stored_repetitions if row.ingredient == "k up to 0.999, n in steps of 0.001"]
    assert len(rows) == 8
    assert {row.verdict for row in rows} == {"agrees"}
    assert [first_or_last_step(end, first=i % 2 == 0) for i, end in enumerate(insensitive_regions(LAST_K))] == [
        0.974,
        1.056,
        3.335,
        6.219,
    ]


def test_the_steps_beyond_the_printed_ends_are_outside():
    inside = [largest_chi(n, LAST_K)[0] for n in (0.974, 1.056, 3.335, 6.219)]
    outside = [largest_chi(n, LAST_K)[0] for n in (0.973, 1.057, 3.334, 6.220)]
    assert max(inside) <= 0.1 < min(outside)


ONE = TaborCurve.through(np.ones(41))


def curve_of(function):
    return TaborCurve.through(function(np.log(np.array(tabor_numbers(40)))))


def test_smallest_tabor_numbers_that_round_to_a_printed_error():
    falling = curve_of(lambda x: 1.0 + 0.02 * np.exp(-0.1 * (x - np.log(0.01))))
    low, high = rounding_starts(PRINTED, falling, ONE)
    for mu, inside in ((low, True), (high, True), (low - 1e-4, False), (high + 1e-4, False)):
        assert (abs(100.0 * (falling(np.array([mu]))[0] - 1.0) - 1.7) < 0.05) == inside
    hump = curve_of(lambda x: 1.0 + 0.02 * np.exp(-((x + 1.0) ** 2)))
    assert rounding_starts(PRINTED, hump, ONE) is None


def test_an_interval_whose_points_exceed_a_printed_error():
    hump = curve_of(lambda x: 1.0 + 0.0176 / (1.0 + (x + 1.0) ** 2 / 20.0))
    low, high, found = without_place(PRINTED, hump, ONE)
    assert low < np.exp(-1.0) < high
    assert PRINTED.verdict(100.0 * found.kappa, 100.0 * found.u) == "agrees"
    inner = np.geomspace(1.002 * low, high / 1.002, 99)
    assert (100.0 * (hump(inner) - 1.0) > 1.7495).all()
    assert without_place(PRINTED, ONE, ONE) is None


def test_the_start_of_jin_explains_an_error_only_with_the_printed_stress(stored_repetitions):
    rows = {row.ingredient: row.verdict for row in stored_repetitions if row.paper_value.text == "65.0"}
    jin = f"smallest mu = {jin_start(1.0, 0.4):.4f} (mu_Jin = 0.01 at nu = 0.3)"
    assert rows[jin] == "agrees if truncated"
    assert rows[f"sigma_0 = 1.026 as printed; {jin}"] == "agrees"
