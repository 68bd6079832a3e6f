"""Overview of a problem file."""

import json
import math
from pathlib import Path

import fscm
from comparisons.cli.main import main
from comparisons.problem_file.overview import REFERENCES
from comparisons.registry import MODELS

EXAMPLES = Path(__file__).parents[3] / "docs" / "examples" / "problems"


def described(capsys, path, *options):
    assert main(["describe", str(path), *options]) == 0
    return capsys.readouterr().out


def test_a_power_law_has_errors_of_closed_forms(capsys):
    found = json.loads(described(capsys, EXAMPLES / "graded_pad.toml", "--format", "json"))
    pad = fscm.PhysicalProblem(2e9, 1e-6, 0.4, 0.3, 2.5e-6, 2.0, 0.05, 4e-10)
    assert math.isclose(found["tabor_number"], pad.tabor_number, rel_tol=1e-12)
    assert found["pull_off_force"]["model"] == "atlas"
    # The value of both references: 670.023314 nN.
    assert math.isclose(found["pull_off_force"]["value"], 6.70023314e-7, rel_tol=1e-6)
    errors = {row["model"]: row["error"] for row in found["errors"]}
    force = found["pull_off_force"]["value"]
    assert math.isclose(errors["jkr"], 1.7 * math.pi * 2.5e-6 * 0.05 / force - 1, rel_tol=1e-9)
    assert [abs(error) for error in errors.values()] == sorted(abs(error) for error in errors.values())
    assert not set(errors) & set(REFERENCES)
    assert found["recommended"] == {"1 %": "md-improved", "5 %": "md-improved"}
    assert "JKR" in found["regime"]


def test_another_solid_has_the_force_of_the_integral_equation(capsys):
    text = described(capsys, EXAMPLES / "coated_solid.toml")
    assert "Tabor number 1.47893, with the modulus of the surface" in text
    assert "pull-off force 26.94617" in text
    assert "recommended for 1 %: fscm" in text


def test_every_reference_is_a_model():
    assert set(REFERENCES) <= set(MODELS)


def test_the_page_shows_the_example_and_what_is_printed(capsys):
    page = (EXAMPLES.parents[1] / "problem_files.md").read_text(encoding="utf-8")
    example = (EXAMPLES / "coated_solid.toml").read_text(encoding="utf-8")
    assert example.partition("\n")[2] in page
    path = str(EXAMPLES / "coated_solid.toml")
    assert main(["solve", "--model", "fscm", "--quantity", "pull_off_force", "--problem", path]) == 0
    heading, force, scaled = capsys.readouterr().out.splitlines()
    assert heading in page
    # The digits in brackets, a bound, may differ between machines.
    assert force.partition("(")[0] in page
    assert scaled.partition("(")[0] in page
