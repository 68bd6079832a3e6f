"""Laws from data: recovered closed forms, smoothness, consistency, refused data."""

import math
import pickle
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import PPoly

from fscm.laws import LennardJones, Mie, SurfaceLaw
from fscm.problem import Problem
from fscm.solver import solve
from fscm.tabulated_law import TabulatedLaw, _checked_shape

LJ = LennardJones()


def sample(law, count, first=0.7, last=20.0):
    """Points of a closed-form law, gaps from its singularity, denser in the well."""
    gap = np.geomspace(first, last, count)
    return gap, law.traction(gap - 1.0)


def worst_error(count, name):
    law = TabulatedLaw(*sample(LJ, count), tail_exponent=3)
    H = np.linspace(-0.3, 19.0, 4001)
    return np.max(np.abs(getattr(law, name)(H) - getattr(LJ, name)(H)))


@pytest.mark.parametrize(("name", "order"), [("traction", 6), ("slope", 5), ("curvature", 4), ("energy", 6)])
def test_order_of_convergence_is_the_one_of_a_quintic_spline(name, order):
    # The error sits at the first point, where the spline has no neighbours on one side.
    coarse, fine = worst_error(160, name), worst_error(320, name)
    assert math.log2(coarse / fine) > order - 1.0


def test_the_nine_three_law_is_recovered_from_its_points():
    law = TabulatedLaw(*sample(LJ, 200), tail_exponent=3)
    assert isinstance(law, SurfaceLaw)
    assert law.equilibrium_gap == pytest.approx(1.0, abs=1e-9)
    # What is left is the tail, fitted as -C (H - t)^-3 although the data still feel the ninth power.
    assert law.work_of_adhesion == pytest.approx(1.0, abs=1e-7)
    assert law.peak_gap == pytest.approx(LJ.peak_gap, abs=1e-8)
    assert law.decay == pytest.approx((8 / 3, 3.0), rel=1e-5)
    H = np.geomspace(0.01, 1e6, 60)
    np.testing.assert_allclose(law.traction(H), LJ.traction(H), rtol=1e-5)
    np.testing.assert_allclose(law.energy(H), LJ.energy(H), rtol=1e-5)


def test_an_unknown_tail_exponent_is_fitted():
    assert TabulatedLaw(*sample(LJ, 80)).decay == pytest.approx((8 / 3, 3.0), rel=5e-3)
    assert TabulatedLaw(*sample(Mie(m=12, n=6), 80)).decay[1] == pytest.approx(6.0, rel=2e-2)


@pytest.mark.parametrize("law", [LJ, Mie(m=12, n=6), Mie(m=7, n=2.5)])
@pytest.mark.parametrize("known", [True, False])
def test_normalised_and_consistent(law, known):
    gap, p = sample(law, 100)
    table = TabulatedLaw(gap + 17.0, 300.0 * p, tail_exponent=law.decay[1] if known else None)
    assert table.equilibrium_gap == pytest.approx(18.0, abs=1e-5)
    assert table.work_of_adhesion == pytest.approx(300.0, rel=0.02)
    table = table.dimensionless
    assert (table.work_of_adhesion, table.z0) == (1.0, 1.0)
    zero = np.array(0.0)
    assert float(table.traction(zero)) == pytest.approx(0.0, abs=1e-13)
    assert float(table.energy(zero)) == pytest.approx(-1.0, rel=1e-14)
    assert float(table.slope(np.array(table.peak_gap))) == pytest.approx(0.0, abs=1e-10)
    C, m = table.decay
    far = np.array(1e8)
    assert float(table.traction(far) * far**m) == pytest.approx(-C, rel=1e-5)
    # Slope, curvature and energy belong to the traction, in the wall, on the spline and in the tail.
    last = gap[-1] - 1.0
    for H in (0.5 * (table.singular_gap - 0.3), -0.1, 0.3, 3.0, last - 0.1, last + 0.1, 100.0):
        h = 1e-3 * min(1.0, H - table.singular_gap)
        d = [float(table.traction(np.array(H + i * h))) for i in (-2, -1, 0, 1, 2)]
        slope = (d[0] - 8 * d[1] + 8 * d[3] - d[4]) / (12 * h)
        curvature = (-d[0] + 16 * d[1] - 30 * d[2] + 16 * d[3] - d[4]) / (12 * h**2)
        here = np.array(H)
        assert float(table.slope(here)) == pytest.approx(slope, rel=1e-6, abs=1e-9)
        assert float(table.curvature(here)) == pytest.approx(curvature, rel=1e-4, abs=1e-6)
        # Knot by knot the spline is a polynomial, and quadrature of it exact.
        pieces = [x for x in np.array(gap) + 17.0 - table.equilibrium_gap if x > H]
        ends = [H, *pieces]
        inside = sum(quad(table.traction, a, b, epsabs=1e-13)[0] for a, b in pairwise(ends))
        total = inside + float(table.energy(np.array(ends[-1])))
        assert float(table.energy(here)) == pytest.approx(total, rel=1e-10)
    assert float(table.energy(np.array(last))) == pytest.approx(
        quad(table.traction, last, np.inf, epsabs=1e-14)[0], rel=1e-8
    )


