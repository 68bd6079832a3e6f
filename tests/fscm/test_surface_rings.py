"""Rings on soft films: the limit of instability against theory, and the refusal beyond it."""

import math

import numpy as np
import pytest

from fscm import Coating, LennardJones, PowerPunch, Problem, solve
from fscm._path.surface_rings import ring_limit
from fscm.errors import NotConverged, RingsForm

R, Z0, SUBSTRATE = 1e-6, 3e-10, 1e9

# Incompressible film on a rigid support: length of the softest wave over the thickness, its stiffness over that of
# shear over the thickness (Shenoy and Sharma, Phys. Rev. Lett. 86, 119 (2001): 2.96 and 6.22).
SOFTEST_LENGTH, SOFTEST_STIFFNESS = 2.96, 6.22
# Distance of neighbouring wave numbers at which the stiffness is known; of the stiffness, flat there, measured 1e-3.
LENGTH_TOLERANCE, STIFFNESS_TOLERANCE = 0.03, 3e-3


def film(nu, contrast, thickness, mu, substrate_nu=0.3):
    """Sphere on a film, its thickness in z0, at a Tabor number of the film; and the work of adhesion."""
    plane = SUBSTRATE * contrast / (1.0 - nu**2)
    work = math.sqrt(mu**3 * Z0**3 * plane**2 / R)
    solid = Coating(SUBSTRATE * contrast, SUBSTRATE, thickness * Z0, 0.0, nu, substrate_nu)
    return Problem(solid, PowerPunch(2, R), LennardJones(work, Z0)).dimensionless, work


def rubber(mu):
    """A film of nu = 0.45 at a contrast of 1e-2, of 0.2 z0."""
    return film(0.45, 1e-2, 0.2, mu)[0]


def test_the_softest_wave_of_an_incompressible_film_is_that_of_theory():
    problem, work = film(0.5, 1e-6, 1.0, 3000.0)
    limit = ring_limit(problem)
    unit = math.sqrt(R * Z0)
    shear = SUBSTRATE * 1e-6 / 3.0
    assert limit.length * unit / Z0 == pytest.approx(SOFTEST_LENGTH, rel=LENGTH_TOLERANCE)
    assert limit.stiffness * work / Z0**2 == pytest.approx(SOFTEST_STIFFNESS * shear / Z0, rel=STIFFNESS_TOLERANCE)


def test_at_the_limit_the_stiffness_is_the_steepest_fall_of_the_tension():
    problem = rubber(100.0)
    limit = ring_limit(problem)
    gaps = np.linspace(problem.law.peak_gap, 2.0, 100001)
    assert limit.steepest == pytest.approx(float(np.max(problem.law.slope(gaps))), rel=1e-5)
    at_limit = Problem(2, 0.0, limit.mu * 1.0001, graded=problem.graded)
    assert ring_limit(at_limit).stiffness == pytest.approx(limit.steepest, rel=2e-4)
    assert ring_limit(Problem(2, 0.0, limit.mu * 0.9999, graded=problem.graded)) is None


@pytest.mark.parametrize(
    "problem",
    [
        pytest.param(Problem(n=2, k=0, mu=100.0), id="homogeneous"),
        pytest.param(film(0.1, 1e-3, 0.1, 100.0)[0], id="film without sideways motion"),
        pytest.param(film(0.45, 1e-3, 300.0, 10.0)[0], id="film without room for rings"),
    ],
)
def test_no_rings(problem):
    assert ring_limit(problem) is None


def test_rings_are_refused_and_the_limit_is_named():
    problem = rubber(100.0)
    with pytest.raises(NotConverged) as refused:
        solve(problem, "pull_off_force")
    assert isinstance(refused.value, RingsForm)
    assert f"mu = {ring_limit(problem).mu:.4g}" in str(refused.value)
