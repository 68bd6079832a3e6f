"""Physical units: Eqs. 1, 7, 29-31, and the independence of the choice of units."""

import math
import pickle
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fscm import (
    CustomPunch,
    Homogeneous,
    Layers,
    LennardJones,
    MeasuredPunch,
    Mie,
    PowerLaw,
    PowerPunch,
    PowerSum,
    Problem,
    RoundedCone,
    TabulatedLaw,
    equilibria,
    profile,
    sensitivity,
    solve,
    solve_together,
    trace,
)
from fscm._response_factor import response_factor, response_factor_per_rest

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


def physical(**changed):
    """The sphere with other parameters."""
    p = {**SPHERE, **changed}
    solid = PowerLaw(p["E0"], p["c0"], p["k"], p["nu"])
    return Problem(solid, PowerPunch(p["n"], p["Q"]), LennardJones(p["work_of_adhesion"], p["z0"]))


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


def test_gibson_limit():
    assert response_factor(1.0, 0.5) == 0.0
    assert response_factor_per_rest(1.0, 0.5) == 1.0
    # The limit is reached along k = 2 (1 - nu) - 1 + ..., not on every path: only 1 - 2 nu = o(1 - k) gives
    # 1.
    for e in (1e-3, 1e-6, 1e-9):
        assert response_factor_per_rest(1 - e, 0.5) == pytest.approx(1.0, abs=2 * e)


def test_tabor_number_of_a_homogeneous_sphere_is_eq_1():
    sphere = physical(k=0.0)
    E = sphere.solid.contact_modulus
    assert pytest.approx(70e9 / (1 - 0.04)) == E
    assert sphere.mu == pytest.approx((1e-6 * 0.05**2 / (E**2 * 3e-10**3)) ** (1 / 3), rel=LOG_ROUNDING)
    assert sphere.tabor_number_jin == pytest.approx(sphere.mu, rel=LOG_ROUNDING)
    # k = 0 forgets the reference depth
    assert physical(k=0.0, c0=7.0).mu == sphere.mu
    assert Problem(Homogeneous(70e9, 0.2), sphere.punch, sphere.law).dimensionless == sphere.dimensionless


@pytest.mark.parametrize(("n", "k", "nu"), [(1.0, 0.2, 0.0), (2.0, 0.4, 0.3), (5.0, 0.8, 0.45), (1.5, 1.0, 0.5)])
def test_tabor_numbers_are_eqs_29_and_30(n, k, nu):
    p = physical(E0=3.0, c0=0.7, k=k, nu=nu, Q=1.3, n=n, work_of_adhesion=0.4, z0=0.2)
    E, s = 3.0 / (1 - nu**2), 2 * n + k - 1
    ratio = 1.0 if k == 1 else float(printed_b(k, nu)) / (1 - k)
    mu = (1.3 ** (1 - k) * 0.7 ** (n * k) * 0.4**n * ratio**n / (E**n * 0.2**s)) ** (1 / s)
    assert p.mu == pytest.approx(mu, rel=1e-13)
    assert p.tabor_number_jin == pytest.approx(mu * ratio ** (-n / s), rel=1e-13)


def test_compliance_is_the_factor_of_eq_20_in_dimensionless_form():
    p = physical()
    solid, units = p.solid, p.units
    # 2 b c0^k r^(1-k) / (E* (1-k)) times traction / z0, r: unit of the radii
    response = 2 * solid.response_factor * solid.c0**p.k * units["radius"] ** (1 - p.k) / (1 - p.k)
    factor = response / solid.contact_modulus * units["traction"] / units["gap"]
    assert p.dimensionless.compliance == pytest.approx(factor, rel=1e-12)
    with pytest.raises(ValueError, match="physical units"):
        p.compliance  # noqa: B018  (the property refuses)


def test_units_are_eqs_25_27_and_31():
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
        "number": 1.0,
    }
    assert dict(physical().units) == pytest.approx(expected, rel=LOG_ROUNDING)
    assert set(Problem(2, 0.4, 1.0).units.values()) == {1.0}


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
    ours = Problem(PowerLaw(E0, c0, k, nu), PowerPunch(n, Q), LennardJones(w, z0))
    law = LennardJones(w * pascal * metre, z0 * metre)
    theirs = Problem(PowerLaw(E0 * pascal, c0 * metre, k, nu), PowerPunch(n, Q * metre ** (n - 1)), law)
    assert theirs.mu == pytest.approx(ours.mu, rel=1e-11)
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
        assert theirs.units[kind] == pytest.approx(ours.units[kind] * factor, rel=1e-11)


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
    scaled = problem.in_units(c0=c0, nu=nu, Q=Q, work_of_adhesion=w, z0=z0)
    assert scaled.mu == pytest.approx(mu, rel=1e-12)
    back = scaled.dimensionless
    assert (back.n, back.k, back.punch, back.law) == (n, k, problem.punch, problem.law)


