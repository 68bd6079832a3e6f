"""Problems that are written in Python: values with units and uncertainties, sensitivity, physics that is absent."""

import numpy as np
import pint
import pytest
from uncertainties import ufloat

import comparisons
import fscm
from comparisons.cli.main import main
from comparisons.problem import Problem
from tests.refusals import refused as raised

ureg = pint.UnitRegistry()
SOLID = {"kind": "homogeneous", "E": "1.5 MPa", "nu": 0.25}
SPHERE = {"kind": "sphere", "R": "5 um"}
LAW = {"kind": "lennard-jones-9-3", "work_of_adhesion": "50 mJ/m^2", "z0": "3 nm"}
BEAD = Problem.of(SOLID, SPHERE, LAW)


def with_modulus(E):
    return Problem.of(SOLID | {"E": E}, SPHERE, LAW)


@pytest.mark.parametrize(
    "E",
    [1.5e6, 1500000, np.float32(1.5e6), np.int64(1500000), ureg.Quantity(1.5, "MPa"), ureg.Quantity(15.0, "bar")],
    ids=repr,
)
def test_a_number_is_that_of_its_text(E):
    assert with_modulus(E) == BEAD
    assert type(with_modulus(E)["solid.E"]) is float


@pytest.mark.parametrize(
    "E",
    [ufloat(1.5e6, 1e5), ureg.Quantity(ufloat(1.5, 0.1), "MPa"), ureg.Quantity(1.5, "MPa").plus_minus(0.1)],
    ids=repr,
)
def test_an_uncertain_number_has_its_deviation(E):
    problem = with_modulus(E)
    assert problem == BEAD
    (spread,) = problem.uncertain.values()
    assert (problem["solid.E"], spread.size, spread.is_interval) == (pytest.approx(1.5e6), pytest.approx(1e5), False)


def test_lists_and_powers_of_units():
    solid = {
        "kind": "layers",
        "E": (ureg.Quantity(1.0, "GPa"), "2 MPa"),
        "nu": np.array([0.3, 0.4]),
        "thickness": [1e-8],
    }
    punch = {"kind": "power-law", "n": 2.5, "Q": ureg.Quantity(2.0, "um**1.5")}
    problem = Problem.of(solid, punch, LAW, punch_solid=SOLID)
    assert problem["solid.E"] == (1e9, 2e6)
    assert problem["solid.nu"] == (0.3, 0.4)
    assert problem["punch.Q"] == pytest.approx(2e-9, rel=1e-14)
    assert problem.punch_solid == BEAD.solid
    cone = Problem.of(SOLID, {"kind": "cone", "half_angle": ureg.Quantity(70.0, "deg")}, LAW)
    assert cone.build(fscm).punch == fscm.Cone(np.radians(70.0))


def test_tables_are_in_the_folder_that_is_named(tmp_path):
    (tmp_path / "modulus.csv").write_text("z [nm],E [GPa]\n0,1\n25,2.5\n", encoding="utf-8")
    table = {"kind": "table", "file": "modulus.csv", "nu": 0.3}
    assert Problem.of(table, SPHERE, LAW, folder=tmp_path).solid.columns["E"] == (1e9, 2.5e9)
    raised("is not in the folder", Problem.of, table, SPHERE, LAW)


@pytest.mark.parametrize(
    ("E", "named"),
    [
        (ureg.Quantity(2.0, "nm"), "another unit than Pa"),
        (ureg.Quantity([1.0, 2.0], "Pa"), "not a number"),
        (ufloat(-1e6, 1.0), "outside its range"),
        ("2", "no unit"),
        (None, "not a number"),
        (True, "not a number"),
    ],
    ids=repr,
)
def test_what_is_no_modulus_is_one_sentence_with_its_key(E, named):
    assert "solid.E = " in str(raised(named, with_modulus, E))


def test_a_section_that_is_none():
    raised("punch.kind", Problem.of, SOLID, {"kind": "spere", "R": 1e-6}, LAW)
    raised("single brackets", Problem.of, SOLID, fscm.Sphere(1e-6), LAW)


def test_derivatives_by_all_numbers_obey_the_scaling_of_a_sphere():
    """P = pi R w f(mu), mu^3 = R w^2 / (E*^2 z0^3): one slope of f gives all of them."""
    stated = comparisons.sensitivity(BEAD)
    elasticity = {row["parameter"]: row["elasticity"] for row in stated["parameters"]}
    assert elasticity.keys() == {"solid.E", "solid.nu", "punch.R", "law.work_of_adhesion", "law.z0"}
    s = -elasticity["law.z0"]
    expected = {"solid.E": -2 / 3 * s, "punch.R": 1 + s / 3, "law.work_of_adhesion": 1 + 2 / 3 * s}
    assert {name: elasticity[name] for name in expected} == pytest.approx(expected, abs=1e-6)
    assert [row["contribution"] for row in stated["parameters"]] == [None] * 5
    assert (stated["standard_deviation"], stated["range"]) == (None, None)


