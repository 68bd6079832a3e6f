"""Physical units: Eqs. 1, 7, 29-31, and the independence of the choice of units."""

import math
import pickle

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fscm._response_factor import response_factor, response_factor_per_rest
from fscm.laws import Mie
from fscm.physical import PhysicalProblem
from fscm.problem import Problem
from fscm.punch import RoundedCone

EPS = np.finfo(float).eps
# Logarithms of SI sizes reach 100, divided by 2n + k - 1 >= 0.4: their rounding is worth 100 eps / 0.4 in mu.
LOG_ROUNDING = 1000 * EPS

SPHERE = {
    "E0": 70e9,
    "c0": 1e-6,
    "k": 0.4,
    "nu": 0.2,
    "Q": 1e-6,
    "n": 2.0,
    "work_of_adhesion": 0.05,
    "z0": 3e-10,
}


def printed_b(k, nu):
    """Eq. 7 as printed, in extended precision."""
    k, nu = mpmath.mpf(k), mpmath.mpf(nu)
    q = mpmath.sqrt((1 + k) * (1 - k * nu / (1 - nu)))
    front = 2 ** (k + 1) * (k + 2) * q * mpmath.sin(q * mpmath.pi / 2) / (k * (k + 1) * mpmath.beta(k / 2, 0.5))
    return front * mpmath.beta((3 + k + q) / 2, (3 + k - q) / 2)


@pytest.mark.parametrize("nu", [0.0, 0.1, 0.3, 0.45, 0.4999999, 0.5])
@pytest.mark.parametrize("k", [1e-300, 1e-12, 1e-8, 1e-3, 0.1, 0.4, 0.8, 0.95, 0.999, 1 - 1e-9])
def test_response_factor_is_eq_7(k, nu):
    with mpmath.workdps(340 if k < 1e-100 else 40):
        b = printed_b(k, nu)
        # A dozen roundings, amplified by gamma functions of arguments up to 4; measured worst 9 eps.
        assert response_factor(k, nu) == pytest.approx(float(b), rel=30 * EPS)
        assert response_factor_per_rest(k, nu) == pytest.approx(float(b / (1 - mpmath.mpf(k))), rel=30 * EPS)


@pytest.mark.parametrize("nu", [0.0, 0.25, 0.49])
def test_homogeneous_limit_is_one_and_continuous(nu):
    assert response_factor(0.0, nu) == 1.0
    for k in (1e-12, 1e-8, 1e-3):
        assert abs(response_factor(k, nu) - 1.0) < 3.0 * k + 10 * EPS


def test_gibson_limit():
    assert response_factor(1.0, 0.5) == 0.0
    assert response_factor_per_rest(1.0, 0.5) == 1.0
    # The limit is reached along k = 2 (1 - nu) - 1 + ..., not on every path: only 1 - 2 nu = o(1 - k) gives
    # 1.
    for e in (1e-3, 1e-6, 1e-9):
        assert response_factor_per_rest(1 - e, 0.5) == pytest.approx(1.0, abs=2 * e)


def test_tabor_number_of_a_homogeneous_sphere_is_eq_1():
    sphere = PhysicalProblem(**{**SPHERE, "k": 0.0})
    E = sphere.contact_modulus
    assert pytest.approx(70e9 / (1 - 0.04)) == E
    assert sphere.tabor_number == pytest.approx((1e-6 * 0.05**2 / (E**2 * 3e-10**3)) ** (1 / 3), rel=LOG_ROUNDING)
    assert sphere.tabor_number_jin == pytest.approx(sphere.tabor_number, rel=LOG_ROUNDING)
    # k = 0 forgets the reference depth
    assert PhysicalProblem(**{**SPHERE, "k": 0.0, "c0": 7.0}).tabor_number == sphere.tabor_number