def test_joints_are_twice_continuously_differentiable():
    table = TabulatedLaw(*sample(LJ, 100))
    for joint in (table.gaps[0] - table.equilibrium_gap, table.gaps[-1] - table.equilibrium_gap):
        below, above = np.array(np.nextafter(joint, -9.0)), np.array(np.nextafter(joint, 99.0))
        for name in ("traction", "slope", "curvature", "energy"):
            left, right = getattr(table, name)(below), getattr(table, name)(above)
            assert float(left) == pytest.approx(float(right), rel=1e-9)


def test_the_wall_is_steep_monotone_and_diverges():
    table = TabulatedLaw(*sample(LJ, 100))
    first = table.gaps[0] - table.equilibrium_gap
    H = table.singular_gap + np.geomspace(1e-3, first - table.singular_gap, 200)
    p = table.traction(H)
    assert np.all(np.diff(p) < 0)
    assert np.all(table.slope(H) < 0)
    assert p[0] > 1e20
    assert -1.1 < table.singular_gap < -0.9


def test_a_law_of_finite_range():
    gap, p = sample(LJ, 100, last=6.0)
    cut = p * np.where(gap < 5, 1.0, 0.0) * np.clip((5 - gap) / 5, 0, 1) ** 3
    keep = gap < 5
    table = TabulatedLaw(np.append(gap[keep], 5.0), np.append(cut[keep], 0.0))
    assert table.decay == (0.0, math.inf)
    far = np.array([4.0 + 1e-6, 10.0, 1e5])
    for name in ("traction", "slope", "curvature", "energy"):
        np.testing.assert_allclose(getattr(table, name)(far), 0.0, atol=1e-9)
    assert Problem(0.6, 0.2, 1.0, law=table).law == table.dimensionless  # any growth will do: the load integral ends


def test_noise_is_carried_or_refused_but_never_turned_into_waves():
    gap, p = sample(LJ, 40, last=10.0)
    rng = np.random.default_rng(1)
    small = TabulatedLaw(gap, p * (1 + 1e-4 * rng.standard_normal(40)), tail_exponent=3)
    H = np.linspace(0.0, 8.0, 200)
    np.testing.assert_allclose(small.traction(H), LJ.traction(H), atol=5e-2)
    with pytest.raises(ValueError, match="smooth curve"):
        TabulatedLaw(gap, p + 0.1 * (-1.0) ** np.arange(40) * (gap > 3.0) * np.abs(p), tail_exponent=3)


def edit(row=None, **values):
    gap, p = sample(LJ, 50)
    if "gap" in values:
        gap[row] = values["gap"]
    if "p" in values:
        p[row] = values["p"]
    return gap, p


GAP, P = sample(LJ, 50)


