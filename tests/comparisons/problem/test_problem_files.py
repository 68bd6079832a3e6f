"""Values of problem files: every kind by both solvers, the closed forms, and the contract of the output."""

import json
import math
from itertools import cycle, product
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
import fscm
from comparisons.cli.main import main
from comparisons.model import Result
from comparisons.problem import Problem, Section
from comparisons.problem.punch_shapes import SmoothedProfile
from comparisons.problem.reading import load_problem
from comparisons.problem.variation import problems_of
from comparisons.quantities import QUANTITIES
from comparisons.runs.tasks import evaluate
from tests.paths import PROBLEMS
from tests.refusals import refused

SECTIONS = {
    "solid": {
        "power-law": 'E0 = "1 GPa"\nc0 = "100 nm"\nk = 0.3\nnu = 0.3',
        "homogeneous": 'E = "1 GPa"\nnu = 0.3',
        "offset-power-law": 'E0 = "1 GPa"\nc0 = "100 nm"\nk = 0.3\nz_s = "10 nm"\nnu = 0.3',
        "exponential": 'E_surface = "1 GPa"\nE_depth = "3 GPa"\nlength = "10 nm"\nnu = 0.3',
        "coating": 'E_coating = "1 GPa"\nE_substrate = "3 GPa"\nthickness = "10 nm"\ntransition = "1 nm"\n'
        "nu_coating = 0.4\nnu_substrate = 0.2",
        "layers": 'E = ["1 GPa", "3 GPa", 2e9]\nnu = [0.4, 0.2, 0.3]\nthickness = ["10 nm", 2e-8]',
        "table": 'file = "modulus.csv"',
    },
    "punch": {
        "sphere": 'R = "100 nm"',
        "ball": 'R = "100 nm"',
        "cone": 'half_angle = "70 deg"',
        "power-law": 'n = 3\nQ = "1e4 nm^2"',
        "rounded-cone": 'R = "30 nm"\nslope = 0.5',
        "rounded-flat": 'flat_radius = "5 nm"\nR = "100 nm"',
        "table": 'file = "profile.csv"\ngrowth = 2',
    },
    "law": {
        "lennard-jones-9-3": 'work_of_adhesion = "50 mJ/m^2"\nz0 = "0.4 nm"',
        "mie": 'work_of_adhesion = "50 mJ/m^2"\nz0 = "0.4 nm"\nm = 12\nn = 6',
        "cohesive-exponential": 'work_of_adhesion = "50 mJ/m^2"\nz0 = "0.4 nm"',
        "cohesive-trapezoid": 'work_of_adhesion = "50 mJ/m^2"\nstrength = "100 MPa"\nrise_end = 0.3\nfall_start = 0.6',
        "table": 'file = "law.csv"\ntail_exponent = 3',
    },
}


@pytest.fixture
def written(tmp_path):
    """A function that writes a problem of three kinds with its tables, in one of its texts changed, and reads it."""
    (tmp_path / "modulus.csv").write_text("z [nm],E [GPa],nu\n0,1,0.3\n10,1.5,0.35\n40,3,0.4\n")
    rows = "\n".join(f"{r},{r**2 / 200}" for r in range(0, 41, 2))
    (tmp_path / "profile.csv").write_text(f"r [nm],height [nm]\n{rows}\n")
    gap = np.geomspace(0.3, 8.0, 80) / 0.4
    traction = 50e-3 / 0.4e-9 * (8 / 3) * (gap**-9 - gap**-3)
    rows = np.transpose([0.4 * gap, traction])
    np.savetxt(tmp_path / "law.csv", rows, "%.17g", ",", header="gap [nm],traction [Pa]", comments="")

    def write(old="", new="", **kinds):
        sections = [f'[{name}]\nkind = "{kind}"\n{SECTIONS[name][kind]}\n' for name, kind in kinds.items()]
        (tmp_path / "mine.toml").write_text("\n".join(sections).replace(old, new))
        return load_problem(tmp_path / "mine.toml")

    return write


#: Every punch with every law, on each solid three times.
KINDS = [*zip(cycle(SECTIONS["solid"]), *zip(*product(SECTIONS["punch"], SECTIONS["law"]), strict=True), strict=False)]