@pytest.mark.parametrize(("n", "k", "nu"), [(1.0, 0.2, 0.0), (2.0, 0.4, 0.3), (5.0, 0.8, 0.45), (1.5, 1.0, 0.5)])
def test_tabor_numbers_are_eqs_29_and_30(n, k, nu):
    p = PhysicalProblem(E0=3.0, c0=0.7, k=k, nu=nu, Q=1.3, n=n, work_of_adhesion=0.4, z0=0.2)
    E, s = 3.0 / (1 - nu**2), 2 * n + k - 1
    ratio = 1.0 if k == 1 else float(printed_b(k, nu)) / (1 - k)
    mu = (1.3 ** (1 - k) * 0.7 ** (n * k) * 0.4**n * ratio**n / (E**n * 0.2**s)) ** (1 / s)
    assert p.tabor_number == pytest.approx(mu, rel=1e-13)
    assert p.tabor_number_jin == pytest.approx(mu * ratio ** (-n / s), rel=1e-13)


def test_compliance_is_the_factor_of_eq_20_in_dimensionless_form():
    p = PhysicalProblem(**SPHERE)
    # 2 b c0^k length_r^(1-k) / (E* (1-k)) times traction / z0
    factor = 2 * p.response_factor * p.c0**p.k * p.length_r ** (1 - p.k) / (p.contact_modulus * (1 - p.k))
    assert p.problem().compliance == pytest.approx(factor * p.scales["traction"] / p.length_z, rel=1e-12)


def test_scales_are_eqs_25_27_and_31():
    p = PhysicalProblem(**SPHERE)
    R, w, z0 = 1e-6, 0.05, 3e-10
    expected = {
        "displacement": z0,
        "gap": z0,
        "radius": math.sqrt(R * z0),
        "traction": w / z0,
        "load": math.pi * R * w,
        "energy": math.pi * R * w * z0,
        "stiffness": math.pi * R * w / z0,
        "energy_per_area": w,
    }
    assert dict(p.scales) == pytest.approx(expected, rel=LOG_ROUNDING)
    assert (p.length_z, p.length_r) == (p.scales["gap"], p.scales["radius"])
    for kind, scale in expected.items():
        assert p.from_dimensionless(kind, 3.0) == pytest.approx(3.0 * scale, rel=LOG_ROUNDING)
        values = np.array([-1.0, 0.0, 2.5])
        back = p.to_dimensionless(kind, p.from_dimensionless(kind, values))
        np.testing.assert_allclose(back, values, rtol=4 * EPS)


sizes = st.floats(1e-3, 1e3)
units = st.floats(1e-9, 1e9)


@given(
    st.floats(0.7, 8.0),
    st.floats(0.0, 0.99),
    st.floats(0.0, 0.49),
    sizes,
    sizes,
    sizes,
    sizes,
    sizes,
    units,
    units,
)
def test_units_do_not_move_anything_dimensionless(n, k, nu, E0, c0, Q, w, z0, metre, pascal):
    ours = PhysicalProblem(E0, c0, k, nu, Q, n, w, z0)
    theirs = PhysicalProblem(E0 * pascal, c0 * metre, k, nu, Q * metre ** (n - 1), n, w * pascal * metre, z0 * metre)
    assert theirs.tabor_number == pytest.approx(ours.tabor_number, rel=1e-11)
    assert theirs.tabor_number_jin == pytest.approx(ours.tabor_number_jin, rel=1e-11)
    dimension = {
        "displacement": metre,
        "gap": metre,
        "radius": metre,
        "traction": pascal,
        "load": pascal * metre**2,
        "energy": pascal * metre**3,
        "stiffness": pascal * metre,
        "energy_per_area": pascal * metre,
    }
    for kind, factor in dimension.items():
        assert theirs.to_dimensionless(kind, 2.0 * factor) == pytest.approx(ours.to_dimensionless(kind, 2.0), rel=1e-11)


