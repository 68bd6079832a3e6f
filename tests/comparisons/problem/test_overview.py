"""Overview of a problem file, and the sensitivity of its force to smoothing and continuation of a measured profile."""

import json
import math
import re

import numpy as np
import pytest

import fscm
from comparisons.cli.main import main
from comparisons.description import forces as module
from comparisons.description.choice import SIMPLEST_FIRST, simplest_within
from comparisons.description.equivalent_power_law import equivalent_power_law
from comparisons.description.forces import reference_force
from comparisons.description.overview import overview
from comparisons.description.text import _shape_counts, description_text
from comparisons.description.unusual_sizes import unusual_sizes
from comparisons.problem import Problem, Section
from comparisons.problem.evaluation import REFERENCES
from comparisons.problem.reading import load_problem
from comparisons.problem.uncertain import Uncertainty
from comparisons.registry import MODELS
from comparisons.runs.tasks import evaluate
from tests.comparisons.problems import on_solid
from tests.comparisons.rows import row
from tests.paths import PROBLEMS


def test_one_problem_file_is_described(refused):
    refused(["describe"], "one problem file")
    refused(["describe", "a.toml", "--problem", "b.toml"], "one problem file")


def test_a_power_law_has_errors_of_closed_forms(capsys):
    assert main(["describe", str(PROBLEMS / "graded_pad.toml"), "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    solid, law = fscm.PowerLaw(2e9, 1e-6, 0.4, 0.3), fscm.LennardJones(0.05, 4e-10)
    pad = fscm.Problem(solid, fscm.PowerPunch(2.0, 2.5e-6), law)
    assert math.isclose(content["tabor_number"], pad.mu, rel_tol=1e-12)
    assert content["pull_off_force"]["model"] == "atlas"
    # The value of both references: 670.023314 nN.
    assert math.isclose(content["pull_off_force"]["value"], 6.70023314e-7, rel_tol=1e-6)
    errors = {row["model"]: row["error"] for row in content["errors"]}
    force = content["pull_off_force"]["value"]
    assert math.isclose(errors["jkr"], 1.7 * math.pi * 2.5e-6 * 0.05 / force - 1, rel_tol=1e-9)
    assert [abs(error) for error in errors.values()] == sorted(abs(error) for error in errors.values())
    assert not set(errors) & set(REFERENCES)
    # JKR is 0.4 % off, and simpler.
    assert abs(errors["md-improved"]) < abs(errors["jkr"]) < 0.01
    assert content["recommended"] == {"1 %": "jkr", "5 %": "jkr"}
    assert "JKR" in content["regime"]
    assert "equivalent_power_law" not in content


def test_the_lines_of_a_description_have_80_characters(capsys):
    assert main(["describe", str(PROBLEMS / "graded_pad.toml")]) == 0
    printed, said = capsys.readouterr()
    # Where it is no terminal, it says once that it works.
    assert said == "solving graded_pad.toml with fscm: this may take a minute\n"
    assert max(map(len, printed.splitlines())) <= 80
    assert "0.782473 at prescribed displacement: jumps" in printed


def test_sizes_that_nothing_has_are_named(tmp_path):
    """A number without a unit is in SI: a radius of 20 m is that of a ball of 20 um whose unit was forgotten."""
    path = tmp_path / "forgotten.toml"
    path.write_text(
        """
        solid = {kind = "homogeneous", E = 50, nu = 0.4}
        punch = {kind = "sphere", R = 20}
        law = {kind = "lennard-jones-9-3", work_of_adhesion = "50 mJ/m^2", z0 = "0.4 nm"}
        """,
        encoding="utf-8",
    )
    problem = Problem.load(path)
    described = overview(problem, row("fscm", value=1.0, u_num=0.0), None)
    assert {row["key"]: row["value"] for row in described["unusual_sizes"]} == {"solid.E": 50.0, "punch.R": 20.0}
    assert "unusual size: solid.E = 50 Pa, punch.R = 20 m; " in description_text(problem, described, None, [], None)


def test_closed_forms_are_printed_without_a_reference_too(written):
    """Of a measured tip on a soft solid: JKR of its profile; of a coating there is none."""
    tip = written('smoothing = "0.05 nm"')
    without = overview(tip, row("fscm", value=None, u_num=None, status="failed", reason="the edge is too narrow"))
    assert [entry["model"] for entry in without["closed_forms"]] == ["jkr-profile", "md-profile"]
    text = description_text(tip, without, None, [], None)
    assert "pull-off force failed: the edge is too narrow" in text
    for entry in without["closed_forms"]:
        assert evaluate(entry["model"], "pull_off_force", tip).value == entry["value"]
        (printed,) = re.findall(rf"    {entry['model']} +([\d.]+) nN", text)
        assert float(printed) == pytest.approx(1e9 * entry["value"], rel=1e-6)
    beside = overview(tip, row("fscm", value=1.0, u_num=0.0, unit="N"))
    assert beside["closed_forms"] == []
    assert {entry["model"] for entry in beside["errors"]} == {"jkr-profile", "md-profile"}
    film = on_solid("coating", {"E_coating": 1e9, "E_substrate": 3e9, "thickness": 1e-6, "transition": 0.0, "nu": 0.3})
    failed = row("fscm", value=None, u_num=None, status="failed", reason="why")
    assert overview(film, failed)["closed_forms"] == []


@pytest.mark.parametrize(("work", "keys"), [(50.0, ["law.work_of_adhesion"]), (5.0, []), (1e-3, [])])
def test_a_work_of_adhesion_above_that_of_metals_is_unusual(work, keys):
    pad = on_solid("homogeneous", {"E": 2e6, "nu": 0.5}, R=5e-6)
    assert [row["key"] for row in unusual_sizes(pad.with_value("law.work_of_adhesion", work))] == keys


def test_the_problems_of_the_pages_have_usual_sizes():
    for path in PROBLEMS.glob("*.toml"):
        assert not unusual_sizes(Problem.load(path))


@pytest.mark.parametrize(
    ("errors", "simplest"),
    [
        ({"schwarz": 1e-5, "md-improved": 2e-3, "semi-rigid": 3e-3, "bradley": 4e-3, "dmt": 4e-3, "jkr": 9e-3}, "jkr"),
        ({"schwarz": 1e-5, "md-improved": 2e-3, "semi-rigid": 3e-3, "bradley": 4e-3, "dmt": 4e-3}, "dmt"),
        ({"schwarz": 1e-5, "md-improved": 2e-3, "semi-rigid": 3e-3, "jkr": 0.02}, "semi-rigid"),
        ({"schwarz": 1e-5, "md-original": 1e-4, "md-improved": 2e-3}, "md-improved"),
        ({"pietrement-troyon": 1e-5, "schwarz": 1e-4, "jkr": 0.02}, "pietrement-troyon"),
        ({"jkr": 0.02}, None),
    ],
)
def test_the_order_of_the_recommendation(errors, simplest):
    rows = [{"model": name, "error": error, "u_num": 1e-9} for name, error in errors.items()]
    assert simplest_within(rows, 0.01) == simplest
    assert set(SIMPLEST_FIRST) <= set(MODELS)


@pytest.mark.heavy
def test_a_thick_coating_has_the_tabor_number_of_its_surface():
    """A coating so thick that the contact does not feel the substrate."""
    coating = {"E_coating": 1e9, "E_substrate": 3e9, "thickness": 1e-6, "transition": 0.0, "nu": 0.3}
    pad = on_solid("coating", coating)
    equivalent = equivalent_power_law(pad, reference_force(pad))
    assert equivalent["surface_compliance_deviation"] < 0.1
    assert equivalent["k"] == pytest.approx(0.0, abs=0.02)


TEXT = """
solid = { kind = "homogeneous", E = "2 GPa", nu = 0.3 }
law = { kind = "lennard-jones-9-3", work_of_adhesion = "50 mJ/m^2", z0 = "0.4 nm" }
"""


@pytest.fixture
def written(tmp_path):
    """A function that writes a file with keys of the punch and the heights of a noisy sphere of 100 nm."""
    r = np.arange(0.0, 41.0, 2.0)
    height = r**2 / 200.0 + np.random.default_rng(5).normal(0.0, 0.05, len(r))
    rows = np.transpose([r, height - height[0]])
    np.savetxt(tmp_path / "profile.csv", rows, "%.6f", ",", header="r [nm],height [nm]", comments="")

    def write(keys):
        (tmp_path / "mine.toml").write_text(f'{TEXT}punch = {{ kind = "table", file = "profile.csv", {keys} }}')
        return load_problem(tmp_path / "mine.toml")

    return write


@pytest.mark.heavy
def test_the_changes_are_those_of_other_files(written):
    force = evaluate("fscm", "pull_off_force", written('smoothing = "0.05 nm"'))
    changes = module.profile_sensitivity(written('smoothing = "0.05 nm"'), force)
    stated = [(change["key"], pytest.approx(change["value"])) for change in changes]
    assert stated == [("smoothing", 2.5e-11), ("smoothing", 1e-10), ("growth", 1.5), ("growth", 3.0)]
    changed_keys = ['smoothing = "0.025 nm"', 'smoothing = "0.05 nm", growth = 3']
    for keys, change in zip(changed_keys, (changes[0], changes[3]), strict=True):
        expected = evaluate("fscm", "pull_off_force", written(keys)).value / force.value - 1.0
        assert abs(change["change"] - expected) <= change["u_num"] + 1e-12
    # More attraction far away with a profile that is lower there.
    assert changes[2]["change"] > 0.0 > changes[3]["change"]


def test_a_table_without_smoothing_is_compared_with_the_curve_through_its_rows(written, monkeypatch):
    solved = []
    monkeypatch.setattr(module, "evaluate_task", lambda task: solved.append(task.problem) or row("fscm", value=2.0))
    module.profile_sensitivity(written("growth = 3"), row("fscm", value=1.0, u_num=0.0))
    curve = solved[0]
    assert [problem.punch.get("growth", 2.0) for problem in solved] == [3.0, 1.5]
    r, height = (curve.punch.columns[name] for name in ("r", "height"))
    assert curve.build(fscm).punch.height(np.array(r)) == pytest.approx(np.array(height), abs=1e-3 * height[-1])


def test_a_failure_is_stated(written, monkeypatch):
    def solved(task):
        if task.problem.punch.get("growth") == 3.0:
            return row("fscm", value=None, u_num=None, status="failed", reason="not admissible")
        return row("fscm", value=2.0, u_num=0.0)

    monkeypatch.setattr(module, "evaluate_task", solved)
    content = module.profile_sensitivity(written('smoothing = "0.05 nm"'), row("fscm", value=1.0, u_num=0.0))
    assert [(change["status"], change["change"]) for change in content] == [("ok", 1.0)] * 3 + [("failed", None)]


@pytest.mark.parametrize(
    ("kind", "radius", "counts"), [("sphere", 2e-8, True), ("sphere", 2e-4, False), ("ball", 2e-8, False)]
)
def test_the_error_of_the_paraboloid_by_the_range_of_the_law_is_named(kind, radius, counts):
    values, some = {"work_of_adhesion": 0.1, "z0": 4e-10}, Uncertainty(4e-11, False, "0.4 nm +- 10 %")
    law = Section("lennard-jones-9-3", values, uncertain={"z0": some})
    problem = Problem(Section("homogeneous", {"E": 5e10, "nu": 0.25}), Section(kind, {"R": radius}), law)
    force = 2.0 * math.pi * radius * 0.1
    known = {"error": 9.0 / 7.0 * 4e-10 / radius, "u_num": 0.0}
    row = {"parameter": "law.z0", "value": 4e-10, "contribution": 1e-3 * force}
    stated = {"status": "ok", "quantity": "pull_off_force", "value": force, "parameters": [row]}
    assert _shape_counts(problem, {"geometry": known}, stated) is counts
