"""Physical units: Eqs. 1, 7, 29-31, and the independence of the choice of units."""

import math
import pickle
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from hypothesis import given, reject
from hypothesis import strategies as st

import fscm
from fscm._response_factor import response_factor, response_factor_per_rest
from tests.refusals import refused

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
    solid = fscm.PowerLaw(p["E0"], p["c0"], p["k"], p["nu"])
    return fscm.Problem(solid, fscm.PowerPunch(p["n"], p["Q"]), fscm.LennardJones(p["work_of_adhesion"], p["z0"]))


def printed_b(k, nu):
    """Eq. 7 as printed, in extended precision."""
    k, nu = mpmath.mpf(k), mpmath.mpf(nu)
    q = mpmath.sqrt((1 + k) * (1 - k * nu / (1 - nu)))
    front = 2 ** (k + 1) * (k + 2) * q * mpmath.sin(q * mpmath.pi / 2) / (k * (k + 1) * mpmath.beta(k / 2, 0.5))
    return front * mpmath.beta((3 + k + q) / 2, (3 + k - q) / 2)


@pytest.mark.parametrize("k", [1e-300, 1e-12, 1e-3, 0.1, 0.4, 0.8, 0.999, 1 - 1e-9])
def test_response_factor_is_eq_7(k):
    for nu in (0.0, 0.3, 0.4999999, 0.5):
        with mpmath.workdps(340 if k < 1e-100 else 40):
            b = printed_b(k, nu)
            # A dozen roundings, amplified by gamma functions of arguments up to 4; measured worst 9 eps.
            assert response_factor(k, nu) == pytest.approx(float(b), rel=30 * EPS)
            assert response_factor_per_rest(k, nu) == pytest.approx(float(b / (1 - mpmath.mpf(k))), rel=30 * EPS)


def test_a_homogeneous_solid_forgets_the_reference_depth():
    sphere = physical(k=0.0)
    assert physical(k=0.0, c0=7.0).mu == sphere.mu
    assert fscm.Problem(fscm.Homogeneous(70e9, 0.2), sphere.punch, sphere.law).dimensionless == sphere.dimensionless


@pytest.mark.parametrize(
    ("n", "k", "nu"), [(2.0, 0.0, 0.2), (1.0, 0.2, 0.0), (2.0, 0.4, 0.3), (5.0, 0.8, 0.45), (1.5, 1.0, 0.5)]
)
def test_tabor_numbers_are_eqs_29_and_30(n, k, nu):
    p = physical(E0=3.0, c0=0.7, k=k, nu=nu, Q=1.3, n=n, work_of_adhesion=0.4, z0=0.2)
    E, s = 3.0 / (1 - nu**2), 2 * n + k - 1
    ratio = 1.0 if k in (0, 1) else float(printed_b(k, nu)) / (1 - k)
    mu = (1.3 ** (1 - k) * 0.7 ** (n * k) * 0.4**n * ratio**n / (E**n * 0.2**s)) ** (1 / s)
    assert p.mu == pytest.approx(mu, rel=1e-13)
    assert p.tabor_number_jin == pytest.approx(mu * ratio ** (-n / s), rel=1e-13)
    again = p.dimensionless.in_units(c0=0.7, nu=nu, Q=1.3, work_of_adhesion=0.4, z0=0.2)
    assert pytest.approx(3.0, rel=1e-12) == again.solid.E0


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
    assert set(fscm.Problem(2, 0.4, 1.0).units.values()) == {1.0}


sizes = st.floats(1e-3, 1e3)
units = st.floats(1e-9, 1e9)
EXPONENTS = {"n": st.floats(0.7, 8.0), "k": st.floats(0.0, 0.99), "nu": st.floats(0.0, 0.49)}


