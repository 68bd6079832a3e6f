"""Surface laws of the finite elements: closed forms, laws through points, refused data."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from fem_reference import LennardJones, Mie, SurfaceLaw, TabulatedLaw

WORK, RANGE = 0.05, 3e-10
LJ = LennardJones(WORK, RANGE)


def _points(law, count=120, last=20.0):
    gap = np.geomspace(0.75, last, count) * RANGE
    return gap, law.traction(gap - RANGE)


TABLE = TabulatedLaw(*_points(LJ), z0=RANGE, tail_exponent=3.0)
LAWS = [LJ, Mie(WORK, RANGE, 12.0, 6.0), Mie(WORK, RANGE, 3.3, 3.0), TABLE]


def test_the_nine_three_law_is_one_of_mie():
    H = RANGE * np.geomspace(0.01, 1e4, 40) - 0.4 * RANGE
    special = Mie(WORK, RANGE, 9.0, 3.0)
    for name in ("traction", "slope", "energy"):
        exact = getattr(LJ, name)(H)
        assert getattr(special, name)(H) == pytest.approx(exact, rel=1e-11, abs=1e-14 * np.abs(exact).max())
    assert special.peak_gap == pytest.approx(LJ.peak_gap, rel=1e-14)
    assert special.decay == pytest.approx(LJ.decay, rel=1e-14)


@pytest.mark.parametrize("law", LAWS)
def test_slope_energy_and_limits_belong_to_the_traction(law):
    assert isinstance(law, SurfaceLaw)
    H, h = RANGE * np.array([-0.2, 0.05, law.peak_gap / RANGE, 1.0, 18.0, 30.0]), 1e-5 * RANGE
    scale = law.work_of_adhesion / RANGE
    slopes = (law.traction(H + h) - law.traction(H - h)) / (2 * h)
    assert slopes == pytest.approx(law.slope(H), rel=2e-8, abs=2e-7 * scale / RANGE)
    tractions = (law.energy(H - h) - law.energy(H + h)) / (2 * h)
    assert tractions == pytest.approx(law.traction(H), rel=2e-8, abs=1e-8 * scale)
    assert float(law.energy(np.array(0.0))) == pytest.approx(-law.work_of_adhesion, rel=1e-12)
    assert abs(float(law.slope(np.array(law.peak_gap)))) <= 1e-9 * scale / RANGE
    C, m = law.decay
    far = 1e7 * RANGE
    assert float(law.traction(np.array(far))) * far**m == pytest.approx(-C, rel=1e-5)


@pytest.mark.parametrize("name", ["traction", "slope", "energy"])
def test_a_law_of_mie_has_no_value_below_its_singular_gap(name):
    """A trial state may have such gaps; Newton's method then stops, and nothing is printed."""
    law = Mie(WORK, RANGE, 12.0, 6.0)
    gap = RANGE * np.array([-2.5, -1.0, -0.5, 0.0])
    assert np.isfinite(getattr(law, name)(gap)).tolist() == [False, False, True, True]


def test_the_energy_is_the_integral_of_the_traction():
    ends = RANGE * np.array([-0.3, 0.0, 1.0, 18.9, 40.0])
    for a, b in pairwise(ends):
        area = quad(lambda x: float(TABLE.traction(np.array(x * RANGE))) * RANGE, a / RANGE, b / RANGE, epsabs=1e-12)[0]
        assert float(TABLE.energy(np.array(a)) - TABLE.energy(np.array(b))) == pytest.approx(area, rel=1e-8)


def test_points_of_the_nine_three_law_give_it_back():
    """The error is that of the spline (degree five) and of the tail, which still has a share of the repulsion."""
    assert TABLE.work_of_adhesion == pytest.approx(WORK, rel=1e-6)
    assert TABLE.peak_gap == pytest.approx(LJ.peak_gap, rel=1e-6)
    H = RANGE * np.geomspace(0.01, 1e3, 40)
    assert TABLE.traction(H) == pytest.approx(LJ.traction(H), rel=1e-5, abs=1e-6 * WORK / RANGE)


