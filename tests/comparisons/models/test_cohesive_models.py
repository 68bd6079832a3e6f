"""The models with a cohesive zone: their stresses, limits, events, curves, surfaces, and what they refuse."""

from __future__ import annotations

from pathlib import Path
from runpy import run_path

import numpy as np
import pytest
from scipy.special import beta

from comparisons import create
from comparisons.model import NotApplicable
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.cohesive_models import CohesiveModel
from comparisons.models.graded_punch import GradedPunch
from comparisons.problem import Problem

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "double_hertz" / "double_hertz.py"
EVENTS = ("pull_off_force", "pull_off_displacement", "zero_load_displacement", "jump_out_displacement")
contact = Problem.dimensionless


@pytest.fixture(params=["md-original", "md-improved", "md-jin", "double-hertz-n-k"])
def model(request: pytest.FixtureRequest) -> CohesiveModel:
    return create(request.param)


def value(model, problem: Problem, quantity: str = "pull_off_force") -> float:
    return model.evaluate(problem, quantity).value


@pytest.mark.parametrize(("n", "k"), [(1.0, 0.0), (2.0, 0.4), (5.0, 0.2)])
def test_tends_to_jkr(model, n: float, k: float) -> None:
    """Corrections are a power of mu: at k = 0 and mu = 1000 their share is 1e-6 or less."""
    problem = contact(n, k, 1000.0)
    for quantity in EVENTS:
        assert value(model, problem, quantity) == pytest.approx(value(create("jkr"), problem, quantity), rel=2e-3)


@pytest.mark.parametrize(("n", "k"), [(0.8, 0.6), (1.0, 0.0), (2.0, 0.7), (5.0, 0.2)])
def test_tends_to_its_rigid_limit(model, n: float, k: float) -> None:
    """With sigma_0 (1 - r^2/c^2)^d over the gap r^n / n the work of adhesion gives c, and the load follows."""
    stress, decay = model.cohesive_stress(contact(n, k, 1.0)), 0.5 * (1 + k) * (model.name == "double-hertz-n-k")
    c = (stress * beta(n / 2, decay + 1) / 2) ** (-1.0 / n)
    rigid = stress * c**2 / (decay + 1)
    assert value(model, contact(n, k, 1e-9)) == pytest.approx(rigid, rel=2e-4)


@pytest.mark.parametrize(("n", "k", "mu"), [(0.8, 0.0, 1e-3), (10.0, 0.95, 20.0), (7.0, 0.4, 0.02)])
@pytest.mark.parametrize("name", ["md-improved", "double-hertz-n-k"])
def test_pull_off_is_the_lowest_of_a_dense_sample(name: str, n: float, k: float, mu: float) -> None:
    model, problem, punch = create(name), contact(n, k, mu), GradedPunch(n, k)
    dense = CohesiveContact(punch, model.cohesive_stress(problem) * mu, model.decay(problem))
    w = np.concatenate(([-np.inf], np.linspace(-40.0, 0.0, 801), np.linspace(0.0, 70.0, 2001)))
    with np.errstate(over="ignore", invalid="ignore"):
        # Beyond the contact radii of interest the loads overflow.
        index = max(int(np.nanargmin(dense.at(w).load)), 2)
        around = np.linspace(w[index - 1], w[min(index + 1, len(w) - 1)], 101)
        lowest = -punch.scales(mu).load * min(np.nanmin(dense.at(x).load) for x in (w, around))
    result = model.evaluate(problem, "pull_off_force")
    assert lowest <= result.value + result.u_num
    assert result.value == pytest.approx(lowest, rel=1e-3)


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.4, 1.0), (1.0, 0.0, 0.01), (5.0, 0.95, 5.0), (2.0, 1.0, 0.5)])
def test_surfaces_in_barred_variables(model, n: float, k: float, mu: float) -> None:
    problem = contact(n, k, mu)
    surface, stress = model.pull_off_profile(problem, points=200), model.cohesive_stress(problem)
    load = -value(model, problem)
    r, p, H = surface.radius, surface.pressure, surface.gap
    a, c = surface.contact_radius, surface.cohesive_radius
    assert surface.displacement == pytest.approx(value(model, problem, "pull_off_displacement"), rel=1e-13)
    assert np.all(np.diff(r) > 0)
    assert np.all(H[r < a * (1 - 1e-12)] == 0.0)
    assert np.all(np.diff(H[r > a]) > -1e-13)
    assert H[-1] >= 10.0
    assert np.all(p[r > c * (1 + 1e-12)] == 0.0)
    assert np.all(p >= -stress * (1 + 1e-13))
    # Where the zone has a width to see.
    assert c < a * (1 + 1e-6) or p.min() == pytest.approx(-stress, rel=1e-3)
    # 2 integral of p r dr by the trapezoidal rule on the given points, the jump at c being two points apart.
    assert np.sum(np.diff(r**2) * 0.5 * (p[1:] + p[:-1])) == pytest.approx(load, rel=2e-3)


@pytest.mark.parametrize("quantity", EVENTS[:3])
def test_gibson_limit_is_continuous(model, quantity: str) -> None:
    """Below and above Lambda = 1, where the edge becomes that of JKR."""
    for n, mu in ((1.0, 0.3), (5.0, 3.0)):
        limit, beside = (value(model, contact(n, k, mu), quantity) for k in (1.0, 1 - 1e-7))
        assert beside == pytest.approx(limit, rel=1e-5, abs=1e-6)


@pytest.mark.parametrize("mu", [1e-2, 1.2, 10.0])
def test_a_paraboloid_on_a_gibson_solid_has_one_pull_off_force(model, mu: float) -> None:
    """n = 2, k = 1: Bradley, DMT and JKR agree on 2, so every stress does at every Tabor number."""
    result = model.evaluate(contact(2, 1.0, mu), "pull_off_force")
    assert abs(result.value - 2.0) <= result.u_num < 1e-11


@pytest.mark.parametrize(("k", "mu"), [(0.0, 0.1), (0.4, 1.0), (0.8, 4.0)])
def test_double_hertz_agrees_with_the_example_that_is_derived_apart(k: float, mu: float) -> None:
    """The external model for n = 2 has other unknowns, other integrals and another search."""
    models = create("double-hertz-n-k"), run_path(str(EXAMPLE))["DoubleHertz"]()
    ours, derived_apart = (value(model, contact(2, k, mu)) for model in models)
    assert ours == pytest.approx(derived_apart, rel=1e-9)


@pytest.mark.parametrize(
    ("quantity", "problem", "reason"),
    [
        ("jump_out_displacement", contact(2, 0.4, 0.05), "no fold in contact"),
        ("jump_in_displacement", contact(2, 0, 1), "hold in contact only"),
        (None, contact(2, 1, 3), "no cohesive zone at k = 1"),
        (None, contact(2, 0.999, 20), "width below"),
    ],
)
def test_refusals(model, quantity: str | None, problem: Problem, reason: str) -> None:
    with pytest.raises(NotApplicable, match=reason):
        model.evaluate(problem, quantity) if quantity else model.pull_off_profile(problem)