@given(**EXPONENTS, E0=sizes, c0=sizes, Q=sizes, w=sizes, z0=sizes, metre=units, pascal=units)
def test_units_do_not_move_anything_dimensionless(n, k, nu, E0, c0, Q, w, z0, metre, pascal):
    try:
        ours = fscm.Problem(fscm.PowerLaw(E0, c0, k, nu), fscm.PowerPunch(n, Q), fscm.LennardJones(w, z0))
    except ValueError:
        # Beyond the range of the measure of softness, which has no units.
        reject()
    law = fscm.LennardJones(w * pascal * metre, z0 * metre)
    theirs = fscm.Problem(fscm.PowerLaw(E0 * pascal, c0 * metre, k, nu), fscm.PowerPunch(n, Q * metre ** (n - 1)), law)
    assert theirs.mu == pytest.approx(ours.mu, rel=1e-11)
    assert theirs.tabor_number_jin == pytest.approx(ours.tabor_number_jin, rel=1e-11)
    for kind, factor in (("radius", metre), ("load", pascal * metre**2), ("energy", pascal * metre**3)):
        assert theirs.units[kind] == pytest.approx(ours.units[kind] * factor, rel=1e-11)


def test_results_have_the_units_of_the_problem():
    """A soft sphere in micrometres and pascals against its dimensionless problem."""
    p = physical(E0=2e10, k=0.0, work_of_adhesion=0.2)
    core, units = p.dimensionless, p.units
    kinds = {"pull_off_force": "load", "jump_in_gap": "gap", "hysteresis_energy": "energy"}
    in_units, plain = fscm.solve_together(p, kinds), fscm.solve_together(core, kinds)
    for name, kind in kinds.items():
        expected = plain[name].value * units[kind], plain[name].u_num * units[kind]
        assert (in_units[name].value, in_units[name].u_num) == pytest.approx(expected)
    path, plain = (fscm.trace(posed, "quick", max_load=0.0) for posed in (p, core))
    for name, kind in (("central_gap", "gap"), ("load", "load"), ("energy", "energy"), ("edge_radius", "radius")):
        np.testing.assert_allclose(getattr(path, name), getattr(plain, name) * units[kind], rtol=1e-14)
    assert path.u_load == plain.u_load * units["load"]
    assert [fold.load for fold in path.folds] == pytest.approx([fold.load * units["load"] for fold in plain.folds])
    surface, plain = (fscm.profile(posed, accuracy="quick") for posed in (p, core))
    np.testing.assert_allclose(surface.pressure, plain.pressure * units["traction"], rtol=1e-14)
    np.testing.assert_allclose(surface.gap, plain.gap * units["gap"], rtol=1e-14)
    (state, *_), (plain, *_) = (fscm.equilibria(of, "load", -1.2 * of.units["load"]) for of in (p, core))
    assert state.displacement == pytest.approx(plain.displacement * units["gap"], rel=1e-9)
    assert state.stability.stiffness == pytest.approx(plain.stability.stiffness * units["stiffness"], rel=1e-6)


def test_the_text_of_a_problem_has_its_parts_and_that_of_a_sensitivity_its_value():
    problem = physical()
    assert repr(problem.solid) in str(problem)
    assert f"mu = {problem.mu:.6g}" in str(problem)
    assert repr(problem.solid) not in str(problem.dimensionless)
    solved = fscm.sensitivity(physical(k=1.0, nu=0.5), "pull_off_force")
    assert repr(solved.solution) in repr(solved)


def test_the_change_of_a_value_contains_that_of_its_unit():
    rates = fscm.sensitivity(physical(), "pull_off_force")
    perturbed = physical(Q=1.0001e-6)
    expected = fscm.solve(perturbed, "pull_off_force").value - rates.solution.value
    assert rates.change(perturbed) == pytest.approx(expected, rel=1e-3)


RADIUS, Z0 = 1e-6, 3e-10
SOLID, SPHERE_PUNCH, LAW = fscm.Homogeneous(70e9, 0.2), fscm.PowerPunch(2.0, RADIUS), fscm.LennardJones(0.05, Z0)
CUT_GAPS = np.geomspace(0.75, 20.0, 100) * Z0
TRACTIONS = LAW.traction(CUT_GAPS - Z0)


class Bare:
    """The shape of a punch alone."""

    def __init__(self, punch):
        self.growth, self.height, self.slope = punch.growth, punch.height, punch.slope
        self.kinks = getattr(punch, "kinks", ())


class OwnLaw:
    """A law without the methods that convert it."""

    def __init__(self, law):
        names = ("work_of_adhesion", "z0", "singular_gap", "peak_gap", "decay", "traction", "slope", "curvature")
        for name in (*names, "energy"):
            setattr(self, name, getattr(law, name))