@pytest.mark.parametrize(("solid", "punch", "law"), KINDS)
def test_both_solvers_have_the_same_problem(solid, punch, law, written):
    read = written(solid=solid, punch=punch, law=law)
    problem, units = read.posed, read.units
    body = read.build(fem_reference)
    r = np.geomspace(1e-9, 1e-6, 30)
    heights = problem.punch.height(r / units["radius"]) * units["displacement"]
    assert np.allclose(heights, body.punch.height(r), rtol=1e-12, atol=0)
    slopes = problem.punch.slope(r / units["radius"]) * units["displacement"] / units["radius"]
    assert np.allclose(slopes, body.punch.slope(r), rtol=1e-12, atol=0)
    gap = np.array([-0.05, 0.0, 0.2, 1.0, 10.0, 100.0])
    tractions = problem.law.traction(gap) * units["traction"]
    # Two splines through the same points differ by rounding alone, the two fits of the tail by the same.
    assert np.allclose(tractions, body.law.traction(gap * units["gap"]), rtol=1e-7, atol=1e-9 * units["traction"])
    assert math.isclose(body.law.work_of_adhesion, units["energy_per_area"], rel_tol=1e-9)
    if solid not in ("power-law", "homogeneous"):
        z = np.geomspace(1e-10, 1e-6, 30)
        ratio = problem.graded.modulus(z / units["radius"]) / body.solid.modulus(z)
        assert np.allclose(ratio, 1.0, rtol=1e-12)


def test_a_coating_is_sharp_unless_its_transition_is_stated(written):
    read = written('transition = "1 nm"\n', "", solid="coating", punch="sphere", law="mie")
    z = np.array([9.999e-9, 10.001e-9])
    assert read.build(fem_reference).solid.modulus(z).tolist() == [1e9, 3e9]
    assert (read.posed.graded.modulus(z / read.units["radius"])[1] / read.posed.graded.modulus(0.0)) == 3.0


#: Heights of the punches of `SECTIONS` at the radius r in nm, in nm.
HEIGHTS = {
    "sphere": lambda r: r**2 / 200,
    "ball": lambda r: 100 - np.sqrt(100**2 - r**2),
    "cone": lambda r: r / math.tan(math.radians(70)),
    "power-law": lambda r: r**3 / (3 * 1e4),
    "rounded-cone": lambda r: 0.5 * (np.sqrt(r**2 + 15**2) - 15),
    "rounded-flat": lambda r: np.maximum(r - 5, 0) ** 2 / 200,
}


def test_a_punch_has_the_heights_of_its_formula(written):
    r = np.linspace(0.0, 40.0, 30)
    for punch, height in HEIGHTS.items():
        shape = written(solid="homogeneous", punch=punch, law="mie").build(fem_reference).punch
        assert np.allclose(shape.height(1e-9 * r), 1e-9 * height(r), rtol=1e-12, atol=1e-24), punch


def test_the_range_of_a_table_is_the_work_over_the_largest_tension(written):
    """For the 9-3 law this tension is 16 sqrt(3)/27 w/z0."""
    law = written(solid="homogeneous", punch="sphere", law="table").build(fscm).law
    assert law.z0 == pytest.approx(0.4e-9 / (16 * math.sqrt(3) / 27), rel=5e-3)


def test_the_force_of_the_power_law_is_that_of_the_physical_problem(written):
    read = written(solid="power-law", punch="sphere", law="lennard-jones-9-3")
    solid, law = fscm.PowerLaw(1e9, 1e-7, 0.3, 0.3), fscm.LennardJones(0.05, 4e-10)
    physical = fscm.Problem(solid, fscm.PowerPunch(2.0, 1e-7), law)
    expected = fscm.solve(physical.dimensionless, "pull_off_force")
    value = evaluate("fscm", "pull_off_force", read)
    assert (value.status, value.unit) == ("ok", "N")
    assert math.isclose(value.value, expected.value * physical.units["load"], rel_tol=1e-12)
    jkr = evaluate("jkr", "pull_off_force", read)
    assert math.isclose(jkr.value, (3 + 0.3) / 2 * math.pi * 1e-7 * 0.05, rel_tol=1e-12)


def test_a_value_and_its_bound_are_in_the_same_unit(written):
    read = written(solid="power-law", punch="sphere", law="lennard-jones-9-3")
    model = SimpleNamespace(name="mine", version="1", evaluate=lambda problem, name: Result(6.0, 2.0))
    for quantity, row in QUANTITIES.items():
        value, unit = evaluate(model, quantity, read), read.units[row.scale]
        assert (value.value, value.u_num) == pytest.approx((6.0 * unit, 2.0 * unit), rel=1e-14)
        dimensionless = value.dimensionless_value, value.dimensionless_u_num
        assert row.scale == "number" or dimensionless == pytest.approx((6.0, 2.0), rel=1e-14)


@pytest.mark.parametrize("model", ["fscm", "jkr", "md-improved"])
def test_a_homogeneous_solid_and_a_cone_are_power_laws(written, model):
    """E and nu are those of k = 0; r/tan(70 deg) is r^n/(n Q) with n = 1 and Q = tan(70 deg)."""
    read = written(solid="homogeneous", punch="cone", law="lennard-jones-9-3")
    value = evaluate(model, "pull_off_force", read)
    solid = Section("power-law", {"E0": 1e9, "c0": 3e-6, "k": 0.0, "nu": 0.3})
    punch = Section("power-law", {"n": 1.0, "Q": math.tan(math.radians(70))})
    same = evaluate(model, "pull_off_force", Problem(solid, punch, read.law))
    assert value.status == same.status == "ok"
    assert math.isclose(value.value, same.value, rel_tol=1e-12)
    assert value.dimensionless_value is not None


