"""Errors of the closed forms over their range: the grid, its bands and its rates."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.models.bradley import rigid_pull_off
from comparisons.paper.cache import CachedCall, CallCache
from comparisons.paper.studies.error_bands import bands, coefficients, rates
from comparisons.paper.studies.error_grid import (
    CANDIDATES,
    TABOR,
    all_cases,
    errors,
    errors_at,
    onset_calls,
    onset_errors,
    tasks,
)
from comparisons.paper.studies.error_maps import ERROR_MAPS_JUMPS, from_onset, lattice
from comparisons.paper.tasks import quantity

BASELINE = Path(__file__).parents[4] / "results" / "baseline" / "paper"


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    """Results of three cases."""
    cases = [(1.0, 0.4, 0.01), (2.0, 0.4, 1.0), (2.0, 0.0, 5.0)]
    cache = CallCache(tmp_path_factory.mktemp("grid") / "tasks.jsonl", "test")
    list(cache.work(tasks(cases), 1))
    return errors(cache.results, cases, CANDIDATES).set_index(["quantity", "model", "n", "mu"])


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


def test_a_jump_that_is_not_there_has_no_error(few):
    row = few.loc[("jump_in_displacement", "semi-rigid", 1.0, 0.01)]
    assert np.isnan(row["kappa"])
    assert "no jump" in row["reason"]


def test_dmt_has_the_force_of_bradley():
    """Its cohesive stress is chosen so that it has Bradley's pull-off force (Eq. 74)."""
    for n in (0.8, 1.5, 8.0):
        assert quantity("dmt", "pull_off_force", n, 0.4, 1.0)["value"] == pytest.approx(
            rigid_pull_off(n).value, rel=1e-12
        )


def test_the_maps_share_their_calls():
    assert len(set(all_cases())) == len(all_cases())
    needed = set(ERROR_MAPS_JUMPS.tasks())
    assert {call.arguments for call in needed if call.function.endswith(":errors_at")} == set(all_cases())
    assert needed >= set(onset_calls(all_cases()))
    assert CachedCall.of(errors_at, 2.0, 0.4, TABOR[0]) in ERROR_MAPS_JUMPS.tasks()


def test_the_map_is_where_it_is_labelled():
    table = pd.DataFrame({"k": [0.0, 0.4, 0.0], "mu": [2.0, 2.0, 0.5], "kappa": [0.01, 0.02, -0.03]})
    k, mu, kappa = lattice(table, "k")
    assert (k.tolist(), mu.tolist()) == ([0.0, 0.4], [0.5, 2.0])
    assert kappa[0, 0] == -3.0
    assert np.isnan(kappa[0, 1])
    assert kappa[1].tolist() == [1.0, 2.0]


def test_the_map_of_a_jump_begins_at_the_critical_tabor_number():
    """At n = 2, k = 0 that is 0.69721461: at 0.72 and 0.75 there are jumps, whatever Tabor numbers are computed."""
    stored = {
        name: pd.read_csv(BASELINE / f"error_maps_jumps{suffix}.csv")
        for name, suffix in (("", ""), ("onset", "_onset"))
    }
    at = [table[(table["k"] == 0.0) & (table["model"] == "jkr")] for table in stored.values()]
    n, mu, kappa, critical = from_onset(*at, "n")
    where = n.tolist().index(2.0)
    assert critical[where] == pytest.approx(0.69721461, abs=1e-8)
    assert mu[:, where].tolist() == [*[critical[where]] * 7, *TABOR[7:]]
    assert np.isfinite(kappa[:, where]).all()
    figure = ERROR_MAPS_JUMPS.draw(stored)
    for title in ("semi-rigid jump-in, $k$ = 0", "JKR jump-out, $k$ = 0"):
        axes = next(axes for axes in figure.axes if axes.get_title(loc="left").endswith(title))
        (hatched,) = [part for part in axes.collections if part.get_hatch()]
        (path,) = hatched.get_paths()
        assert path.contains_point((2.0, 0.69))
        assert not path.contains_points([(2.0, 0.70), (2.0, 0.72), (2.0, 0.75)]).any()


def test_the_stored_jumps_begin_at_the_stored_critical_tabor_number():
    jumps, onset = (pd.read_csv(BASELINE / f"error_maps_jumps{end}.csv") for end in ("", "_onset"))
    both = jumps.merge(onset[["n", "k", "model", "critical"]], on=["n", "k", "model"], validate="many_to_one")
    assert len(both) == len(jumps)
    none = both["reason"].str.contains("there is no jump", na=False)
    assert none.equals(both["mu"] < both["critical"])
    assert none.equals(both["kappa"].isna())


def test_the_onset_is_just_above_the_critical_tabor_number(tmp_path):
    cache = CallCache(tmp_path / "tasks.jsonl", "test")
    list(cache.work(onset_calls([(2.0, 0.0, 1.0), (2.0, 0.0, 5.0)]), 1))
    shown = [("jump_in_displacement", "semi-rigid"), ("jump_out_displacement", "jkr")]
    table = onset_errors(cache.results, [(2.0, 0.0, 1.0)], shown)
    assert table["critical"].to_numpy() == pytest.approx(0.69721461, abs=1e-8)
    assert table["mu"].to_numpy() == pytest.approx(1.001 * 0.69721461, abs=1e-8)
    # Where the jumps merge the full model has one displacement for both.
    assert table["fscm"][0] == pytest.approx(table["fscm"][1], abs=1e-4)
    assert np.isfinite(table["kappa"]).all()


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