def test_a_stated_work_and_another_unit():
    gap, p = _points(LJ)
    twice = TabulatedLaw(gap, p, z0=RANGE, tail_exponent=3.0, work=2.0 * WORK)
    assert twice.work_of_adhesion == pytest.approx(2.0 * WORK, rel=1e-13)
    H = RANGE * np.array([-0.2, 0.3, 5.0, 50.0])
    ratio = 2.0 * WORK / TABLE.work_of_adhesion
    assert twice.traction(H) == pytest.approx(ratio * TABLE.traction(H), rel=1e-12)
    in_nm = TabulatedLaw(gap * 1e9, p * 1e-9, z0=RANGE * 1e9, tail_exponent=3.0)
    assert in_nm.traction(H * 1e9) == pytest.approx(1e-9 * TABLE.traction(H), rel=1e-9)
    assert in_nm.energy(H * 1e9) == pytest.approx(TABLE.energy(H), rel=1e-12)


def test_the_tail_is_fitted_or_absent():
    fitted = TabulatedLaw(*_points(Mie(WORK, RANGE, 12.0, 6.0)), z0=RANGE)
    assert fitted.decay[1] == pytest.approx(6.0, rel=2e-2)
    gap, p = _points(LJ, 60, last=6.0)
    ends = TabulatedLaw(gap, p * (1.0 - (gap / gap[-1]) ** 4) ** 3, z0=RANGE)
    assert ends.decay == (0.0, math.inf)
    assert ends.traction(np.array([gap[-1], 1.0])) == pytest.approx([0.0, 0.0], abs=1e-9)
    assert float(ends.energy(np.array(1.0))) == 0.0


def test_laws_are_data():
    gap, p = _points(LJ)
    again = TabulatedLaw(list(gap), list(p), z0=RANGE, tail_exponent=3.0)
    assert again == TABLE
    assert hash(again) == hash(TABLE)
    assert repr(again).startswith("TabulatedLaw(120 points")


GAP = np.geomspace(0.75, 20.0, 40)
TRACTION = GAP**-9 - GAP**-3
RISING = np.geomspace(0.75, 1.19, 12)


def _changed(values, row, value):
    changed = np.array(values)
    changed[row] = value
    return changed


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Mie(WORK, RANGE, 3.0, 3.0), r"exponent m = 3.0 of the repulsion is outside \(n = 3, infinity\)"),
        (lambda: Mie(WORK, RANGE, 9.0, 1.0), "exponent n = 1.0 of the attraction"),
        (lambda: Mie(0.0, RANGE, 9.0, 3.0), "work of adhesion = 0.0"),
        (lambda: TabulatedLaw(GAP, TRACTION, z0=0.0), "z0 = 0.0 is outside"),
        (lambda: TabulatedLaw(GAP, TRACTION, 1.0, tail_exponent=1.0), "tail_exponent = 1.0 is outside"),
        (lambda: TabulatedLaw(GAP, TRACTION, 1.0, work=-1.0), "work = -1.0 is outside"),
        (lambda: TabulatedLaw(GAP[:9], TRACTION[:9], 1.0), "10 gaps or more"),
        (lambda: TabulatedLaw(["a"] * 12, TRACTION[:12], 1.0), "not two columns of numbers"),
        (lambda: TabulatedLaw(_changed(GAP, 3, math.nan), TRACTION, 1.0), "in row 3 is not finite"),
        (lambda: TabulatedLaw(_changed(GAP, 3, 0.1), TRACTION, 1.0), "in row 3 is not above"),
        (lambda: TabulatedLaw(GAP, -TRACTION, 1.0), "the first must be a compression"),
        (lambda: TabulatedLaw(GAP, _changed(TRACTION, 30, 0.1), 1.0), "change their sign once"),
        (lambda: TabulatedLaw(RISING, RISING**-9 - RISING**-3, 1.0), "change their sign once and then pass"),
        (lambda: TabulatedLaw(GAP, _changed(TRACTION, 20, -0.2), 1.0), "the spline through the points turns"),
        (lambda: TabulatedLaw(GAP, GAP**-9 - GAP**-0.8, 1.0), "the last tractions fall as H"),
    ],
)
def test_impossible_laws_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
