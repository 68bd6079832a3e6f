"""Two elastic bodies, surface tension and a bond: problem files solved by both references and by the closed forms."""

from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.problem import Section
from comparisons.problem.reading import load_problem
from comparisons.runs.csv_format import read_table
from comparisons.runs.tasks import evaluate
from tests.comparisons.problems import on_solid
from tests.marks import heavy

EXAMPLES = Path(__file__).parents[3] / "docs" / "examples" / "problems"
SPHERES, BEAD = EXAMPLES / "two_spheres.toml", EXAMPLES / "pdms_bead.toml"

ELASTIC = {"E": 1e9, "nu": 0.3}
SOFT = on_solid("homogeneous", {"E": 5e8, "nu": 0.3})
HALVES = replace(on_solid("homogeneous", ELASTIC), punch_solid=Section("homogeneous", ELASTIC))


@pytest.mark.parametrize("model", ["fscm", "jkr", "atlas", *heavy("fem")])
def test_two_equal_bodies_are_one_of_half_the_modulus(model):
    force, of_one = (evaluate(model, "pull_off_force", problem) for problem in (HALVES, SOFT))
    assert abs(force.value - of_one.value) <= force.u_num + of_one.u_num


@pytest.mark.parametrize(
    ("solid", "punch_solid"),
    [
        ({"surface_tension": 0.05}, None),
        *heavy(({"surface_tension": 0.05}, {"E": 2e9, "nu": 0.4, "surface_tension": 0.02})),
    ],
)
def test_both_references_agree(solid, punch_solid):
    body = None if punch_solid is None else Section("homogeneous", punch_solid)
    problem = replace(on_solid("homogeneous", ELASTIC | solid), punch_solid=body)
    force, of_elements = (evaluate(model, "pull_off_force", problem) for model in ("fscm", "fem"))
    assert abs(force.value - of_elements.value) <= force.u_num + of_elements.u_num
    without = evaluate("fscm", "pull_off_force", problem.without(*problem.surface))
    assert without.value - force.value > 10.0 * (force.u_num + of_elements.u_num)


def test_a_bonded_homogeneous_solid_is_another_one():
    """Its compliance for u_r = 0 is that of E* times 4 (1 - nu)^2/(3 - 4 nu)."""
    nu = 0.2
    bonded = on_solid("homogeneous", {"E": 1e9, "nu": nu, "friction": "bonded"})
    stiffer = on_solid("homogeneous", {"E": 1e9 * 4.0 * (1.0 - nu) ** 2 / (3.0 - 4.0 * nu), "nu": nu})
    force, of_stiffer = evaluate("fem", "pull_off_force", bonded), evaluate("fscm", "pull_off_force", stiffer)
    assert abs(force.value - of_stiffer.value) <= force.u_num + of_stiffer.u_num


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