def test_gibson_solid_round_trip():
    scaled = Problem(2, 1, 0.8).in_units(c0=2.0, nu=0.5, Q=1.0, work_of_adhesion=0.1, z0=0.01)
    assert scaled.mu == pytest.approx(0.8, rel=1e-13)
    # Eq. 28 for k = 1 is w = 2 mu^2 p; in physical terms w = 2 c0 p / E* = (3/2) c0 p / E0.
    w = 2 * 0.8**2 * scaled.units["displacement"]
    assert w == pytest.approx(1.5 * 2.0 / scaled.solid.E0 * scaled.units["traction"], rel=1e-13)


def test_results_have_the_units_of_the_problem():
    """A stiff and a soft sphere in micrometres and pascals against their dimensionless problems."""
    p = physical(E0=2e9, k=0.0, work_of_adhesion=0.2)
    core, units = p.dimensionless, p.units
    kinds = {"pull_off_force": "load", "jump_in_gap": "gap", "hysteresis_energy": "energy"}
    both = solve_together(p, kinds), solve_together(core, kinds)
    for name, kind in kinds.items():
        ours, plain = (solutions[name] for solutions in both)
        assert (ours.value, ours.u_num) == pytest.approx((plain.value * units[kind], plain.u_num * units[kind]))
    assert solve(p, "pull_off_force").value == both[0]["pull_off_force"].value
    ours, plain = trace(p, max_load=0.0), trace(core, max_load=0.0)
    for name, kind in (("central_gap", "gap"), ("load", "load"), ("energy", "energy"), ("edge_radius", "radius")):
        np.testing.assert_allclose(getattr(ours, name), getattr(plain, name) * units[kind], rtol=1e-14)
    assert ours.u_load == plain.u_load * units["load"]
    assert [fold.load for fold in ours.folds] == pytest.approx([fold.load * units["load"] for fold in plain.folds])
    ours, plain = profile(p), profile(core)
    np.testing.assert_allclose(ours.pressure, plain.pressure * units["traction"], rtol=1e-14)
    np.testing.assert_allclose(ours.gap, plain.gap * units["gap"], rtol=1e-14)
    ours, plain = (equilibria(of, "load", -1.2 * of.units["load"]) for of in (p, core))
    assert [x.displacement for x in ours] == pytest.approx([x.displacement * units["gap"] for x in plain], rel=1e-9)
    assert ours[0].stability.stiffness == pytest.approx(plain[0].stability.stiffness * units["stiffness"], rel=1e-6)


def test_the_change_of_a_value_contains_that_of_its_unit():
    rates = sensitivity(physical(), "pull_off_force")
    perturbed = physical(Q=1.0001e-6)
    expected = solve(perturbed, "pull_off_force").value - rates.solution.value
    assert rates.change(perturbed) == pytest.approx(expected, rel=1e-3)


RADIUS, Z0 = 1e-6, 3e-10
SAME_SHAPES = [
    PowerSum([0.5 / RADIUS], [2.0]),
    CustomPunch(lambda r: r**2 / (2.0 * RADIUS), growth=2.0),
    CustomPunch(lambda r: r**2 / (2.0 * RADIUS), growth=2.0, derivative=lambda r: r / RADIUS),
]


@pytest.mark.parametrize("punch", SAME_SHAPES, ids=["sum", "function", "derivative"])
def test_a_sphere_in_another_form_has_the_same_force(punch):
    solid, law = Homogeneous(70e9, 0.2), LennardJones(0.05, Z0)
    expected = solve(Problem(solid, PowerPunch(2.0, RADIUS), law), "pull_off_force", 1e-6)
    force = solve(Problem(solid, punch, law), "pull_off_force", 1e-6)
    assert force.value == pytest.approx(expected.value, abs=force.u_num + expected.u_num)


def test_the_unit_of_the_radii_changes_no_result():
    """A profile and a rounded cone, whose own units of radii differ by decades, against shapes without a unit."""

    class Bare:
        """The shape alone."""

        def __init__(self, punch):
            self.growth, self.height, self.slope = punch.growth, punch.height, punch.slope
            self.kinks = getattr(punch, "kinks", ())

    solid, law = Homogeneous(70e9, 0.2), Mie(0.05, Z0, m=12, n=6)
    for punch in (RoundedCone(2e-7, 0.4), MeasuredPunch([0.0, 1e-7, 2e-6], [0.0, 4e-9, 1e-6])):
        own, bare = (Problem(solid, shape, law) for shape in (punch, Bare(punch)))
        assert own.units["load"] != pytest.approx(bare.units["load"], rel=1e-3)
        forces = [solve(problem, "pull_off_force", 1e-6) for problem in (own, bare)]
        assert forces[0].value == pytest.approx(forces[1].value, abs=forces[0].u_num + forces[1].u_num)


