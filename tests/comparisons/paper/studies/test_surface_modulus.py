"""The study of the surface modulus: its limits, its tables, and the depth that the mesh must reach."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy.special import beta
from skfem import ElementLinePp

import fem_reference._contact.mesh_lengths
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.studies.surface_modulus import homogeneous_tabor_number, with_skin, with_skin_by_fscm
from comparisons.paper.studies.surface_modulus_tables import Sample, limits, samples, thresholds
from comparisons.paper.tasks import quantity
from fem_reference._contact.mesh_lengths import EXTERIOR_ERROR
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.trace import trace_of


def response_factor(k: float, nu: float) -> float:
    """Eq. 7."""
    q = math.sqrt((1 + k) * (1 - k * nu / (1 - nu)))
    factor = 2 ** (k + 1) * (k + 2) * q * math.sin(q * math.pi / 2) / (k * (k + 1) * beta(k / 2, 0.5))
    return factor * beta((3 + k + q) / 2, (3 + k - q) / 2)


@pytest.mark.parametrize(("k", "mu", "depth"), [(0.4, 1.0, 0.3), (0.6, 2.0, 100.0)])
def test_tabor_number_of_the_uniform_solid(k, mu, depth):
    """Eq. 29 for both solids, divided: every scale but z_s / L drops out."""
    ratio = depth**-k * (1 - k) / response_factor(k, 0.3)
    expected = (mu ** ((3 + k) / 2) * ratio) ** (2 / 3)
    assert homogeneous_tabor_number(k, mu, depth) == pytest.approx(expected, rel=1e-12)


@pytest.mark.heavy
def test_an_offset_does_nothing_to_a_uniform_solid():
    found = with_skin("pull-off", 0.0, 1.0, 30.0)
    for name in ("pull_off_force", "pull_off_displacement"):
        value, u_num = found[name]
        exact = quantity("fscm", name, 2.0, 0.0, 1.0)["value"]
        # Measured 8e-6, nearly all of it what half the extent changes.
        assert abs(value - exact) <= u_num < 1e-5


def test_both_references_agree_within_their_bounds():
    table = pd.read_csv(Path(__file__).parents[4] / PAPER_BASELINE / "surface_modulus.csv")
    assert (table["value"].isna() == table["fscm_value"].isna()).all()
    known = table.dropna(subset="value")
    assert ((known["value"] - known["fscm_value"]).abs() <= known["u_num"] + known["u_fscm"]).all()
    assert len(known) > 100


@pytest.mark.heavy
def test_a_point_is_computed_again_by_the_fscm():
    """Another one is the example in the docstring of the function."""
    table = pd.read_csv(Path(__file__).parents[4] / PAPER_BASELINE / "surface_modulus.csv")
    known = table.dropna(subset="value")
    force = known[known["quantity"] == "pull_off_force"].iloc[-1]
    value, u_num = with_skin_by_fscm(force["k"], force["mu"], force["depth"])["pull_off_force"]
    assert abs(value - force["fscm_value"]) <= u_num + force["u_fscm"]


@pytest.mark.heavy
def test_a_thick_skin_is_a_uniform_solid():
    """What is left, at 1000 L, is the share of the contact radius in the offset."""
    value, u_num = with_skin("pull-off", 0.4, 1.0, 1000.0)["pull_off_force"]
    limit = quantity("fscm", "pull_off_force", 2.0, 0.0, homogeneous_tabor_number(0.4, 1.0, 1000.0))["value"]
    assert u_num < 1e-6
    # The solid is a little stiffer than its surface, so nearer to Bradley's.
    assert 1e-5 < value - limit < 5e-5


def test_without_jumps_there_is_a_reason():
    found = with_skin("jump-out", 0.4, 1.0, 3.0)
    assert set(found) == {"reason"}
    assert "too stiff" in found["reason"]


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


def test_surface_functions_are_those_of_the_elements():
    trace = trace_of(MeshSpec(0.2, 0.1, 10.0, 1.0, 5).grid(), 5)
    s = np.linspace(0.0, 10.0, 41)
    element = np.clip(np.searchsorted(trace.nodes, s, side="right") - 1, 0, trace.nodes.size - 2)
    x = (s - trace.nodes[element]) / np.diff(trace.nodes)[element]
    line, values, rows = ElementLinePp(5), trace.evaluate(s), np.arange(s.size)
    for local in range(6):
        column = element + local if local < 2 else trace.nodes.size + 4 * element + local - 2
        assert values[rows, column] == pytest.approx(line.lbasis(x[None], local)[0], abs=1e-15)
    assert np.count_nonzero(values) <= 6 * s.size


def series(k=0.4, u_num=1e-9):
    """A quantity that leaves its graded limit 2 as z_s^(1-k) and approaches the uniform 3 as 1 / z_s."""
    return [
        Sample(
            k=k,
            mu=1.0,
            depth=depth,
            mu_homogeneous=1.0,
            quantity="pull_off_force",
            elements=(2.0 + depth ** (1 - k), u_num) if depth < 1 else (3.0 + 1.0 / depth, u_num),
            fscm=None,
            reason="",
            graded=(2.0, u_num),
            homogeneous=(3.0, u_num) if depth > 1 else None,
        )
        for depth in (1e-3, 1e-2, 0.1, 10.0, 100.0)
    ]


def test_rates_of_both_limits():
    table = limits(series()).set_index(["limit", "depth"])
    assert table.loc[("graded", 1e-3), "rate"] == pytest.approx(0.6)
    assert table.loc[("graded", 1e-3), "expected"] == 0.6
    assert table.loc[("homogeneous", 100.0), "rate"] == pytest.approx(1.0)
    assert math.isnan(table.loc[("homogeneous", 10.0), "rate"])
    # No rate is read off a difference that is not resolved.
    assert limits(series(u_num=0.1))["rate"].isna().all()


def test_depths_that_change_a_quantity():
    table = thresholds(series()).set_index("change")
    assert table.loc[0.01, ["below", "above"]].tolist() == [1e-3, 1e-2]
    assert table.loc[0.01, "depth"] == pytest.approx(0.02 ** (1 / 0.6), rel=0.03)
    assert table.loc[0.05, "depth"] == pytest.approx(0.1 ** (1 / 0.6), rel=0.03)


def test_a_change_below_the_thinnest_skin_follows_the_law_of_thin_skins():
    table = thresholds(series()[2:]).set_index("change")
    assert table.loc[0.05, ["below", "above"]].tolist() == [0.0, 0.1]
    assert table.loc[0.05, "depth"] == pytest.approx(0.1 ** (1 / 0.6), rel=0.03)
    # The change of 13 % at the thinnest skin is too far from 1 %.
    assert math.isnan(table.loc[0.01, "depth"])


def test_a_quantity_that_ends_has_no_value_and_a_reason():
    (sample,) = [s for s in series() if s.depth == 0.1]
    ended = Sample(**{f: getattr(sample, f) for f in sample.__slots__} | {"elements": None, "reason": "too stiff"})
    table = samples([sample, ended])
    assert table["value"].isna().tolist() == [False, True]
    assert table["reason"].tolist() == ["", "too stiff"]
    assert limits([ended]).empty
    assert thresholds([ended]).empty
