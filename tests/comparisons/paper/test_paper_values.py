"""The gate on published numbers: these have every digit. And that a cause is said only as computed."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.baseline import PAPER_BASELINE
from comparisons.data.paper_values import PaperValue, paper_values
from comparisons.numerics.number_text import short
from comparisons.paper.cache import CallCache
from comparisons.paper.figures.gradient_effect import insensitive_regions, largest_chi
from comparisons.paper.values import comparison
from comparisons.paper.values.causes import Repeated, frame
from comparisons.paper.values.comparison import cause, judged, readable
from comparisons.registry import create
from comparisons.runs.cases import Case

DIRECT = [number for number in paper_values() if number.name in comparison._DIRECT]


@pytest.fixture(scope="module")
def answers(tmp_path_factory):
    cache = CallCache(tmp_path_factory.mktemp("numbers") / "tasks.jsonl", "test")
    list(cache.work(map(comparison._critical, paper_values("critical_tabor_number")), 1))
    return cache.results


@pytest.mark.parametrize("claim", DIRECT, ids=lambda claim: f"{claim.name}-{claim.n}-{claim.k}")
def test_closed_forms_agree_to_every_published_digit(claim, answers):
    row = judged(claim, answers, [])
    assert (row["verdict"], row["cause"]) == ("agrees", "")
    assert row["u"] < 1e-13 * abs(row["computed"])


def test_critical_tabor_numbers_agree_to_every_published_digit(answers):
    rows = [judged(claim, answers, []) for claim in paper_values("critical_tabor_number")]
    assert [(row["published"], row["verdict"]) for row in rows] == [
        (text, "agrees") for text in ("0.70", "0.75", "0.78", "0.78")
    ]


@pytest.mark.parametrize("claim", paper_values("largest_chi"), ids=lambda claim: str(claim.n))
def test_chi_has_every_published_digit(claim):
    expected = "cut off" if claim.n == 1.5 else "agrees"
    assert claim.verdict(100 * largest_chi(claim.n)[0], 1e-11) == expected


@pytest.mark.parametrize(
    ("model", "mu", "verdict"), [("md-original", 0.246, "cut off"), ("md-improved", 0.836, "agrees")]
)
def test_largest_errors_of_the_flattest_punch_have_every_published_digit(model, mu, verdict):
    (claim,) = [c for c in paper_values("largest_relative_error") if (c.model, c.n) == (model, 5.0)]
    kappa = []
    for place in (0.9 * mu, mu, 1.1 * mu):
        force = {
            name: create(name).evaluate(Case(5.0, 0.4, place).problem(), "pull_off_force").value
            for name in (model, "fscm")
        }
        kappa.append(100 * (force[model] / force["fscm"] - 1))
    assert kappa[1] == max(kappa)
    assert claim.verdict(kappa[1], 1e-4) == verdict


CLAIM = PaperValue("largest_relative_error", "", "error", "1.7", "%", model="m", n=1.5, k=0.4)


def repeated(ingredient, value, stated=True):
    return Repeated(CLAIM, ingredient, value, 1e-6, 1.0, stated)


def test_no_cause_is_sought_where_the_digits_agree():
    assert cause([repeated("converged", -1.72), repeated("cut", -1.0)]) == ""


@pytest.mark.parametrize(
    ("others", "words"),
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
            "nothing the paper states gives it; these do: grid (1.77, cut off); cut alone gives 1.6",
        ),
        (
            [repeated("cut", -1.6), repeated("grid", -1.9, False)],
            "not reproduced; nearest is cut (1.6); cut alone gives 1.6",
        ),
    ],
)
def test_a_cause_is_an_ingredient_that_gives_the_published_digits(others, words):
    assert cause([repeated("converged", -1.8354), *others]) == words


def test_causes_tell_what_each_ingredient_shifts():
    table = frame([repeated("converged", -1.8354), repeated("cut", -1.6478)])
    assert table["shift"].to_numpy() == pytest.approx([0.0, 0.1876])
    assert table["verdict"].tolist() == ["differs", "differs"]


def test_for_reading_a_number_keeps_the_digits_its_uncertainty_leaves(answers):
    rows = [judged(claim, answers, []) for claim in paper_values("critical_tabor_number")]
    shown = readable(pd.DataFrame(rows))
    assert shown["case"].tolist()[1] == "n = 2, k = 0.2"
    assert shown["computed"].tolist()[0] == short(rows[0]["computed"], 5e-10)


def test_one_end_of_the_regions_differs():
    ends = insensitive_regions()
    verdicts = [claim.verdict(end, 1e-9) for claim, end in zip(paper_values("insensitive_region"), ends, strict=True)]
    assert verdicts == ["agrees", "cut off", "agrees", "differs"]
    # A gradient exponent that stops short of the Gibson limit moves it to the published digits, but not far short:
    # then the end before it leaves its own.
    short_of_one = [
        [claim.verdict(end, 1e-9) for claim, end in zip(paper_values("insensitive_region"), ends, strict=True)]
        for ends in (insensitive_regions(0.9995), insensitive_regions(0.999))
    ]
    assert short_of_one == [["agrees", "cut off", "agrees", "agrees"], ["agrees", "cut off", "differs", "cut off"]]


def test_the_readme_counts_the_verdicts_that_are_committed():
    root = Path(__file__).parents[3]
    counts = pd.read_csv(root / PAPER_BASELINE / "paper_values.csv")["verdict"].value_counts().to_dict()
    assert counts == {"agrees": 24, "cut off": 4, "differs": 6}
    readme = (root / "README.md").read_text()
    assert "Of 34 numbers 24 agree to the printed digits, and four more if the paper cut digits off" in readme
    assert "Six differ.\nFour of these" in readme


@pytest.mark.parametrize("name", ["paper_values", "paper_values_causes"])
def test_the_verdicts_committed_are_those_on_the_values_committed(name):
    table = pd.read_csv(Path(__file__).parents[3] / PAPER_BASELINE / f"{name}.csv", dtype={"published": str})
    for row in table.fillna({"model": ""}).itertuples():
        (claim,) = [
            claim
            for claim in paper_values()
            if (claim.quantity, claim.model, claim.text) == (row.quantity, row.model, row.published)
            and np.array_equal([claim.n, claim.k], [row.n, row.k], equal_nan=True)
        ]
        assert claim.verdict(abs(row.computed), row.u) == row.verdict