@given(
    st.floats(0.7, 8.0),
    st.floats(0.0, 0.99),
    st.floats(1e-3, 20.0),
    st.floats(0.0, 0.49),
    sizes,
    sizes,
    sizes,
    sizes,
)
def test_a_problem_and_scales_make_a_physical_problem_and_back(n, k, mu, nu, c0, Q, w, z0):
    problem = Problem(n, k, mu)
    physical = PhysicalProblem.from_problem(problem, c0=c0, nu=nu, Q=Q, work_of_adhesion=w, z0=z0)
    assert physical.tabor_number == pytest.approx(mu, rel=1e-12)
    back = physical.problem()
    assert (back.n, back.k, back.punch, back.law) == (n, k, problem.punch, problem.law)


def test_gibson_solid_round_trip():
    physical = PhysicalProblem.from_problem(Problem(2, 1, 0.8), c0=2.0, nu=0.5, Q=1.0, work_of_adhesion=0.1, z0=0.01)
    assert physical.tabor_number == pytest.approx(0.8, rel=1e-13)
    # Eq. 28 for k = 1 is w = 2 mu^2 p; in physical terms w = 2 c0 p / E* = (3/2) c0 p / E0.
    w = physical.from_dimensionless("displacement", 2 * 0.8**2)
    assert w == pytest.approx(1.5 * 2.0 / physical.E0 * physical.scales["traction"], rel=1e-13)


def test_profile_and_law_travel_along():
    physical = PhysicalProblem(**{**SPHERE, "n": 1.0})
    problem = physical.problem(RoundedCone(0.3), Mie(12, 6))
    assert (problem.punch, problem.law) == (RoundedCone(0.3), Mie(12, 6))


BAD = [math.nan, math.inf, -1.0, "1", True, 1j, None]


@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize("name", list(SPHERE))
def test_bad_input_is_refused_by_name(name, bad):
    with pytest.raises(ValueError, match=f"^{name} = ") as caught:
        PhysicalProblem(**{**SPHERE, name: bad})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["E0", "c0", "Q", "n", "work_of_adhesion", "z0"])
def test_zero_is_refused(name):
    with pytest.raises(ValueError, match=f"^{name} = 0 is outside \\(0, inf\\)"):
        PhysicalProblem(**{**SPHERE, name: 0})


@pytest.mark.parametrize(("k", "nu"), [(1.0, 0.3), (1.0, 0.0)])
def test_k_1_means_an_incompressible_solid(k, nu):
    with pytest.raises(ValueError, match="Gibson"):
        PhysicalProblem(**{**SPHERE, "k": k, "nu": nu})


@pytest.mark.parametrize("k", [0.0, 0.4, 0.9])
def test_an_incompressible_solid_is_the_limit_of_compressible_ones(k):
    """Rubber: the response of Eq. 7 has no singularity at nu = 1/2 for k < 1."""
    rubber = PhysicalProblem(**{**SPHERE, "k": k, "nu": 0.5})
    near = PhysicalProblem(**{**SPHERE, "k": k, "nu": 0.5 - 1e-9})
    assert rubber.tabor_number == pytest.approx(near.tabor_number, rel=1e-7)
    assert rubber.contact_modulus == pytest.approx(SPHERE["E0"] / 0.75, rel=1e-15)
    assert rubber.response_factor == pytest.approx(float(printed_b(k, 0.5)) if k else 1.0, rel=30 * EPS)


def test_other_refusals():
    with pytest.raises(ValueError, match=r"Eq\. 29"):
        PhysicalProblem(**{**SPHERE, "n": 0.3})
    with pytest.raises(ValueError, match="check the units"):
        PhysicalProblem(**{**SPHERE, "Q": 1e300, "n": 0.5})
    with pytest.raises(ValueError, match="check the units"):
        PhysicalProblem.from_problem(Problem(2, 0, 1e-9), c0=1, nu=0.3, Q=1, work_of_adhesion=1e300, z0=1)
    with pytest.raises(ValueError, match="kind = 'force'"):
        PhysicalProblem(**SPHERE).to_dimensionless("force", 1.0)


def test_a_physical_problem_is_a_value():
    physical = PhysicalProblem(**SPHERE)
    assert pickle.loads(pickle.dumps(physical)) == physical
    assert hash(PhysicalProblem(**SPHERE)) == hash(physical)