def test_one_function_has_derivatives_and_uncertainty():
    problem = Problem.of(SOLID, SPHERE | {"R": ureg.Quantity(5.0, "um").plus_minus(0.1)}, LAW)
    (radius,) = comparisons.sensitivity(problem)["parameters"]
    assert radius["parameter"] == "punch.R"
    assert radius["contribution"] == pytest.approx(radius["slope"] * 1e-7)
    both = comparisons.sensitivity(problem, keys=["solid.E", "punch.R"])
    assert [row["contribution"] is None for row in both["parameters"]] == [True, False]
    assert both["standard_deviation"] == pytest.approx(radius["contribution"])
    raised("did you mean punch.R", comparisons.sensitivity, problem, keys=["punch.r"])
    raised("gradient", comparisons.sensitivity, Problem.dimensionless(2, 0.4, 1))


#: Physics that no kind has, as a section, a key or a kind, and a word of what to do.
ABSENT = [
    ({"solid": SOLID | {"viscosity": "1 Pa s"}}, "rate"),
    ({"solid": SOLID | {"relaxation_time": "1 s"}}, "rate"),
    ({"law": LAW | {"temperature": "300 K"}}, "temperature"),
    ({"punch": SPHERE | {"rms_roughness": "1 nm"}}, "smooth"),
    ({"punch": {"kind": "wavy-sphere", "R": "1 um"}}, "profile"),
    ({"punch": SPHERE | {"wavelength": "1 um"}}, "profile"),
    ({"solid": SOLID | {"yield_stress": "1 GPa"}}, "elastic"),
    ({"law": {"kind": "capillary"}}, "meniscus"),
]


@pytest.mark.parametrize(("changed", "word"), ABSENT, ids=lambda value: value if isinstance(value, str) else None)
def test_absent_physics_is_refused_with_what_to_do(changed, word):
    sections = {"solid": SOLID, "punch": SPHERE, "law": LAW} | changed
    assert "did you mean" not in str(raised(word, lambda: Problem.of(**sections)))


def test_a_section_of_absent_physics(tmp_path, refused):
    path = tmp_path / "hot.toml"
    path.write_text("[environment]\ntemperature = 300\n", encoding="utf-8")
    refused(["describe", path], "temperature")


def test_the_critical_tabor_number_needs_no_other_one(capsys, refused):
    command = ["solve", "--model", "atlas", "--quantity", "critical_tabor_number", "--n", "2", "--k", "0"]
    assert main(command) == 0
    out = capsys.readouterr().out
    assert "mu_crit = 0.69721" in out
    assert "mu = 1" not in out
    assert "at prescribed displacement" in out
    refused(["solve", "--model", "atlas", "--quantity", "pull_off_force", "--n", "2", "--k", "0"], "--mu")


def test_a_misspelt_quantity_is_answered_before_the_file_is_read(tmp_path, refused):
    refused(["describe", tmp_path / "missing.toml", "--uncertain", "--quantity", "pull_of_force"], "'pull_of_force'")


def test_a_row_prints_with_a_prefix_and_a_format():
    row = comparisons.evaluate("jkr", "pull_off_force", BEAD)
    assert "1.178" in str(row)
    assert str(row).endswith(" µN")
    assert f"{1e6 * float(row):.3f}" == "1.178"
    assert f"{row:.3e}" == "1.178e-06"


@pytest.mark.parametrize("name", ["fscm", "jkr"])
def test_a_curve_has_the_units_of_its_problem(name):
    """Its least load is the pull-off force but for the distance of its points."""
    force = comparisons.evaluate(name, "pull_off_force", BEAD)
    path = comparisons.curve(name, BEAD)
    assert -path.load.min() == pytest.approx(force.value, rel=1e-4)
    plain = Problem.dimensionless(2, 0, BEAD.posed.mu)
    own = comparisons.create(name).curve(plain)
    assert comparisons.curve(name, plain).displacement.tolist() == own.displacement.tolist()
    np.testing.assert_allclose(path.displacement, own.displacement * 3e-9, rtol=1e-9)


def test_a_model_without_a_curve_says_so():
    with pytest.raises(comparisons.NotApplicable):
        comparisons.curve("jump-asymptotes", BEAD)
    with pytest.raises(ValueError, match=r"Problem\.load"):
        comparisons.curve("jkr", fscm.Problem(n=2, k=0, mu=1.0))
