"""The Gibson limit: closed forms, extended precision, another quadrature, and the limit k -> 1 itself."""

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from fscm.analysis import Analysis
from fscm.errors import NoSuchEvent
from fscm.gibson import GibsonSolid
from fscm.laws import LennardJones, Mie
from fscm.problem import Problem
from fscm.punch import RoundedCone
from fscm.tabulated_law import TabulatedLaw
from tests.marks import heavy
from tests.refusals import refused

LAW = LennardJones()
# 2 mu^2 p'_max = 1 with p'_max = 8 q^4 - 24 q^10 at q^6 = 2/15.
CRITICAL = math.sqrt(0.5 / (4.8 * (2 / 15) ** (2 / 3)))


def solid(n, mu, law=None):
    return GibsonSolid(Problem(n, 1, mu, law=law))


def value(n, mu, quantity):
    return solid(n, mu).solution(quantity).value


def energy(H, mu):
    """Elastic and surface energy per area."""
    return float(mu**2 * LAW.traction(H) ** 2 + LAW.energy(H))


def test_critical_tabor_number_is_a_closed_form():
    for n in (1.0, 2.0, 5.0):
        critical = solid(n, 1.0).solution("critical_tabor_number")
        assert abs(critical.value - CRITICAL) <= critical.u_num < 1e-13


@pytest.mark.parametrize("mu", [0.01, 0.5, 1.0, 2.0, 20.0])
def test_a_paraboloid_has_pull_off_two_and_twice_the_energy_at_its_center(mu):
    # P = integral of p d(r^2) = -2 integral of de = 2 e(H0), least where p = 0, that is at H0 = 0.
    for quantity, exact in [("pull_off_force", 2.0), ("pull_off_displacement", 0.0)]:
        solution = solid(2, mu).solution(quantity)
        assert abs(solution.value - exact) <= solution.u_num
        assert solution.u_num < 1e-12 * (1 + mu**2)
    for H in (-0.1, -0.01, 0.0, 20.0):
        assert solid(2, mu).load(H) == pytest.approx(2 * energy(np.array(H), mu), rel=1e-12, abs=1e-12 * (1 + mu**2))


def level(H, M):
    """Height of the punch above the surface far away, less the displacement, at which the gap is H."""
    return H - M * mpmath.mpf(8) / 3 * ((H + 1) ** -9 - (H + 1) ** -3)


def well(H, M):
    """Energy per area in extended precision."""
    p = mpmath.mpf(8) / 3 * ((H + 1) ** -9 - (H + 1) ** -3)
    return M * p**2 / 2 + (H + 1) ** -8 / 3 - 4 * (H + 1) ** -2 / 3


@pytest.mark.parametrize("n", [1.0, 5.0])
@pytest.mark.parametrize("mu", [0.4, 2.0])
def test_load_by_quadrature_over_the_radius(n, mu):
    """The gap at each radius from its own equation; above the critical number both sides of the front are those of
    Maxwell's rule, equal levels and equal energies."""
    model, M, H0 = solid(n, mu), 2 * mu**2, -0.02
    delta = model.displacement(H0)
    front, far_side = math.inf, 0.0
    if mu > CRITICAL:
        sides = mpmath.findroot(lambda a, b: (level(a, M) - level(b, M), well(a, M) - well(b, M)), (0.06, 1.9))
        front, far_side = float(level(sides[0], M)), float(sides[1]) - 1e-6

    def density(r):
        u = r**n / n - delta
        if front == math.inf:
            bounds = (-0.9, max(u, 0.0) + 5.0)
        else:
            bounds = (-0.9, LAW.peak_gap) if u < front else (far_side, u + 5.0)
        H = brentq(lambda H: H - M * float(LAW.traction(np.array(H))) - u, *bounds, xtol=1e-15)
        return 2 * r * float(LAW.traction(np.array(H)))

    edge = ((0.5 if front == math.inf else front) + delta) ** (1 / n) * n ** (1 / n)
    pieces = pairwise([0.0, edge, 2 * edge, 10 * edge, np.inf])
    load = sum(quad(density, a, b, epsabs=1e-11, epsrel=1e-11, limit=200)[0] for a, b in pieces)
    assert model.load(H0) == pytest.approx(load, rel=2e-9)


