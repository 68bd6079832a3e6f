"""Layered solids against the literature: the limit of large Tabor numbers, and the committed verdicts."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.studies.coated_jkr import coated_pull_off
from comparisons.paper.studies.layered_adhesion import TABOR_NUMBERS, coated_force, extrapolated, layer_compliance

TABLE = pd.read_csv(Path(__file__).parents[4] / PAPER_BASELINE / "layered_adhesion.csv")

#: Relative bound of a limit in the Tabor number: measured 4.6e-6 (substrate 100 times as stiff).
LIMIT_BOUND = 5e-6
#: The thin coating is a limit in the thickness as well: measured 3.5e-4.
THIN_BOUND = 1e-3


def forces(ratio, thickness):
    return [tuple(coated_force(ratio, thickness, mu)) for mu in TABOR_NUMBERS]


def test_everything_agrees_and_the_bounds_are_small():
    assert (TABLE["agreement"] == "agrees").all()
    bound = (TABLE["u_expected"] + TABLE["u_found"]) / TABLE["expected"]
    assert bound[TABLE["check"] != "thin coating"].max() < LIMIT_BOUND
    assert bound.max() < THIN_BOUND


def test_the_expected_values_are_computed_again():
    rows = TABLE[TABLE["check"] == "coated JKR"]
    assert len(rows) == 3
    for row in rows.itertuples():
        expected = coated_pull_off(row.modulus_ratio, row.thickness, 0.3, 0.3)
        assert row.expected == pytest.approx(expected["force"], abs=expected["u_num"])


@pytest.mark.heavy
def test_a_homogeneous_solid_approaches_jkr():
    value, u_num = extrapolated(TABOR_NUMBERS, forces(1.0, 0.5))
    assert abs(value - 1.5) <= u_num < LIMIT_BOUND


@pytest.mark.heavy
@pytest.mark.parametrize("index", range(3))
def test_a_coated_solid_approaches_its_own_limit(index):
    row = TABLE[TABLE["check"] == "coated JKR"].iloc[index]
    value, u_num = extrapolated(TABOR_NUMBERS, forces(row["modulus_ratio"], row["thickness"]))
    assert value == pytest.approx(row["found"], abs=u_num)
    # A coating that is one in a thousand thicker is told apart.
    other = coated_pull_off(row["modulus_ratio"], 1.001 * row["thickness"], 0.3, 0.3)["force"]
    assert abs(value - row["expected"]) <= u_num < abs(value - other)


def test_the_bound_of_the_limit_covers_a_neglected_term_and_the_bounds_of_the_forces():
    mu = np.array(TABOR_NUMBERS)
    value, u_num = extrapolated(mu, [(x, 1e-9) for x in 1.5 + np.log(mu) / mu**2 + (np.log(mu) / mu**2) ** 2])
    assert 1e-9 < abs(value - 1.5) <= u_num
    assert 1e-6 < extrapolated(mu, [(1.5 + x**-2, 1e-6) for x in mu])[1] < 1e-5


def test_the_compliance_of_another_layer_is_not_that_published():
    row = TABLE[TABLE["check"] == "compliance"].iloc[0]
    assert layer_compliance(row["thickness"], row["modulus_ratio"], 0.3, 0.3) == pytest.approx(row["expected"])
    assert layer_compliance(row["thickness"], row["modulus_ratio"], 0.3, 0.31) != pytest.approx(row["expected"])
