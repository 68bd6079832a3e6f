"""Surface laws against 40-digit formulas, their own integrals, and values of the paper."""

import math
import pickle

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fscm import Problem, solve
from fscm.laws import LennardJones, Mie, SurfaceLaw

GAPS = np.array([-0.6, -0.3, -1e-3, 0.0, 1e-9, 0.05, 0.2, 0.6, 1.0, 7.0, 50.0, 1e4])
EXPONENTS = [(9.0, 3.0), (12.0, 6.0), (7.0, 2.5), (9.0, 8.999), (3.0 + 1e-9, 3.0), (15.0, 1.1)]
# Rounding of a handful of operations; measured worst 9 eps (curvature, m - n = 1e-9).
ROUNDING = 40 * np.finfo(float).eps


def exact(m, n):
    """Traction of the m-n law in extended precision."""
    m, n = mpmath.mpf(m), mpmath.mpf(n)
    A = (m - 1) * (n - 1) / (m - n)
    return lambda H: A * ((H + 1) ** -m - (H + 1) ** -n), A


@pytest.mark.parametrize(("m", "n"), EXPONENTS)
def test_mie_and_its_derivatives_match_extended_precision(m, n):
    law = Mie(m=m, n=n)
    with mpmath.workdps(60):
        p, A = exact(m, n)
        for H in GAPS:
            x = mpmath.mpf(float(H))
            mm, nn = mpmath.mpf(m), mpmath.mpf(n)
            slope = A * (-mm * (x + 1) ** (-mm - 1) + nn * (x + 1) ** (-nn - 1))
            curvature = A * (mm * (mm + 1) * (x + 1) ** (-mm - 2) - nn * (nn + 1) * (x + 1) ** (-nn - 2))
            energy = A * ((x + 1) ** (1 - mm) / (mm - 1) - (x + 1) ** (1 - nn) / (nn - 1))
            size = float((m - 1) * (n - 1) * (x + 1) ** -m if x < 0 else (m - 1) * (n - 1) * (x + 1) ** -n)
            size *= 1.0 + abs(math.log1p(H))
            here = np.array(H)
            for value, true, factor in [
                (law.traction(here), p(x), 1.0),
                (law.slope(here), slope, (m + 1) / (H + 1)),
                (law.curvature(here), curvature, (m + 1) * (m + 2) / (H + 1) ** 2),
                (law.energy(here), energy, (H + 1) * 1.0 / (n - 1)),
            ]:
                assert abs(float(value - true)) <= ROUNDING * size * factor * (1.0 + m * abs(math.log1p(H)))


@pytest.mark.parametrize("law", [LennardJones(), *(Mie(m=m, n=n) for m, n in EXPONENTS)])
def test_normalisation_peak_and_tail(law):
    assert isinstance(law, SurfaceLaw)
    assert float(law.traction(np.array(0.0))) == 0.0
    assert float(law.energy(np.array(0.0))) == pytest.approx(-1.0, rel=1e-15)
    peak = np.array(law.peak_gap)
    assert abs(float(law.slope(peak))) <= 1e-13 * float(law.curvature(peak))
    C, m = law.decay
    if (C, m) == (8 / 3, 3.0) or (m > 2 and law.m - m > 1):
        far = np.array(1e9)
        assert float(law.traction(far) * far**m) == pytest.approx(-C, rel=1e-7)


def test_nine_three_is_recovered_to_rounding():
    lj, mie = LennardJones(), Mie(m=9, n=3)
    for name in ("traction", "slope", "curvature", "energy"):
        # Powers by multiplication against powers by logarithm: measured worst 9 eps on -0.7 < H < 20; only
        # the traction is written so that it keeps its relative accuracy at its zero.
        atol = 0.0 if name == "traction" else 1e-14
        np.testing.assert_allclose(getattr(mie, name)(GAPS), getattr(lj, name)(GAPS), rtol=9e-15, atol=atol)
    assert mie.peak_gap == pytest.approx(lj.peak_gap, rel=1e-15)
    assert mie.decay == lj.decay
    assert mie.singular_gap == lj.singular_gap


@given(st.floats(1.01, 20.0), st.floats(1e-6, 20.0))
def test_every_mie_law_has_one_well(n, excess):
    law = Mie(m=n + excess, n=n)
    H = np.linspace(-0.5, 5.0, 400)
    p = law.traction(H)
    assert np.all(p[H < 0] > 0)
    assert np.all(p[H > 0] < 0)
    away = np.abs(H - law.peak_gap) > 1e-6
    assert np.all((law.slope(H) < 0)[away] == (law.peak_gap > H)[away])


@pytest.mark.parametrize(
    ("m", "n"),
    [
        (3, 9),
        (3, 3),
        (9, 1),
        (9, 0.5),
        (9, -1),
        (math.nan, 3),
        (9, math.nan),
        (math.inf, 3),
        ("9", 3),
        (9, True),
        (9j, 3),
    ],
)
def test_bad_exponents_are_refused_in_one_sentence(m, n):
    with pytest.raises(ValueError, match="exponent") as caught:
        Mie(m=m, n=n)
    assert "\n" not in str(caught.value)


def test_laws_are_values():
    assert Mie(m=9, n=3) == Mie(m=9.0, n=np.float64(3.0))
    assert hash(Mie(m=9, n=3)) == hash(Mie(m=9.0, n=3.0))
    assert pickle.loads(pickle.dumps(Mie(m=12, n=6))) == Mie(m=12, n=6)
    assert pickle.loads(pickle.dumps(LennardJones())) == LennardJones()


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_no_traction_at_the_singular_gap_and_below():
    law = Mie(m=12, n=6, z0=0.5)
    for function in (law.traction, law.slope, law.curvature, law.energy):
        values = function(np.array([-1.0, -0.5, -0.4]))
        assert np.isnan(values).tolist() == [True, True, False]


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_law_without_traction_below_its_singular_gap_is_solved_as_one_that_has_it():
    """Under a sharp edge trial gaps are below it: between the nodes of a coarse mesh and behind a long step."""
    force, lennard_jones = (
        solve(Problem(8, 0, 257, law=law), "pull_off_force") for law in (Mie(m=9, n=3), LennardJones())
    )
    assert abs(force.value - lennard_jones.value) <= force.u_num + lennard_jones.u_num
