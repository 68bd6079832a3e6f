"""The study of solids that are no power law: both references, and the simpler solids beside them."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.description.equivalent_power_law import equivalent_power_law
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.studies.graded_equivalent import equivalent_of
from comparisons.paper.studies.graded_routes import OFFSET, by_elements, by_fscm, case_of, of_power_law
from comparisons.paper.studies.graded_solids import SERIES
from comparisons.problem import Problem, Section
from comparisons.runs.tasks import evaluate

TABLE = pd.read_csv(Path(__file__).parents[4] / PAPER_BASELINE / "graded_solids.csv")
CASES = [(kind, parameter) for kind, (parameters, _) in SERIES.items() for parameter in parameters]

#: Sum of the bounds over the largest value of a quantity: measured 2.6e-5 (displacement at pull-off, offset 0.1).
LARGEST_BOUND = 3e-5

#: Distance of k and mu from those of a power law with an offset of 1e-6 L: see the test for how it falls.
LARGEST_OFFSET = 3e-4


def rows(kind, parameter):
    found = TABLE[(TABLE["solid"] == kind) & np.isclose(TABLE["parameter"], parameter, rtol=1e-12)]
    return found.set_index("quantity")


def assert_stored(stored, found, column):
    """Both are within their bounds of one value."""
    for name, number in found.items():
        if name in stored.index and not isinstance(number, str):
            value, u_num = number
            assert abs(value - stored.loc[name, column]) <= u_num + stored.loc[name, f"u_{column}"]


def test_both_references_agree_within_their_bounds():
    apart = (TABLE["fscm"] - TABLE["fem"]).abs()
    known = TABLE["fem"].notna()
    assert (apart[known] <= (TABLE["u_fscm"] + TABLE["u_fem"])[known]).all()
    for name, part in TABLE[known].groupby("quantity"):
        assert (part["u_fscm"] + part["u_fem"]).max() < LARGEST_BOUND * part["fscm"].abs().max(), name


@pytest.mark.heavy
def test_a_point_is_computed_again_by_the_finite_elements():
    assert_stored(rows("coating", 1.0), by_elements("pull-off", "coating", 1.0), "fem")


@pytest.mark.heavy
@pytest.mark.parametrize(("kind", "parameter"), CASES)
def test_every_point_is_computed_again_by_the_fscm(kind, parameter):
    assert_stored(rows(kind, parameter), by_fscm(kind, parameter), "fscm")


@pytest.mark.heavy
def test_the_equivalent_power_law_of_a_power_law_is_itself():
    """The skin changes the compliance at the contact radius by its share, z_s^(1-k)."""
    apart = [max(np.abs(np.subtract(equivalent_of("offset power law", z_s), OFFSET))) for z_s in (1e-4, 1e-6)]
    assert apart[1] < min(LARGEST_OFFSET, apart[0] / 3.0)


@pytest.mark.parametrize("kind", [pytest.param("exponential", marks=pytest.mark.heavy), "coating"])
def test_the_equivalent_power_law_of_a_thin_layer_is_that_of_the_depth(kind):
    """What is left is the share of the depth in the lengths of the contact."""
    assert equivalent_of(kind, 1e-6) == pytest.approx(case_of(kind, 1e-6).depth, abs=1e-5)


def test_the_equivalent_power_laws_are_those_of_the_rule_of_a_problem_file():
    """A file with the numbers of a case, by the command that describes it."""
    case = case_of("exponential", 2.0)
    law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.7, "z0": 0.25})
    problem = Problem(case.section, Section("sphere", {"R": 2.0}), law)
    found = equivalent_power_law(problem, evaluate("fscm", "pull_off_force", problem))
    posed = found.problem.posed
    stored = rows("exponential", 2.0).loc["pull_off_force"]
    # Six digits are stored.
    assert (posed.k, posed.mu) == pytest.approx((stored["power_law_k"], stored["power_law_mu"]), abs=2e-6)
    assert found.error == pytest.approx(stored["power_law_error"], abs=2e-6)


def test_errors_are_those_of_the_columns_and_a_missing_jump_has_a_reason():
    assert (TABLE["fscm"].isna() == TABLE["reason"].notna()).all()
    for other in ("surface", "depth", "power_law"):
        error = (TABLE[other] - TABLE["fscm"]) / TABLE["fscm"].abs()
        assert TABLE[f"{other}_error"].to_numpy() == pytest.approx(error.to_numpy(), nan_ok=True)
    row = rows("exponential", 2.0).iloc[0]
    value, u_num = of_power_law(row["power_law_k"], row["power_law_mu"])["pull_off_force"]
    assert abs(value - row["power_law"]) <= 2.0 * u_num
