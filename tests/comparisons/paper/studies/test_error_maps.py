"""Errors of the closed forms over their range: the grid, its bands and its rates."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.paper.cache import CachedCall
from comparisons.paper.paper_figure import results_by
from comparisons.paper.studies import error_maps
from comparisons.paper.studies.error_bands import bands, coefficients, rates
from comparisons.paper.studies.error_grid import CANDIDATES, ONSET_EXCESS, errors, errors_at
from comparisons.paper.studies.error_lines import MAPPED, errors_along
from comparisons.paper.tasks import quantity

BASELINE = Path(__file__).parents[4] / "results" / "baseline" / "paper"


@pytest.fixture(scope="module")
def few(made_of):
    """Errors in three cases."""
    cases = [(1.0, 0.4, 0.01), (2.0, 0.4, 1.0), (2.0, 0.0, 5.0)]
    calls = {CachedCall.of(errors_at, *case): CachedCall.of(errors_at, *case) for case in cases}
    found = made_of(lambda: results_by(calls))
    return errors(found, cases, CANDIDATES).set_index(["quantity", "model", "n", "mu"])


def test_errors_are_relative_to_known_forces(few):
    """FSCM: 1.78848171, known independently; improved M-D: 1.78527591."""
    row = few.loc[("pull_off_force", "md-improved", 2.0, 1.0)]
    assert row["kappa"] == pytest.approx(1.78527591 / 1.78848171 - 1.0, abs=1e-8)
    assert 0.0 < row["u_kappa"] < 1e-8
    # Nearly rigid: Bradley is right, and the original M-D is off by 65.0 % (Section 4.3.2).
    assert abs(few.loc[("pull_off_force", "bradley", 1.0, 0.01), "kappa"]) < 5e-3
    assert few.loc[("pull_off_force", "md-original", 1.0, 0.01), "kappa"] == pytest.approx(-0.65, abs=5e-3)
    # JKR is right for soft solids, at Tabor number 5 to a few per cent.
    assert 1e-4 < abs(few.loc[("jump_out_displacement", "jkr", 2.0, 5.0), "kappa"]) < 0.05
    # A jump that is not there has no error.
    row = few.loc[("jump_in_displacement", "semi-rigid", 1.0, 0.01)]
    assert np.isnan(row["kappa"])
    assert "no jump" in row["reason"]


def test_the_references_of_the_maps_are_those_of_the_solver(made_of):
    table = made_of(lambda: errors_along([(2.0, 0.0)], list(MAPPED)))
    assert set(zip(table["quantity"], table["model"], strict=True)) == {
        (name, model) for name, models in MAPPED.items() for model in models
    }
    for name in MAPPED:
        row = table[table["quantity"] == name].iloc[-4]
        solved = quantity("fscm", name, 2.0, 0.0, row["mu"])
        assert abs(row["fscm"] - solved["value"]) <= row["u_fscm"] + solved["u_num"]
        candidate = quantity(row["model"], name, 2.0, 0.0, row["mu"])["value"]
        assert row["kappa"] == pytest.approx((candidate - solved["value"]) / abs(solved["value"]), abs=1e-5)
        assert 0.0 < row["u_kappa"] < 1e-4


def test_the_map_of_a_jump_begins_at_the_critical_tabor_number():
    """At n = 2, k = 0 that is 0.69721461: there are jumps at 0.70, and none at 0.69."""
    stored = {"": pd.read_csv(BASELINE / "error_maps_jumps.csv")}
    figure = error_maps.ERROR_MAPS_JUMPS.draw(stored)
    for title in ("semi-rigid jump-in, $k$ = 0", "JKR jump-out, $k$ = 0"):
        axes = next(axes for axes in figure.axes if axes.get_title(loc="left").endswith(title))
        (hatched,) = [part for part in axes.collections if part.get_hatch()]
        (path,) = hatched.get_paths()
        assert path.contains_point((2.0, 0.69))
        assert not path.contains_points([(2.0, 0.70), (2.0, 0.72), (2.0, 0.75)]).any()


def test_the_stored_jumps_begin_at_the_critical_tabor_number():
    jumps = pd.read_csv(BASELINE / "error_maps_jumps.csv")
    first = jumps[jumps["point"] == 0]
    assert len(first) == len(jumps.drop_duplicates(["n", "k", "model"]))
    assert (first["mu"] / first["critical"]).to_numpy() == pytest.approx(1.0 + ONSET_EXCESS, abs=1e-6)
    assert jumps["kappa"].notna().all()
    assert (jumps["mu"] > jumps["critical"]).all()
    at = first[(first["n"] == 2.0) & (first["k"] == 0.0)]
    assert at["critical"].to_numpy() == pytest.approx(0.69721461, abs=1e-8)
    # Where the jumps merge the full model has one displacement for both.
    assert np.ptp(at["fscm"]) < 1e-4


def table_of(kappa, mu=(0.1, 1.0, 10.0)):
    return pd.DataFrame({"quantity": "q", "model": "m", "n": 2.0, "k": 0.0, "mu": mu, "kappa": kappa, "u_kappa": 0.0})


def test_bands_are_bracketed_and_not_too_precise():
    found = bands(table_of([0.03, -0.003, 0.08])).set_index("limit")
    one = found.loc[0.01]
    assert one[["from_below", "from_above", "to_below", "to_above"]].tolist() == [0.1, 1.0, 1.0, 10.0]
    # 0.03 -> -0.003 passes 0.01 at 20/33 of the decade, -0.003 -> 0.08 at 13/83 of the next.
    assert one[["mu_from", "mu_to"]].tolist() == [round(10 ** (20 / 33 - 1), 2), round(10 ** (13 / 83), 1)]
    five = found.loc[0.05]
    assert five[["mu_from", "from_below", "from_above"]].tolist() == [0.1, 0.1, 0.1]
    assert five["to_below"] == 1.0
    assert found["largest_kappa"].eq(0.08).all()
    assert found["at_mu"].eq(10.0).all()


def test_two_ranges_are_two_rows_and_no_range_is_a_row_without_numbers():
    found = bands(table_of([0.0, 0.03, 0.0]))
    assert found.groupby("limit").size().to_dict() == {0.01: 2, 0.02: 2, 0.05: 1}
    # Within the limit is within, however little.
    assert bands(table_of([0.03, 0.0099, 0.08])).set_index("limit").loc[0.01, "from_above"] == 1.0
    never = bands(table_of([0.6, 0.5, 0.4]))
    assert len(never) == 3
    assert never["mu_from"].isna().all()
    # A change of sign between points beyond the limit is not a range.
    assert bands(table_of([0.2, -0.2, 0.2]))["mu_from"].isna().all()


def test_rates():
    mu = np.array([0.5, 1.0, 2.0, 4.0])
    found = rates(table_of(-0.3 * mu**-2, mu))
    assert found["mu_to"].tolist() == [2.0, 4.0]
    assert found["rate"].tolist() == pytest.approx([2.0, 2.0])
    assert rates(table_of([0.1, 0.1, -0.1, 0.1], mu))["rate"].isna().all()


def test_the_power_of_the_jump_in_is_exact_and_its_coefficient_is_not():
    """Eq. 47 at n = 2, k = 0: between mu = 5 and 10 the FSCM's coefficient is one number, below C_in."""
    rows = []
    for mu in (5.0, 10.0):
        found = quantity("fscm", "jump_in_displacement", 2.0, 0.0, mu)
        rows.append({"model": "semi-rigid", "n": 2.0, "k": 0.0, "mu": mu, "fscm": found["value"], "u_fscm": 0.0})
    table = coefficients(pd.DataFrame(rows))
    assert table["semi_rigid"].to_numpy() == pytest.approx(1.4 * (5.0 * np.pi / np.sqrt(2.0)) ** (2.0 / 7.0), rel=1e-12)
    assert table["fscm"][0] == pytest.approx(table["fscm"][1], rel=1e-3)
    assert table["excess"].between(0.04, 0.07).all()
