"""Numbers printed in the paper: complete, and formulas judged as formulas."""

import pytest

from comparisons.data.paper_values import PaperValue


@pytest.mark.parametrize(
    ("computed", "u", "verdict"),
    [(8 / 3, 0.0, "agrees"), (2.6666667, 0.0, "differs"), (2.6666667, 1e-7, "agrees"), (2.67, 1e-7, "differs")],
)
def test_a_formula_has_no_last_digit_to_be_generous_with(computed, u, verdict):
    assert PaperValue("", "", "", "8/3", exact=8 / 3).verdict(computed, u) == verdict


@pytest.mark.parametrize(
    ("text", "computed"),
    [("40.8", 40.8855), ("1.056", 1.05661), ("3.5", 3.562), ("15.9", 15.9506), ("4.4", 4.499), ("2.880", 2.8809)],
)
def test_truncated_digits_are_distinguished_from_rounded_ones(text, computed):
    printed = PaperValue("", "", "", text)
    step = 10.0 ** -len(text.partition(".")[2])
    assert printed.verdict(computed, 1e-9) == "agrees if truncated"
    assert printed.verdict(printed.value + 0.49 * step, 1e-9) == "agrees"
    assert printed.verdict(printed.value - 0.49 * step, 1e-9) == "agrees"
    # Numbers are not truncated upwards.
    assert printed.verdict(printed.value - 0.51 * step, 1e-9) == "differs"
    assert printed.verdict(printed.value + 1.01 * step, 1e-9) == "differs"


@pytest.mark.parametrize(("computed", "u"), [(3.45, 1e-6), (3.55, 1e-6), (3.6, 1e-6), (9.0, 100.0)])
def test_a_bound_that_reaches_over_a_border_decides_nothing(computed, u):
    assert PaperValue("", "", "", "3.5").verdict(computed, u) == "undecided"