ROUNDED, SEGMENTS = fscm.RoundedCone(2e-7, 0.4), fscm.MeasuredPunch([0.0, 1e-7, 2e-6], [0.0, 4e-9, 1e-6])
#: The same punch and law in two forms: other classes, other units of the radii, another range.
SAME = {
    "sum": ((SPHERE_PUNCH, LAW), (fscm.PowerSum([0.5 / RADIUS], [2.0]), LAW)),
    "function": ((SPHERE_PUNCH, LAW), (fscm.CustomPunch(lambda r: r**2 / (2.0 * RADIUS), growth=2.0), LAW)),
    "rounded cone": ((ROUNDED, fscm.Mie(0.05, Z0, m=12, n=6)), (Bare(ROUNDED), fscm.Mie(0.05, Z0, m=12, n=6))),
    "law of one's own": ((SPHERE_PUNCH, LAW), (SPHERE_PUNCH, OwnLaw(LAW))),
    "range": tuple(
        (SPHERE_PUNCH, fscm.TabulatedLaw(CUT_GAPS, TRACTIONS, z0, tail_exponent=3)) for z0 in (Z0, 2.0 * Z0)
    ),
}


@pytest.mark.parametrize("name", SAME)
def test_the_form_of_a_punch_and_of_a_law_changes_no_force(name):
    forces = [fscm.solve(fscm.Problem(SOLID, punch, law), "pull_off_force", 1e-6) for punch, law in SAME[name]]
    # The tail of a table is fitted in units of its range.
    rounding = 1e-6 * forces[0].value if name == "range" else 0.0
    assert abs(forces[0].value - forces[1].value) <= forces[0].u_num + forces[1].u_num + rounding


def test_a_dimensionless_problem_takes_dimensionless_parts():
    refused("range 3e-10", fscm.Problem, 2, 0, 1.0, law=fscm.LennardJones(0.05, 3e-10))
    refused("does not fit", fscm.Problem, 2, 0, 1.0, punch=fscm.PowerPunch(2, Q=1e-6))
    refused("physical problem", replace, physical(), mu=2.0)
    refused("is no solid", fscm.Problem, solid=1e9, punch=fscm.PowerPunch(2, 1e-6), law=fscm.LennardJones(0.05, 3e-10))


BAD = [math.nan, math.inf, -1.0, "1", True, 1j, None]
POSITIVE = ("E0", "c0", "Q", "n", "work_of_adhesion", "z0")


@pytest.mark.parametrize("name", SPHERE)
def test_bad_input_is_refused_by_name(name):
    for bad in [*BAD, 0.0] if name in POSITIVE else BAD:
        refused(rf"^[\w ]*\b{name} = ", physical, **{name: bad})


def test_other_refusals():
    with pytest.raises(ValueError, match="physical units"):
        _ = physical().compliance
    refused("Gibson", physical, k=1.0, nu=0.3)
    refused("check the units", physical, Q=1e300, n=0.5)
    refused("check the units", fscm.Problem(2, 0, 1e-9).in_units, c0=1, nu=0.3, Q=1, work_of_adhesion=1e300, z0=1)
    with pytest.raises(ValueError, match="three numbers"):
        fscm.Problem(2, 0, 1.0, law=fscm.Mie(m=12, n=6)).in_units(c0=1, nu=0.3, Q=1, work_of_adhesion=1, z0=1)


@pytest.mark.parametrize(
    "problem",
    [
        *(
            fscm.Problem(solid, fscm.PowerPunch(2.0, 1.0), fscm.LennardJones())
            for solid in (fscm.PowerLaw(1.0, 1.0, 0.4, 0.3), fscm.Layers([1.0, 2.0], [0.3, 0.3], [1.0]))
        ),
        fscm.Problem(1, 0.4, 1.0, punch=fscm.RoundedCone(0.5), law=fscm.Mie(m=12, n=6)),
    ],
)
def test_a_problem_is_a_value(problem):
    stored = pickle.loads(pickle.dumps(problem))
    assert stored == problem != fscm.Problem(2, 0.4, 1.0)
    assert hash(stored) == hash(problem)
