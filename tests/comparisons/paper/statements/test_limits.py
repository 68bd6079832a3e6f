"""Limits of sequences: extrapolated exactly where they are powers, and told from what stays."""

import pytest

from comparisons.paper.statements.evidence import FAILS, HOLDS, READING, UNDECIDED, Number
from comparisons.paper.statements.limits import extrapolated, vanishes


def sequence(function, u=0.0):
    return [Number(function(mu), u, f"mu = {mu}") for mu in (10.0, 20.0, 40.0)]


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("end", [-0.2, 0.0, 0.3])
def test_a_power_has_its_limit(power, end):
    found = extrapolated(*sequence(lambda mu: end + 0.7 * mu**-power))
    assert found.value == pytest.approx(end, abs=1e-14)
    assert found.u == 0.0


def test_the_bound_is_that_of_the_members():
    members = sequence(lambda mu: 0.3 + 1.0 / mu)
    limit = extrapolated(*members).value
    step, expected = 1e-7, 0.0
    for i, member in enumerate(members):
        moved = [*members[:i], Number(member.value + step, 0.0, ""), *members[i + 1 :]]
        expected += abs(extrapolated(*moved).value - limit) / step * 1e-9
    with_bounds = [Number(member.value, 1e-9, "") for member in members]
    assert extrapolated(*with_bounds).u == pytest.approx(expected, rel=1e-4)


def test_members_on_a_line_have_the_last_one_as_limit():
    assert extrapolated(*sequence(lambda mu: 0.25)).value == 0.25


@pytest.mark.parametrize(
    ("function", "outcome"),
    [
        (lambda mu: -3.0 / mu, HOLDS),
        (lambda mu: 0.05 + 3.0 / mu, FAILS),
        # It passes through zero and grows again.
        (lambda mu: 0.1 - 3.0 / mu, FAILS),
        (lambda mu: 0.05, FAILS),
        (lambda mu: mu / 100.0, FAILS),
    ],
)
def test_only_what_falls_to_zero_vanishes(function, outcome):
    outcomes = {row.outcome for row in vanishes("n = 2", sequence(function), Number(1e-3, 0.0, READING))}
    assert (outcomes == {HOLDS}) == (outcome == HOLDS)
    assert (FAILS in outcomes) == (outcome == FAILS)


def test_wide_bounds_decide_nothing():
    rows = vanishes("n = 2", sequence(lambda mu: 3.0 / mu, u=1.0), Number(1e-3, 0.0, READING))
    assert {row.outcome for row in rows} == {UNDECIDED}
