"""Curved solids, friction, surface tension, and two bodies: what their problems are, and their values."""

from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.model import NotApplicable
from comparisons.models.fem_model import LargeStrain
from comparisons.problem import Problem, Section
from comparisons.problem.evaluation import evaluated
from comparisons.problem.reading import load_problem
from comparisons.registry import create
from comparisons.runs.csv_format import read_table
from comparisons.runs.tasks import evaluate
from tests.comparisons.problems import on_solid
from tests.marks import heavy
from tests.paths import PROBLEMS

ELASTIC = {"E": 1e9, "nu": 0.3}
BODY = Section("homogeneous", ELASTIC)
PLAIN = on_solid("homogeneous", ELASTIC)
BONDED = on_solid("homogeneous", ELASTIC | {"friction": "bonded"})

FILE = """\
solid = {{kind = "homogeneous", E = "1 GPa", nu = 0.3{solid}}}
punch = {{kind = "sphere", R = "100 nm +- 3 %"{punch}}}
law = {{kind = "lennard-jones-9-3", work_of_adhesion = "50 mJ/m^2", z0 = "0.4 nm"}}
"""


@pytest.fixture
def written(tmp_path):
    """A function that writes a problem with more keys of the solid and of the punch, and returns its path."""

    def write(solid: str = "", punch: str = "") -> Path:
        (tmp_path / "pad.toml").write_text(FILE.format(solid=solid, punch=punch))
        return tmp_path / "pad.toml"

    return write


def test_two_spheres_have_the_sum_of_their_curvatures(written):
    """Two spheres of 100 nm are one of 50 nm on a plane, and a sphere in a wide one is one alone."""
    two = load_problem(written(punch=', R_solid = "100 nm"'))
    half = replace(PLAIN, punch=Section("sphere", {"R": 5e-8}))
    force, of_half = (evaluate("fscm", "pull_off_force", problem) for problem in (two, half))
    assert abs(force.value - of_half.value) <= force.u_num + of_half.u_num
    wide = load_problem(written(punch=', R_solid = "1e10 nm"'))
    assert wide.posed.mu == pytest.approx(load_problem(written()).posed.mu, rel=1e-7)


def test_a_problem_is_known_by_its_second_body():
    """Its digest, its content and its equality have the body; those of a rigid punch are as they were."""
    two = replace(PLAIN, punch_solid=BODY)
    assert two != PLAIN
    assert two.digest != PLAIN.digest
    assert "punch_solid" not in PLAIN.content
    assert two.content["punch_solid"] == {"kind": "homogeneous", **ELASTIC}
    assert (two["punch_solid.E"], PLAIN["punch_solid.E"]) == (1e9, None)
    assert two.with_value("punch_solid.E", 2e9)["punch_solid.E"] == 2e9


def test_numbers_of_the_paper_have_no_second_body():
    with pytest.raises(ValueError, match=r"punch_solid .* both bodies together"):
        replace(Problem.dimensionless(2, 0, 1), punch_solid=BODY)


def graded(k):
    return Section("power-law", {"E0": 1e9, "c0": 1e-7, "k": k, "nu": 0.3})


@pytest.mark.parametrize(
    ("solid", "body", "is_one"),
    [
        (BODY, BODY, True),
        (BODY, graded(0.0), True),
        (graded(0.4), graded(0.4), True),
        (graded(0.4), graded(0.5), False),
        (graded(0.4), BODY, False),
        (BODY, Section("exponential", {"E_surface": 1e9, "E_depth": 2e9, "length": 1e-8, "nu": 0.3}), False),
        (BODY, Section("homogeneous", ELASTIC | {"surface_tension": 0.02}), False),
        (BODY, Section("homogeneous", ELASTIC | {"surface_tension": 0.0}), True),
        (Section("homogeneous", ELASTIC | {"friction": "bonded"}), BODY, False),
        (Section("homogeneous", ELASTIC | {"friction": "none"}), BODY, True),
    ],
)
def test_bodies_of_one_exponent_are_one_power_law(solid, body, is_one):
    assert replace(PLAIN, solid=solid, punch_solid=body).is_of_the_paper("solid") == is_one


@pytest.mark.parametrize("model", ["jkr", "md-improved", "dmt", "jump-asymptotes", "atlas"])
def test_a_model_of_one_gradient_refuses_two(model):
    quantity = "jump_out_displacement" if model == "jump-asymptotes" else "pull_off_force"
    two = replace(PLAIN, solid=graded(0.4), punch_solid=graded(0.5))
    with pytest.raises(NotApplicable, match=r"two of one k.*k = 0.4.*k = 0.5"):
        evaluated(two, create(model), quantity)


