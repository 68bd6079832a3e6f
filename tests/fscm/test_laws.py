"""Surface laws against 40-digit formulas; what is dimensionless, smoothed or refused; `tests/solvers` has the rest."""

import math
import pickle

import mpmath
import numpy as np
import pytest

from fscm import LennardJones, Mie, Problem, TabulatedLaw, solve

GAPS = np.array([-0.6, -0.3, -1e-3, 0.0, 1e-9, 0.05, 0.2, 0.6, 1.0, 7.0, 50.0, 1e4])
LJ = LennardJones()
EXPONENTS = [(9.0, 3.0), (12.0, 6.0), (7.0, 2.5), (9.0, 8.999), (3.0 + 1e-9, 3.0), (15.0, 1.1)]
LAWS = [(LJ, 9.0, 3.0), *((Mie(m=m, n=n), m, n) for m, n in EXPONENTS)]
# Rounding of a handful of operations; measured worst 9 eps (curvature, m - n = 1e-9).
ROUNDING = 40 * np.finfo(float).eps


@pytest.mark.parametrize(("law", "m", "n"), LAWS, ids=str)
def test_a_law_and_its_derivatives_match_extended_precision(law, m, n):
    with mpmath.workdps(60):
        mm, nn = mpmath.mpf(m), mpmath.mpf(n)
        A = (mm - 1) * (nn - 1) / (mm - nn)
        for H in GAPS:
            x, gap = mpmath.mpf(float(H)) + 1, np.array(H)
            size = float((mm - 1) * (nn - 1) * x ** (-mm if H < 0 else -nn)) * (1.0 + abs(math.log1p(H)))
            for value, exact, factor in [
                (law.traction(gap), A * (x**-mm - x**-nn), 1.0),
                (law.slope(gap), A * (-mm * x ** (-mm - 1) + nn * x ** (-nn - 1)), (m + 1) / (H + 1)),
                (
                    law.curvature(gap),
                    A * (mm * (mm + 1) * x ** (-mm - 2) - nn * (nn + 1) * x ** (-nn - 2)),
                    (m + 1) * (m + 2) / (H + 1) ** 2,
                ),
                (law.energy(gap), A * (x ** (1 - mm) / (mm - 1) - x ** (1 - nn) / (nn - 1)), (H + 1) / (n - 1)),
            ]:
                assert abs(float(value - exact)) <= ROUNDING * size * factor * (1.0 + m * abs(math.log1p(H)))
    assert float(law.traction(np.array(0.0))) == 0.0
    assert law == pickle.loads(pickle.dumps(law))


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_law_without_traction_below_its_singular_gap_is_solved_as_one_that_has_it():
    """Under a sharp edge trial gaps are below it: between the nodes of a coarse mesh and behind a long step."""
    force, lennard_jones = (solve(Problem(8, 0, 257, law=law), "pull_off_force") for law in (Mie(m=9, n=3), LJ))
    assert abs(force.value - lennard_jones.value) <= force.u_num + lennard_jones.u_num


def points(count, end=20.0):
    """Points of the 9-3 law, gaps from its singularity, denser in the well."""
    gaps = np.geomspace(0.7, end, count)
    return gaps, LJ.traction(gaps - 1.0)


def test_the_wall_is_steep_monotone_and_diverges():
    table = TabulatedLaw(*points(100))
    wall = table.gaps[0] - table.equilibrium_gap - table.singular_gap
    H = table.singular_gap + np.geomspace(1e-3, wall, 200)
    p = table.traction(H)
    assert np.all(np.diff(p) < 0)
    assert np.all(table.slope(H) < 0)
    assert p[0] > 1e20
    assert -1.1 < table.singular_gap < -0.9