def test_the_range_of_a_table_changes_no_force():
    gaps = np.geomspace(0.75, 20.0, 100) * Z0
    tractions = LennardJones(0.05, Z0).traction(gaps - Z0)
    solid, punch = Homogeneous(70e9, 0.2), PowerPunch(2.0, RADIUS)
    forces = [
        solve(Problem(solid, punch, TabulatedLaw(gaps, tractions, z0, tail_exponent=3)), "pull_off_force", 1e-6).value
        for z0 in (Z0, 2.0 * Z0)
    ]
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)


class OwnLaw:
    """The 9-3 law without the methods that convert it."""

    def __init__(self, law):
        names = ("work_of_adhesion", "z0", "singular_gap", "peak_gap", "decay", "traction", "slope", "curvature")
        for name in (*names, "energy"):
            setattr(self, name, getattr(law, name))


def test_a_law_of_ones_own_is_scaled():
    solid, punch, law = Homogeneous(70e9, 0.2), PowerPunch(2.0, RADIUS), LennardJones(0.05, Z0)
    forces = [solve(Problem(solid, punch, same_law), "pull_off_force", 1e-6) for same_law in (law, OwnLaw(law))]
    assert forces[0].value == pytest.approx(forces[1].value, abs=forces[0].u_num + forces[1].u_num)


class Weaker(LennardJones):
    """A law that overrides another one."""

    def traction(self, H):
        return 0.5 * super().traction(H)


def test_a_subclass_stays_another_law():
    law = Weaker(0.05, Z0)
    core = Problem(Homogeneous(70e9, 0.2), PowerPunch(2.0, RADIUS), law).dimensionless
    assert float(core.law.traction(np.array(1.0))) == pytest.approx(0.5 * float(LennardJones().traction(np.array(1.0))))
    assert core.law != LennardJones()


def test_a_dimensionless_problem_takes_dimensionless_parts():
    with pytest.raises(ValueError, match="range 3e-10"):
        Problem(2, 0, 1.0, law=LennardJones(0.05, 3e-10))
    with pytest.raises(ValueError, match="does not fit"):
        Problem(2, 0, 1.0, punch=PowerPunch(2, Q=1e-6))
    with pytest.raises(ValueError, match="physical problem"):
        replace(physical(), mu=2.0)
    with pytest.raises(ValueError, match="is no solid"):
        Problem(solid=1e9, punch=PowerPunch(2, 1e-6), law=LennardJones(0.05, 3e-10))


BAD = [math.nan, math.inf, -1.0, "1", True, 1j, None]
POSITIVE = ("E0", "c0", "Q", "n", "work_of_adhesion", "z0")


@pytest.mark.parametrize(
    ("name", "bad"), [(name, bad) for name in SPHERE for bad in BAD] + [(name, 0.0) for name in POSITIVE]
)
def test_bad_input_is_refused_by_name(name, bad):
    with pytest.raises(ValueError, match=rf"^[\w ]*\b{name} = ") as caught:
        physical(**{name: bad})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("k", "nu"), [(1.0, 0.3), (1.0, 0.0)])
def test_k_1_means_an_incompressible_solid(k, nu):
    with pytest.raises(ValueError, match="Gibson"):
        physical(k=k, nu=nu)


def test_other_refusals():
    with pytest.raises(ValueError, match=r"Eq\. 29"):
        physical(n=0.3)
    with pytest.raises(ValueError, match="check the units"):
        physical(Q=1e300, n=0.5)
    with pytest.raises(ValueError, match="check the units"):
        Problem(2, 0, 1e-9).in_units(c0=1, nu=0.3, Q=1, work_of_adhesion=1e300, z0=1)
    with pytest.raises(ValueError, match="three numbers"):
        Problem(2, 0, 1.0, law=Mie(m=12, n=6)).in_units(c0=1, nu=0.3, Q=1, work_of_adhesion=1, z0=1)


@pytest.mark.parametrize("solid", [PowerLaw(1.0, 1.0, 0.4, 0.3), Layers([1.0, 2.0], [0.3, 0.3], [1.0])])
def test_a_physical_problem_is_a_value(solid):
    problems = [Problem(solid, PowerPunch(2.0, 1.0), LennardJones()) for _ in range(2)]
    assert pickle.loads(pickle.dumps(problems[0])) == problems[1]
    assert hash(problems[0]) == hash(problems[1])
    assert problems[0] != Problem(solid, PowerPunch(2.0, 2.0), LennardJones())