@pytest.mark.parametrize("mu", [0.7, 1.0, 3.0])
def test_jumps_in_extended_precision(mu):
    model = solid(2, mu)
    with mpmath.workdps(40):
        M = 2 * mpmath.mpf(mu) ** 2
        A = mpmath.findroot(lambda H: mpmath.diff(lambda H: level(H, M), H), model.solution("jump_in_gap").value)
        inner, outer = mpmath.findroot(
            lambda a, b: (level(a, M) - level(b, M), well(a, M) - well(b, M)),
            (model._local.front.near, model._local.front.far),
        )
        # Two copies of one gap would satisfy both equations as well.
        assert outer - inner > 0.1
        exact = {
            "jump_in_gap": A,
            "jump_in_displacement": -level(A, M),
            "jump_out_displacement": -level(inner, M),
        }
        for quantity, number in exact.items():
            solution = model.solution(quantity)
            assert abs(solution.value - float(number)) <= solution.u_num < 1e-12


@pytest.mark.parametrize("mu", [0.8, 2.0])
def test_hysteresis_is_the_area_between_loading_and_unloading(mu):
    # n = 2, where P = 2 e on either branch: integrate the difference over the displacement.
    model = solid(2, mu)
    B, A = (model.solution(f"jump_{way}_displacement").value for way in ("out", "in"))

    def difference(delta):
        return 2 * (energy(model._local.far(-delta), mu) - energy(model._local.near(-delta), mu))

    area = quad(difference, B, A, epsabs=1e-12, limit=200)[0]
    assert model.solution("hysteresis_energy").value == pytest.approx(area, rel=1e-8)


@pytest.mark.parametrize("n", [1.0, 2.0, *heavy(5.0)])
def test_load_is_stationary_at_pull_off_and_zero_at_zero_load(n):
    for mu in (0.5, 2.0):
        model = solid(n, mu)
        delta, force = (model.solution(f"pull_off_{name}").value for name in ("displacement", "force"))
        for step in (-1e-3, 1e-3):
            assert model._sum(delta + step, True, 0)[0] > -force
        zero = model.solution("zero_load_displacement")
        assert abs(model._sum(zero.value, True, 0)[0]) < 1e-11
        assert zero.value > delta


def test_no_jump_below_the_critical_tabor_number():
    for quantity in ("jump_in_displacement", "jump_in_gap", "jump_out_displacement", "hysteresis_energy"):
        refused("no jump", solid(2, 0.999 * CRITICAL).solution, quantity, error=NoSuchEvent)
        assert math.isfinite(solid(2, 1.001 * CRITICAL).solution(quantity).value)


@pytest.mark.parametrize(
    ("n", "quantity"), [(5, "pull_off_force"), *heavy((2, "pull_off_force"), (2, "zero_load_displacement"))]
)
def test_the_solver_for_graded_solids_tends_to_it(n, quantity):
    # The leading correction is linear in 1 - k: Richardson from k = 0.9 and 0.95 leaves the quadratic one.
    coarse, fine = (Analysis(Problem(n, k, 0.5)).solution(quantity).value for k in (0.9, 0.95))
    limit = value(n, 0.5, quantity)
    assert abs(2 * fine - coarse - limit) < 0.06 * abs(coarse - limit) < 2e-3


def test_other_laws():
    mie = solid(2, 1.0, Mie(m=12, n=6))
    assert mie.solution("pull_off_force").value == pytest.approx(2.0, rel=1e-13)
    gap = np.geomspace(0.7, 20.0, 100)
    table = solid(2, 1.0, TabulatedLaw(gap, LAW.traction(gap - 1.0), tail_exponent=3))
    for quantity in ("jump_in_displacement", "jump_out_displacement"):
        solution, exact = table.solution(quantity), value(2, 1.0, quantity)
        assert solution.value == pytest.approx(exact, rel=2e-5)
    # As for any law, P = 2 e at n = 2.
    assert table.load(-0.01) == pytest.approx(2 * table._local.energy(-0.01), rel=1e-9)


def test_between_the_branches_there_is_no_number():
    model = solid(2, 1.0)
    inside = 0.5 * (model._local.front.near + model.solution("jump_in_gap").value)
    for compute in (model.load, model.displacement):
        refused("between jump-in and jump-out", compute, inside)
        for outside in (-1.0, -2.0, math.nan, math.inf):
            refused("central gap", compute, outside)
    refused("jump_out_gap", model.solution, "jump_out_gap", error=NoSuchEvent)


def test_bad_input():
    refused("gradient exponent", GibsonSolid, Problem(2, 0.99, 1.0))
    refused("power law", GibsonSolid, Problem(1, 1, 1.0, punch=RoundedCone(1.0)))
    refused("unknown quantity", solid(2, 1.0).solution, "weight")