@pytest.mark.parametrize(("count", "noise"), [(20, 0.0), (40, 1e-4), (80, 1e-3)])
def test_smoothing_answers_for_few_and_for_noisy_points(count, noise):
    """Twenty points, or noise, which the interpolating spline refuses or turns into waves."""
    gaps, tractions = points(count)
    tractions = tractions * (1 + noise * np.random.default_rng(1).standard_normal(count))
    law = TabulatedLaw(gaps, tractions, tail_exponent=3, smoothing=max(noise, 1e-4))
    H = np.linspace(0.0, 15.0, 400)
    # The error of a mean of several points: below three of a single one.
    np.testing.assert_allclose(law.traction(H), LJ.traction(H), atol=3 * max(noise, 1e-4))
    assert law.tractions == tuple(tractions.tolist())
    assert pickle.loads(pickle.dumps(law)) == law != law.alternatives[0]


@pytest.mark.parametrize("smoothing", [1e-5, 1e-3])
def test_smoothing_of_exact_points_keeps_to_them(smoothing):
    """A law that is no difference of powers: the curve left its points by 1800 times the stated error and more."""
    gaps = np.geomspace(0.75, 8.0, 51)
    tractions = LJ.traction(gaps - 1.0) * (1.0 + 0.3 * np.exp(-(((gaps - 2.0) / 0.6) ** 2)))
    law = TabulatedLaw(gaps, tractions, tail_exponent=3, smoothing=smoothing)
    off = law.traction(gaps - law.equilibrium_gap) - tractions
    assert np.abs(off / (np.abs(tractions) + 0.1)).max() < 10.0 * smoothing


@pytest.mark.parametrize("count", [10, 11, 14, 17, 20, 40])
def test_the_alternatives_of_few_points_are_laws(count):
    """Those without the first point lost the wall and ended the computation."""
    law = TabulatedLaw(*points(count), tail_exponent=3, smoothing=1e-3)
    alternatives = law.alternatives
    assert all(len(other.gaps) >= 10 for other in alternatives)
    assert {(other.gaps[0], other.gaps[-1]) for other in alternatives} == {(law.gaps[0], law.gaps[-1])}
    assert len(alternatives) == (2 if count == 10 else 4)


@pytest.mark.parametrize(("m", "n", "error"), [(9.0, 3.0, 0.008), (7.0, 2.5, 0.03)])
def test_the_exponent_of_the_tail_is_that_of_the_last_octave(m, n, error):
    """Measured 4.9e-3 and 2.2e-2; all points of the tail give 0.08, those outside of the octave 0.018 and 0.039."""
    gaps = np.geomspace(0.75, 20.0, 120)
    decay = TabulatedLaw(gaps, Mie(m=m, n=n).traction(gaps - 1.0)).decay[1]
    assert abs(decay - n) < error


@pytest.mark.parametrize(("count", "exponent", "end"), [(60, 3, 4.0), (84, 3, 9.0), (104, 2, 9.0), (120, 4, 6.0)])
def test_a_law_of_finite_range_ends_without_a_turn(count, exponent, end):
    """The slope vanishes at the last point; by rounding, it also does so next to it."""
    gaps = np.geomspace(0.75, end, count)
    law = TabulatedLaw(gaps, (gaps**-9 - gaps**-3) * (1.0 - (gaps / end) ** 4) ** exponent)
    assert law.decay == (0.0, math.inf)
    assert law.peak_gap < 0.3


def test_what_the_smoothing_matters_is_part_of_the_uncertainty():
    """The pull-off force with a noisy law differs from the exact one by less than its u_num, which says so."""
    gaps, tractions = points(40)
    tractions = tractions * (1 + 1e-3 * np.random.default_rng(2).standard_normal(40))
    law = TabulatedLaw(gaps, tractions, tail_exponent=3, smoothing=1e-3)
    exact = solve(Problem(2, 0, 0.5), "pull_off_force").value
    solution = solve(Problem(2, 0, 0.5, law=law), "pull_off_force")
    assert abs(solution.value - exact) < solution.u_num < 1e-2
    assert solution.parts["law"] > 1e-6
    assert solution.u_num == sum(solution.parts.values())
    assert TabulatedLaw(*points(100)).alternatives == ()
    for smoothing in (-1e-3, 0.1, math.nan, "1", True):
        with pytest.raises(ValueError, match=r"smoothing = .*\[0, 0\.1\)"):
            TabulatedLaw(gaps, tractions, smoothing=smoothing)