def test_closed_forms_say_that_they_neglect_friction():
    """The value is that without it; a curve, which has no reason, is refused."""
    row, plain = (evaluate("jkr", "pull_off_force", problem) for problem in (BONDED, PLAIN))
    assert (row.value, row.status) == (plain.value, "ok")
    assert "jkr neglects solid.friction = bonded" in row.reason
    assert not plain.reason
    with pytest.raises(NotApplicable, match="friction"):
        evaluated(BONDED, create("jkr"), "force_curve")


def test_the_integral_equation_refuses_friction():
    assert "no friction" in evaluate("fscm", "pull_off_force", BONDED).reason
    assert evaluate("fscm", "pull_off_force", BONDED).status == "not-applicable"


@pytest.mark.parametrize(
    ("problem", "named"),
    [
        (replace(PLAIN, punch_solid=BODY), "punch_solid"),
        (BONDED, "solid.friction"),
        (replace(PLAIN, punch=Section("sphere", {"R": 1e-7, "R_solid": 1e-7})), "punch.R_solid"),
    ],
)
def test_finite_strain_refuses_what_it_does_not_have(problem, named):
    with pytest.raises(NotApplicable, match=f"rigid punch .* leave out {named}"):
        LargeStrain().evaluate(problem, "pull_off_force")


CURVE = Path(__file__).parents[3] / "docs" / "examples" / "measured_curve.csv"


@pytest.mark.parametrize(
    "command", [["describe", "{}", "--uncertain"], ["fit", str(CURVE), "--problem", "{}", "--free", "solid.E"]]
)
def test_what_needs_the_integral_equation_refuses_friction(command, written, refused):
    path = str(written(', friction = "bonded"'))
    refused([word.format(path) for word in command], 'friction = "bonded"')


SPHERES, BEAD = PROBLEMS / "two_spheres.toml", PROBLEMS / "pdms_bead.toml"

SOFT = on_solid("homogeneous", {"E": 5e8, "nu": 0.3})
HALVES = replace(PLAIN, punch_solid=BODY)


@pytest.mark.parametrize("model", ["fscm", "jkr", "atlas", *heavy("fem")])
def test_two_equal_bodies_are_one_of_half_the_modulus(model):
    force, of_one = (evaluate(model, "pull_off_force", problem) for problem in (HALVES, SOFT))
    assert abs(force.value - of_one.value) <= force.u_num + of_one.u_num


@pytest.mark.heavy
def test_jkr_with_surface_tension_is_the_limit_of_the_fscm():
    bead = load_problem(BEAD)
    errors = []
    for z0 in (3e-8, 1e-8):
        problem = bead.with_value("law.z0", z0)
        force, limit = (evaluate(model, "pull_off_force", problem).value for model in ("fscm", "jkr-surface-tension"))
        errors.append(limit / force - 1.0)
    assert errors[1] / errors[0] == pytest.approx(1.0 / 3.0, abs=0.1)
    assert abs(errors[1]) < 0.01


def test_commands_take_the_examples(tmp_path, capsys):
    spheres, bead = ["--problem", str(SPHERES)], ["--problem", str(BEAD)]
    assert main(["describe", str(SPHERES)]) == 0
    text = capsys.readouterr().out
    assert "of a homogeneous solid" in text
    # The errors of the shape are those of one sphere on a plane.
    assert "a paraboloid for the sphere  unknown" in text
    assert "--large-strain" not in text
    assert main(["solve", "--model", "fscm", "--quantity", "pull_off_force", *spheres]) == 0
    curve = ["curve", "--model", "jkr-surface-tension", *bead, "--csv", str(tmp_path / "curve.csv")]
    assert main(curve) == 0
    capsys.readouterr()
    main(["curve", "--model", "jkr", *bead, "--csv", str(tmp_path / "none.csv")])
    assert "not-applicable" in capsys.readouterr().err
    vary = ["--vary", "punch_solid.E=1, 70 GPa", "--model", "jkr", "--quantity", "pull_off_displacement"]
    assert main(["sweep", *spheres, *vary, "--out", str(tmp_path / "sweep")]) == 0
    table = read_table(tmp_path / "sweep" / "results.csv")
    assert sorted(table["punch_solid.E [Pa]"]) == [1e9, 7e10]
    assert len(set(table["value"])) == 2


@pytest.mark.heavy
def test_describe_states_the_surface_tension(capsys):
    assert main(["describe", str(BEAD), "--uncertain"]) == 0
    text = capsys.readouterr().out
    assert "with solid.surface_tension = 0.02 N/m" in text
    assert "jkr-surface-tension" in text
    assert "solid.surface_tension  20 +- 2 mN/m" in text
