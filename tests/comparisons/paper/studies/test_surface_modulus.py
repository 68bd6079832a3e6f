"""The study of the surface modulus: its limits, its tables, and the depth that the mesh must reach."""

import math
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest
from scipy.special import beta

import fem_reference._contact.mesh_lengths
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.studies.graded_routes import by_elements, by_fscm, case_of
from comparisons.paper.studies.surface_modulus import limits, thresholds
from comparisons.paper.tasks import quantity
from fem_reference._contact.mesh_lengths import EXTERIOR_ERROR

TABLES = {
    name: pd.read_csv(Path(__file__).parents[4] / PAPER_BASELINE / f"surface_modulus{name}.csv")
    for name in ("", "_limits", "_thresholds")
}


def with_skin(event, *place):
    k, mu, depth = place
    return by_elements(event, "offset power law", depth, k, mu)


def response_factor(k: float, nu: float) -> float:
    """Eq. 7."""
    q = math.sqrt((1 + k) * (1 - k * nu / (1 - nu)))
    factor = 2 ** (k + 1) * (k + 2) * q * math.sin(q * math.pi / 2) / (k * (k + 1) * beta(k / 2, 0.5))
    return factor * beta((3 + k + q) / 2, (3 + k - q) / 2)


@pytest.mark.parametrize(("k", "mu", "depth"), [(0.4, 1.0, 0.3), (0.6, 2.0, 100.0)])
def test_tabor_number_of_the_uniform_solid(k, mu, depth):
    """Eq. 29 for both solids, divided: every scale but z_s / L drops out."""
    ratio = depth**-k * (1 - k) / response_factor(k, 0.3)
    assert case_of("offset power law", depth, k, mu).mu == pytest.approx((mu ** ((3 + k) / 2) * ratio) ** (2 / 3))


@pytest.mark.heavy
def test_an_offset_does_nothing_to_a_uniform_solid():
    found = with_skin("pull-off", 0.0, 1.0, 30.0)
    for name in ("pull_off_force", "pull_off_displacement"):
        value, u_num = found[name]
        # Measured 8e-6, nearly all of it what half the extent changes.
        assert abs(value - quantity("fscm", name, 2.0, 0.0, 1.0)["value"]) <= u_num < 1e-5


def test_both_references_agree_within_their_bounds():
    table = TABLES[""]
    assert (table["value"].isna() == table["fscm_value"].isna()).all()
    assert (table["value"].isna() == table["reason"].notna()).all()
    known = table.dropna(subset="value")
    assert ((known["value"] - known["fscm_value"]).abs() <= known["u_num"] + known["u_fscm"]).all()
    assert len(known) > 100


def test_the_committed_limits_and_thresholds_are_those_of_the_committed_values():
    for name, function in (("_limits", limits), ("_thresholds", thresholds)):
        pd.testing.assert_frame_equal(function(TABLES[""]), TABLES[name], rtol=1e-6, check_dtype=False)


@pytest.mark.heavy
def test_a_thick_skin_is_a_uniform_solid_and_is_computed_again_by_the_fscm():
    """What is left, at 1000 L, is the share of the contact radius in the offset."""
    value, u_num = with_skin("pull-off", 0.4, 1.0, 1000.0)["pull_off_force"]
    uniform = case_of("offset power law", 1000.0, 0.4, 1.0).mu
    # The solid is a little stiffer than its surface, so nearer to Bradley's.
    assert 1e-5 < value - quantity("fscm", "pull_off_force", 2.0, 0.0, uniform)["value"] < 5e-5
    again, u_again = by_fscm("offset power law", 1000.0, 0.4, 1.0)["pull_off_force"]
    assert abs(value - again) <= u_num + u_again < 1e-6


def test_without_jumps_there_is_a_reason():
    found = with_skin("jump-out", 0.4, 1.0, 3.0)
    assert {"too stiff" in reason for reason in found.values()} == {True}


@pytest.mark.heavy
def test_the_result_does_not_depend_on_where_the_exterior_begins(monkeypatch):
    value, u_num = with_skin("pull-off", 0.4, 1.0, 100.0)["pull_off_displacement"]

    def without_bound(problem, names, accuracy):
        surface = fem_reference.profile(problem, "pull_off", accuracy)
        values = {"pull_off_force": -surface.load, "pull_off_displacement": surface.displacement}
        return {name: SimpleNamespace(value=values[name], u_num=0.0) for name in names}

    monkeypatch.setattr(fem_reference, "solve_together", without_bound)
    found = []
    for error in (1e-2, 0.1 * EXTERIOR_ERROR):
        monkeypatch.setattr(fem_reference._contact.mesh_lengths, "EXTERIOR_ERROR", error)
        found.append(with_skin("pull-off", 0.4, 1.0, 100.0)["pull_off_displacement"][0])
    too_near, farther = found
    assert abs(value - farther) < 0.2 * u_num
    # A power law that takes over where there is none yet shows.
    assert abs(too_near - value) > 100.0 * abs(value - farther)


def series(depths=(1e-3, 1e-2, 0.1, 10.0, 100.0), u_num=1e-9):
    """A quantity that leaves its graded limit 2 as z_s^0.6 and approaches the uniform 3 as 1 / z_s."""
    rows = [
        {"depth": depth, "value": 2.0 + depth**0.6 if depth < 1 else 3.0 + 1.0 / depth}
        | {"homogeneous_value": 3.0 if depth > 1 else math.nan}
        for depth in depths
    ]
    bounds = dict.fromkeys(("u_num", "graded_u_num", "homogeneous_u_num"), u_num)
    return pd.DataFrame(rows).assign(k=0.4, mu=1.0, quantity="pull_off_force", graded_value=2.0, **bounds)


def test_rates_of_both_limits():
    table = limits(series()).set_index(["limit", "depth"])
    assert table.loc[("graded", 1e-3), ["rate", "expected"]].tolist() == [pytest.approx(0.6), 0.6]
    assert table.loc[("homogeneous", 100.0), "rate"] == pytest.approx(1.0)
    assert math.isnan(table.loc[("homogeneous", 10.0), "rate"])
    # No rate is read off a difference that is not resolved.
    assert limits(series(u_num=0.1))["rate"].isna().all()
    # A jump that ends before its solid is uniform has no such limit.
    ended = series()
    ended.loc[4, "value"] = math.nan
    assert set(limits(ended)["limit"]) == {"graded"}


def test_depths_that_change_a_quantity():
    table = thresholds(series()).set_index("change")
    assert table.loc[0.01, ["below", "above"]].tolist() == [1e-3, 1e-2]
    assert table.loc[0.01, "depth"] == pytest.approx(0.02 ** (1 / 0.6), rel=0.03)
    assert table.loc[0.05, "depth"] == pytest.approx(0.1 ** (1 / 0.6), rel=0.03)
    # Below the thinnest skin by the law of thin skins; the change of 13 % there is too far from 1 %.
    table = thresholds(series((0.1, 10.0))).set_index("change")
    assert table.loc[0.05, ["below", "above"]].tolist() == [0.0, 0.1]
    assert table.loc[0.05, "depth"] == pytest.approx(0.1 ** (1 / 0.6), rel=0.03)
    assert math.isnan(table.loc[0.01, "depth"])
    assert thresholds(series().assign(value=math.nan)).empty
