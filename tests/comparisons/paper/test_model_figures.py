"""Figs. 11 to 17: the data beside each picture against limits, identities and the models themselves."""

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.special import hyp2f1

from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.paper.cache import CallCache
from comparisons.paper.figures import fig13_force_curve_models as force_curve_models
from comparisons.paper.figures import fig14_16_pull_off_models as pull_off_models
from comparisons.paper.figures import fig17_surface_models as surface_models
from comparisons.paper.figures.fig11_gradient_effect import GRADIENT_EFFECT, chi
from comparisons.paper.figures.fig12_surface_laws import SURFACE_LAWS, dugdale
from comparisons.registry import create
from comparisons.runs.cases import Case


@pytest.mark.heavy
def test_chi_of_the_paraboloid_is_a_third_of_the_gradient(tables_of):
    # Eq. 57 at n = 2: (k + 3) / 2, so that chi = k / 3.
    tables = tables_of(GRADIENT_EFFECT)
    sphere = tables[""][tables[""]["n"] == 2.0]
    np.testing.assert_allclose(sphere["chi"], sphere["k"] / 3, atol=1e-14)
    assert (tables[""].groupby("n")["chi"].first() == 0.0).all()
    within = tables["largest"].merge(tables["regions"], how="cross").query("n_from < n < n_to")
    everywhere = tables["largest"].merge(
        tables["regions"].agg({"n_from": "min", "n_to": "max"}).to_frame().T, how="cross"
    )
    assert within["chi_max"].max() < 0.1
    assert everywhere.query("n < n_from or n > n_to")["chi_max"].min() > 0.1
    for n, largest, k in tables["largest"].iloc[::40].to_numpy():
        assert largest == pytest.approx(chi(n, k), rel=1e-12)
        assert largest >= max(chi(n, 0.37), chi(n, 0.8))


def test_three_surface_laws_have_the_same_area(tables_of):
    tables = tables_of(SURFACE_LAWS)
    # The 9-3 law from H = 0: the work of adhesion, of which (1/3) 5^-8 - (4/3) 5^-2 is beyond H = 4.
    exact = tables["laws"].query("model == 'fscm' and gap > -1e-12")
    assert trapezoid(exact["pressure"], exact["gap"]) == pytest.approx(-1 + 4 / 75, abs=2e-3)
    for model, stress in (("md-original", THEORETICAL_STRENGTH), ("md-improved", eta(2.0))):
        law = tables["laws"].query(f"model == '{model}'")
        assert trapezoid(law["pressure"], law["gap"]) == pytest.approx(-1.0, abs=1e-14)
        assert law["pressure"].min() == -stress
    assert dugdale(2.0)["gap"].max() == 4.0
    rising = tables[""]
    assert rising["eta"].is_monotonic_increasing
    assert rising["eta"].iloc[-1] == pytest.approx(THEORETICAL_STRENGTH, rel=1e-14)


@pytest.fixture(scope="module")
def pull_off(tmp_path_factory):
    """The tables of Figs. 14 to 16 for a few cases; the figures share their tasks."""
    paper_figures = (
        pull_off_models.PULL_OFF,
        pull_off_models.PULL_OFF_BY_RIGID_LIMIT,
        pull_off_models.PULL_OFF_BY_SOFT_LIMIT,
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pull_off_models, "TABOR_NUMBERS", (0.01, 1.0, 10.0))
        patch.setattr(pull_off_models, "_SHAPES", (1.0, 2.0))
        cache = CallCache(tmp_path_factory.mktemp("pull_off") / "tasks.jsonl", "test")
        list(cache.work([call for figure in paper_figures for call in figure.tasks()], 1))
        yield [figure.tables(cache.results) for figure in paper_figures]