@pytest.mark.parametrize(
    ("gap", "p", "reason"),
    [
        (GAP[:6], P[:6], "two columns"),
        (GAP, P[:-1], "two columns"),
        (GAP.reshape(5, 10), P.reshape(5, 10), "two columns"),
        (["a"] * 20, P[:20], "real numbers"),
        (GAP, P * 1j, "real numbers"),
        (*edit(7, p=math.nan), "row 7"),
        (*edit(9, gap=math.inf), "row 9"),
        (*edit(12, gap=0.0), "increase"),
        (GAP[::-1], P[::-1], "increase"),
        (GAP[15:], P[15:], "wall"),
        (GAP, -P, "wall"),
        (GAP, np.abs(P), "tail of a law attracts"),
        (*sample(LJ, 20, last=1.19), "minimum"),
        (*edit(40, p=1.0), "changes sign 3 times"),
        (GAP, 1.0 / GAP - 1.0, "minimum"),
        (GAP[:14], P[:14], "no tail"),
        (GAP, GAP**-9 - GAP**-0.5, "infinite"),
    ],
)
def test_what_is_not_a_law_is_refused_in_one_sentence(gap, p, reason):
    with pytest.raises(ValueError, match=reason) as caught:
        TabulatedLaw(gap, p)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("m", [1.0, 0.0, -3, math.nan, math.inf, "3", True])
def test_bad_tail_exponents(m):
    with pytest.raises(ValueError, match="tail_exponent"):
        TabulatedLaw(GAP, P, tail_exponent=m)


def test_a_table_is_a_value():
    table = TabulatedLaw(GAP, P)
    again = pickle.loads(pickle.dumps(table))
    assert again == table == TabulatedLaw(list(GAP), tuple(P))
    assert hash(again) == hash(table)
    assert float(again.traction(np.array(0.3))) == float(table.traction(np.array(0.3)))
    assert "50 points" in repr(table)
    assert table != TabulatedLaw(GAP, P, tail_exponent=3)


@pytest.mark.parametrize(("count", "noise"), [(20, 0.0), (40, 1e-4), (80, 1e-3)])
def test_smoothing_answers_for_few_and_for_noisy_points(count, noise):
    """Twenty points, or noise, which the interpolating spline refuses or turns into waves."""
    gap, p = sample(LJ, count)
    p = p * (1 + noise * np.random.default_rng(1).standard_normal(count))
    law = TabulatedLaw(gap, p, tail_exponent=3, smoothing=max(noise, 1e-4))
    H = np.linspace(0.0, 15.0, 400)
    # The error of a mean of several points: below three of a single one.
    np.testing.assert_allclose(law.traction(H), LJ.traction(H), atol=3 * max(noise, 1e-4))
    assert law.tractions == tuple(p.tolist())
    assert pickle.loads(pickle.dumps(law)) == law != law.alternatives[0]


def test_what_the_smoothing_matters_is_part_of_the_uncertainty():
    """The pull-off force with a noisy law differs from the exact one by less than its u_num, which says so."""
    gap, p = sample(LJ, 40)
    p = p * (1 + 1e-3 * np.random.default_rng(2).standard_normal(40))
    law = TabulatedLaw(gap, p, tail_exponent=3, smoothing=1e-3)
    exact = solve(Problem(2, 0, 0.5), "pull_off_force").value
    solution = solve(Problem(2, 0, 0.5, law=law), "pull_off_force")
    assert abs(solution.value - exact) < solution.u_num < 1e-2
    assert solution.parts["law"] > 1e-6
    assert solution.u_num == sum(solution.parts.values())
    assert TabulatedLaw(*sample(LJ, 100)).alternatives == ()


@pytest.mark.parametrize("smoothing", [-1e-3, 0.1, math.nan, "1", True])
def test_bad_smoothing(smoothing):
    with pytest.raises(ValueError, match=r"smoothing = .*\[0, 0\.1\)"):
        TabulatedLaw(GAP, P, smoothing=smoothing)


def _ending(before):
    """Two parabolas through (0, 1), (1, -1) and (2, 0): the least at 0.9, the largest so much before the end."""
    steep = 1.0 / (2.0 * before - 1.0)
    return PPoly(
        np.array([[2.5, steep], [-4.5, -2.0 * steep * (1.0 - before)], [1.0, -1.0]]), np.array([0.0, 1.0, 2.0])
    )


def test_a_curve_that_ends_without_slope_turns_there_by_rounding_alone():
    gap, p = np.array([0.0, 1.0, 2.0]), np.array([1.0, -1.0, 0.0])
    assert _checked_shape(_ending(1e-9), gap, p) == pytest.approx(0.9, abs=1e-12)
    # The curve falls by 1e-14 before it ends.
    with pytest.raises(ValueError, match="turns 2 times, the data 1 times"):
        _checked_shape(_ending(1e-7), gap, p)