@pytest.mark.parametrize(
    ("model", "quantity", "solid", "reason"),
    [
        ("atlas", "pull_off_force", "coating", "a coating solid"),
        ("fscm", "critical_tabor_number", "coating", "that of a power-law solid"),
        ("fem", "pull_off_force", "exponential", "nu = 0.5"),
    ],
)
def test_what_a_model_does_not_take_is_not_applicable(written, model, quantity, solid, reason):
    value = evaluate(model, quantity, written("nu = 0.3", "nu = 0.5", solid=solid, punch="sphere", law="mie"))
    assert value.status == "not-applicable"
    assert reason in value.reason


def test_entries_of_a_list_count_from_one_and_problems_of_files_stand_after_those_of_the_paper(written):
    file = written(solid="layers", punch="sphere", law="mie")
    assert [file[f"solid.thickness.{number}"] for number in range(4)] == [None, 1e-8, 2e-8, None]
    assert file["solid.thickness"] == (1e-8, 2e-8)
    (varied,) = problems_of(file.path, {"solid.thickness.2": ["30 nm"]})
    assert varied["solid.thickness"] == (1e-8, 3e-8)
    first, second = Problem.dimensionless(1, 0, 5.0), Problem.dimensionless(2, 0, 1.0)
    assert sorted([file, second, first]) == [first, second, file]


def test_the_json_is_the_contract(capsys):
    file = PROBLEMS / "graded_pad.toml"
    command = ["solve", "--model", "jkr", "--quantity", "pull_off_force", "--problem", str(file)]
    assert main([*command, "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    keys = ["model", "quantity", "problem", "value", "u_num", "status", "unit", "seconds", "dimensionless"]
    assert list(content) == [*keys, "assumptions"]
    assert content["unit"] == "N"
    assert content["problem"]["file"] == "graded_pad.toml"
    assert content["problem"]["solid"] == {"kind": "power-law", "E0": 2e9, "c0": 1e-6, "k": 0.4, "nu": 0.3}
    assert math.isclose(content["value"], 1.7 * math.pi * 2.5e-6 * 0.05, rel_tol=1e-12)
    assert content["dimensionless"]["unit"] == "pi Q^(2/n) dgamma z0^(2/n-1)"
    assert main(command) == 0
    assert "-P_c = 667.5884388878" in capsys.readouterr().out


def test_a_noisy_profile_is_smooth():
    rng = np.random.default_rng(1)
    r = np.linspace(0.0, 10.0, 201)
    noise = 0.02
    heights = r**2 / 2 + noise * rng.standard_normal(len(r))
    punch = SmoothedProfile(tuple(r), tuple(heights), smoothing=noise)
    assert float(punch.height(np.zeros(1))[0]) == 0.0
    inside = np.linspace(0.0, 9.99, 77)
    assert np.max(np.abs(punch.height(inside) - inside**2 / 2)) < 2 * noise
    # The slope of straight lines between the noisy points is wrong by 0.5 there.
    assert np.max(np.abs(punch.slope(inside) - inside)) < 0.1
    assert math.isclose(float(punch.height(np.array([20.0]))[0]), 4 * float(punch.height(np.array([10.0]))[0]))
    assert hash(punch) == hash(SmoothedProfile(tuple(r), tuple(heights), smoothing=noise))


#: A soft ball whose surface force is that of all of its atoms.
BALL = {"solid": "homogeneous", "punch": "ball", "law": "lennard-jones-9-3"}
OF_BODY = 'z0 = "0.4 nm"', 'z0 = "0.4 nm"\ninteraction = "body"'


def test_the_key_interaction_reaches_both_solvers_and_no_closed_form_of_vertical_gaps(written):
    problem = written(*OF_BODY, **BALL)
    assert problem.posed.interaction == problem.build(fem_reference).interaction == "body"
    assert not problem.is_of_the_paper("law")
    vertical = problem.without("law.interaction")
    assert vertical.posed.interaction == vertical.build(fem_reference).interaction == "derjaguin"
    assert problem.digest != vertical.digest
    forces = [evaluate("fscm", "pull_off_force", posed).value for posed in (problem, vertical)]
    assert 1.0001 < forces[0] / forces[1] < 1.02
    assert evaluate("jkr-sphere-projected", "pull_off_force", vertical).value is not None
    refusal = evaluate("jkr-sphere-projected", "pull_off_force", problem)
    assert (refusal.status, "jkr-sphere" in refusal.reason) == ("not-applicable", True)
    assert evaluate("jkr-sphere", "pull_off_force", problem).value is not None


def test_an_interaction_that_is_not_known_is_refused(written):
    refused("derjaguin, body", written, *(text.replace("body", "bodies") for text in OF_BODY), **BALL)