@pytest.mark.heavy
def test_pull_off_forces_tend_to_both_limits(pull_off):
    forces, rigid, soft = pull_off
    assert (forces[""]["status"] == "ok").all()
    assert (forces[""]["u_num"] >= 0.0).all()
    improved = rigid[""].query("model == 'md-improved' and mu == 0.01")
    assert improved["ratio"].to_numpy() == pytest.approx(1.0, abs=0.02)
    jkr = soft[""].query("mu == 10")
    assert jkr["ratio"].to_numpy() == pytest.approx(1.0, abs=6e-3)
    # The model that ignores the rigid limit is off there, for the cone by two thirds.
    cone = rigid[""].query("model == 'md-original' and mu == 0.01 and n == 1")
    assert cone["ratio"].item() == pytest.approx(1.0 - 0.65, abs=0.01)


def test_kappa_is_the_same_however_the_forces_are_scaled(pull_off):
    _, rigid, soft = pull_off
    kappa = soft["kappa"].set_index(["n", "mu", "model"])["kappa"]
    for tables in (rigid, soft):
        ratio = tables[""].pivot(index=["n", "mu"], columns="model", values="ratio")
        for model in ("md-original", "md-improved"):
            same = ratio[model] / ratio["fscm"] - 1.0
            expected = kappa.xs(model, level="model").loc[same.index]
            np.testing.assert_allclose(same, expected, atol=1e-12)
    worst = soft["kappa"].loc[soft["kappa"]["kappa"].abs().idxmax()]
    assert (worst["n"], worst["mu"], worst["model"]) == (1.0, 0.01, "md-original")


def test_curves_reach_the_pull_off_and_begin_at_first_contact(tables_of, monkeypatch):
    monkeypatch.setattr(force_curve_models, "_SHAPES", (2.0,))
    table = tables_of(force_curve_models.FORCE_CURVE_MODELS)[""]
    assert (table["status"] == "ok").all()
    deepest = table.groupby("model")["load"].min()
    for model in ("fscm", "md-original", "md-improved"):
        force = create(model).evaluate(Case(2.0, 0.4, 1.0).problem(), "pull_off_force").value
        u = table[table["model"] == model]["u_load"].iloc[0]
        assert -deepest[model] == pytest.approx(force, abs=u + 1e-9)
    # The improved model is the nearer one, as the paper shows.
    assert abs(deepest["md-improved"] / deepest["fscm"] - 1) < 0.1 * abs(deepest["md-original"] / deepest["fscm"] - 1)


def test_surfaces_touch_inside_a_and_part_by_the_work_of_adhesion_at_c(tables_of):
    tables = tables_of(surface_models.SURFACE_MODELS)
    radii = tables["radii"].set_index("model")
    for model, stress in (("md-original", THEORETICAL_STRENGTH), ("md-improved", eta(2.0))):
        part = tables[""][tables[""]["model"] == model]
        a, c = radii.loc[model]
        touching = part[part["radius"] < a]
        assert (touching["height"] == touching["punch"]).all()
        gap_at_c = np.interp(c, part["radius"], part["gap"])
        assert stress * gap_at_c == pytest.approx(1.0, abs=1e-6)
    # The smaller stress has the wider zone, on both sides of the original's.
    a, c = radii["contact_radius"], radii["cohesive_radius"]
    assert a["md-improved"] < a["md-original"] < c["md-original"] < c["md-improved"]


def test_the_height_of_the_surface_is_what_the_pressure_lifts(tables_of):
    """-w(r) of the FSCM by Eqs. 5 and 6 from the pressure in the table, beyond the contact where F is regular."""
    table = tables_of(surface_models.SURFACE_MODELS)[""]
    fscm = table[table["model"] == "fscm"]
    k, M = 0.4, 2.0
    t = np.linspace(0.0, fscm["radius"].max(), 100001)[1:]
    pressure = np.interp(t, fscm["radius"], fscm["pressure"])
    r = 3.0
    x2 = (np.minimum(t, r) / np.maximum(t, r)) ** 2
    F = hyp2f1(0.5 * (k + 1), 0.5 * (k + 1), 1.0, np.minimum(x2, 1.0 - 1e-6))
    lifted = -M * (1 - k) * trapezoid(np.where(t < r, t * r ** -(k + 1), t**-k) * F * pressure, t)
    # What the table leaves out beyond a gap of 10 lifts a little more.
    assert np.interp(r, fscm["radius"], fscm["height"]) == pytest.approx(lifted, abs=0.02)
