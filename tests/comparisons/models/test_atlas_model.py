"""The model `atlas`: results, bounds, and what it refuses."""

import pytest

import fscm
from comparisons.model import NotApplicable
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES
from comparisons.registry import create


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_result_is_that_of_the_function(quantity):
    result = create("atlas").evaluate(Problem.dimensionless(n=2.5, k=0.3, mu=2.0), quantity)
    assert (result.value, result.u_num) == fscm.atlas(2.5, 0.3, 2.0, quantity)


@pytest.mark.parametrize(
    ("n", "k", "mu", "quantity", "reason"),
    [
        (0.9, 0.4, 1, "pull_off_force", r"n = 0.9 is outside \[1, 6\]"),
        (2, 0.81, 1, "pull_off_force", r"k = 0.81 is outside \[0, 0.8\]"),
        (2, 0.4, 11, "pull_off_force", r"mu = 11 is outside \[0.01, 10\]"),
        (2, 0, 0.3, "jump_in_gap", "critical Tabor number 0.69"),
        (2, 0, 1, "contact_radius", "does not contain contact_radius"),
    ],
)
def test_outside_its_box_and_its_quantities_it_is_not_applicable(n, k, mu, quantity, reason):
    with pytest.raises(NotApplicable, match=reason):
        create("atlas").evaluate(Problem.dimensionless(n=n, k=k, mu=mu), quantity)
