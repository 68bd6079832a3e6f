"""Error of what all models assume: its table, how it is continued, and what follows for the choice of a model."""

import json
import math
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import fscm.analysis
from comparisons.cli.main import main
from comparisons.description import assumptions as module
from comparisons.description.assumptions import SMALL, assumptions
from comparisons.description.choice import simplest_within
from comparisons.description.forces import reference_force
from comparisons.description.overview import overview
from comparisons.description.shared_errors import ASSUMPTIONS, error_of, estimates, together
from comparisons.description.text import description_text
from comparisons.models import fem_model, fscm_model
from comparisons.problem import Section
from tests.comparisons.problems import on_solid
from tests.comparisons.rows import row

#: A bead of glass on PDMS: w/(E* R) = 0.005.
BEAD = on_solid("homogeneous", {"E": 1.5e6, "nu": 0.5}, R=5e-6)


def described(problem):
    force = reference_force(problem)
    return overview(problem, force, assumptions(problem, force))


@pytest.fixture(scope="module")
def bead():
    return described(BEAD)


def test_a_bead_on_a_soft_solid(bead):
    """JKR is 1.3 % too small: the projected area of contact outweighs the paraboloid."""
    assumed = bead["assumptions"]
    # JKR of the exact sphere is exact here: a second route to the errors of the paraboloid and of the area.
    softness = 0.05 / (1.5e6 / 0.75 * 5e-6)
    assert softness == pytest.approx(5e-3)
    assert 1.0 / (1.0 + assumed["geometry"]["error"]) == pytest.approx(0.973699, abs=2e-5)
    area = assumed["derjaguin"]
    assert 1.0 / (1.0 + area["error"]) == pytest.approx(1.007085 / 0.973699, abs=1.5 * area["u_num"])
    assert 1e-5 < area["u_num"] < 1e-3
    # 0.0294 a/R to first order, with a/R = 0.26.
    assert -0.0294 * 0.26 < assumed["strain"]["error"] < -0.004
    assert assumed["total"]["error"] == pytest.approx(-0.0115, abs=1.5e-3)
    assert assumed["total"]["u_num"] < 3e-3
    bases = [assumed[name]["basis"] for name in (*ASSUMPTIONS, "total")]
    assert bases == ["bound", "estimate", "estimate", "unknown", "bound", "estimate"]
    assert (assumed["friction"]["error"], assumed["friction"]["u_num"]) == (0.0, 0.0)
    assert assumed["total"]["reason"] == "without surface tension"
    # The contact radius of JKR: a^3 = 9 pi w R^2 / (8 E*).
    a = (9 * math.pi * 0.05 * 5e-6**2 / (8 * 2e6)) ** (1 / 3)
    assert assumed["contact_radius"] == pytest.approx(a, rel=0.02)
    measures = {row["key"]: row["value"] for row in assumed["measures"]}
    assert measures["punch_slope"] == pytest.approx(assumed["contact_radius"] / 5e-6)
    assert min(measures.values()) > SMALL
    assert bead["recommended"] == {"1 %": "jkr-sphere", "5 %": "jkr"}
    errors = {row["model"]: row["error"] for row in bead["total_errors"]}
    assert errors["jkr"] == pytest.approx(assumed["total"]["error"], abs=1e-4)
    # The true area leaves it the error of small strains alone.
    assert errors["jkr-sphere"] == pytest.approx(assumed["strain"]["error"], abs=1.5 * area["u_num"])
    # The table has the paraboloid without a solution.
    looked_up = estimates(BEAD)["geometry"]
    assert looked_up["error"] == pytest.approx(assumed["geometry"]["error"], abs=looked_up["u_num"])
    assert looked_up["u_num"] < 1e-3
    projected = (1.0 + assumed["strain"]["error"]) * (1.0 + area["error"]) - 1.0
    assert errors["jkr-sphere-projected"] == pytest.approx(projected, abs=1e-4)


def test_a_description_finds_the_least_load_of_each_problem_once(monkeypatch):
    """A bead, as a paraboloid and as an exact sphere: force, profile and total errors share an analysis each."""
    fscm_model._kept_analysis.cache_clear()
    found, known_minimum = [], fscm.analysis.known_minimum
    monkeypatch.setattr(fscm.analysis, "known_minimum", lambda *of: found.append(1) or known_minimum(*of))
    content = described(replace(BEAD, law=replace(BEAD.law, values={**BEAD.law.values, "z0": 1e-6})))
    assert content["pull_off_force"]["model"] in ("atlas", "fscm")
    assert content["assumptions"]["geometry"]["basis"] == "bound"
    assert content["total_errors"]
    assert len(found) == 2


def test_slopes_that_any_soft_edge_has_are_printed_where_their_effect_is_unknown(bead):
    unknown = {"error": None, "u_num": None, "basis": "unknown", "reason": "unknown"}
    for name, slopes in ((None, []), ("strain", ["surface"]), ("derjaguin", ["gap"])):
        assumed = bead["assumptions"] | ({name: unknown} if name else {})
        text = description_text(BEAD, bead | {"assumptions": assumed}, None, [], None)
        assert re.findall("largest slope of the (surface|gap), in the very edge", text) == slopes
        assert "slope of the punch at the contact edge" in text


@pytest.mark.parametrize("by_solution", [False, True])
def test_finite_strain_is_proposed_until_it_was_tried(bead, by_solution):
    strain = {"error": None, "u_num": None, "basis": "unknown", "reason": "unknown"}
    changed = bead | {"assumptions": bead["assumptions"] | {"strain": strain, "by_solution": by_solution}}
    assert ("--large-strain" in description_text(BEAD, changed, None, [], None)) is not by_solution


FORCE = row("fscm", value=2.0, u_num=1e-9)
REASON = "the contact edge needs smaller elements"


@pytest.fixture
def quickly(monkeypatch):
    """What the assumptions of a problem are beside a force of 2, with numbers in place of the solvers'."""

    def assumed(problem, by_solution=False, contact_radius=1e-9, **forces):
        monkeypatch.setattr(module, "_measures", lambda _: {"contact_radius": contact_radius, "measures": []})
        forces.setdefault("vertical", forces.get("fem-large-strain"))
        monkeypatch.setattr(fem_model, "LargeStrain", lambda interaction: "vertical")
        monkeypatch.setattr(module, "fscm_force", lambda _: row("fscm", value=forces.get("fscm"), u_num=1e-9))
        monkeypatch.setattr(
            module, "evaluate", lambda model, *_: row(model, value=forces.get(model), u_num=1e-9, reason=REASON)
        )
        return assumptions(problem, FORCE, by_solution)

    return assumed


def test_no_model_is_recommended_where_the_assumptions_exceed_the_limit(quickly):
    assumed = quickly(BEAD, **{"fscm": 1.8, "jkr-sphere": 2.4})
    assumed |= {"total": {"error": 0.06, "u_num": 0.0, "basis": "bound", "reason": ""}}
    assert assumed["geometry"]["error"] == pytest.approx(2.0 / 1.8 - 1.0)
    assert overview(BEAD, FORCE, assumed)["recommended"] == {"1 %": None, "5 %": None}


def test_a_model_is_not_recommended_because_its_error_and_that_of_the_paraboloid_cancel():
    shared = {name: error_of((0.0, 0.0)) for name in ASSUMPTIONS} | {"geometry": error_of((0.0257, 0.0))}
    assumed = {**shared, "total": together(shared), "recommendable": True}
    rows = [
        {"model": "carpick-ogletree-salmeron", "error": -0.0253, "u_num": 1e-7},
        {"model": "dmt", "error": 0.016, "u_num": 1e-7},
    ]
    problem = replace(BEAD, solid=Section("homogeneous", {"E": 5e10, "nu": 0.25}), punch=Section("sphere", {"R": 2e-8}))
    total = {row["model"]: row for row in module.total_errors(problem, rows, assumed)}
    assert abs(total["carpick-ogletree-salmeron"]["error"]) < 0.001
    assert total["carpick-ogletree-salmeron"]["at_most"] == pytest.approx(1.0253 * 1.0257 - 1.0, abs=1e-6)
    assert simplest_within(list(total.values()), 0.01) is None
    assert simplest_within(list(total.values()), 0.05) == "dmt"


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"law": Section("mie", {"work_of_adhesion": 0.05, "z0": 4e-10, "m": 8.0, "n": 4.0})}, "9-3"),
        ({"punch": Section("cone", {"half_angle": 1.2})}, "spheres"),
        ({"solid": Section("homogeneous", {"E": 5e4, "nu": 0.5})}, "as soft as"),
    ],
)
def test_where_nothing_was_computed_the_error_is_unknown(changed, reason, quickly):
    problem = replace(BEAD, **changed)
    assumed = quickly(problem, fscm=1.6)
    for name in ("derjaguin", "strain"):
        assert (assumed[name]["error"], assumed[name]["basis"]) == (None, "unknown")
    assert reason in assumed["strain"]["reason"]
    assert assumed["total"]["reason"] == "without vertical gaps, small strains and surface tension"
    is_sphere = problem.punch.kind == "sphere"
    assert assumed["total"]["error"] == (pytest.approx(0.25) if is_sphere else None)


#: A wide contact on a gel of 50 um on glass, and on a power law of the same contact radius.
GEL = on_solid("layers", {"E": (2e4, 7e10), "nu": (0.45, 0.2), "thickness": (5e-5,)}, R=5e-5)
GRADED = on_solid("power-law", {"E0": 4e4, "c0": 2e-5, "k": 0.4, "nu": 0.3}, R=5e-5)


def test_a_layered_solid_has_the_errors_of_a_homogeneous_one_of_the_same_contact(quickly):
    """Its vertical gaps cost half of (a/R)^2, as on any solid where the force is proportional to w."""
    share = 0.3
    assumed = quickly(GEL, contact_radius=share * 5e-5, fscm=2.0 / 1.04)
    area = assumed["derjaguin"]
    assert area["basis"] == assumed["strain"]["basis"] == "estimate"
    assert area["error"] == pytest.approx(-0.5 * share**2, rel=0.1)
    assert 0.5 * abs(area["error"]) < area["u_num"] < 0.6 * abs(area["error"])
    assert abs(assumed["strain"]["error"]) <= assumed["strain"]["u_num"] < 0.01
    assert assumed["geometry"]["error"] == pytest.approx(0.04)
    assert (assumed["geometry"]["basis"], assumed["friction"]["basis"]) == ("bound", "unknown")
    assert assumed["total"]["reason"] == "without surface tension and friction"


def test_a_modulus_that_vanishes_at_the_surface_has_no_error_of_strain(quickly):
    assumed = quickly(GRADED, contact_radius=1.5e-5, fscm=2.0)
    assert (assumed["strain"]["error"], assumed["derjaguin"]["basis"]) == (None, "estimate")


def test_what_is_known_counts_beside_what_is_not(quickly):
    """A gel whose paraboloid is off by 16 %: nothing is recommended within 5 % although the law is another one."""
    law = Section("mie", {"work_of_adhesion": 0.05, "z0": 4e-10, "m": 8.0, "n": 4.0})
    gel = replace(GEL, law=law)
    assumed = quickly(gel, fscm=2.0 / 1.16)
    assert assumed["total"]["error"] == pytest.approx(0.16)
    assert assumed["total"]["reason"]
    assert overview(gel, FORCE, assumed)["recommended"] == {"1 %": None, "5 %": None}


def test_nothing_is_recommended_where_the_contact_is_larger_than_the_sphere(quickly):
    """What to do is said; a stated surface tension is computed whatever the contact is."""
    tense = replace(BEAD, solid=Section("homogeneous", {"E": 1.5e6, "nu": 0.5, "surface_tension": 0.02}))
    for problem in (BEAD, tense):
        assumed = quickly(problem, contact_radius=6e-6)
        assert assumed["total"]["error"] is None
        content = overview(problem, FORCE, assumed)
        assert content["recommended"] == {"1 %": None, "5 %": None}
        assert content["corrected_force"] is None
        assert "--large-strain" in assumed["remedy"]
        assert ("solid.surface_tension" in assumed["remedy"]) is (problem is BEAD)
        assert (assumed["surface_tension"]["error"] is None) is (problem is BEAD)
    tried = quickly(BEAD, True, contact_radius=6e-6, **{"fem-large-strain": None})
    assert "--large-strain" not in tried["remedy"]
    assert tried["unsolved"] == REASON
    assert "fem-large-strain has 3.000" in quickly(BEAD, True, 6e-6, **{"fem-large-strain": 3.0})["remedy"]


def test_the_corrected_force_has_the_stated_error_and_the_recommended_models_their_forces(bead):
    """The simplest model for 1 % has no force for a paraboloid, and says for which punch it is."""
    force, corrected, total = bead["pull_off_force"], bead["corrected_force"], bead["assumptions"]["total"]
    assert force["value"] / corrected["value"] - 1.0 == pytest.approx(total["error"], rel=1e-9)
    assert corrected["u_num"] == pytest.approx(corrected["value"] * total["u_num"], rel=0.02)
    forces = bead["recommended_forces"]
    assert (forces["1 %"]["punch"], forces["5 %"]["punch"]) == ("ball", "sphere")
    assert forces["5 %"]["value"] == pytest.approx(1.5 * math.pi * 5e-6 * 0.05, rel=1e-9)
    # JKR of the exact sphere is wrong by the error of small strains alone.
    strain = bead["assumptions"]["strain"]["error"]
    assert forces["1 %"]["value"] / (1.0 + strain) == pytest.approx(corrected["value"], abs=corrected["u_num"])
    assert 'punch.kind = "ball"' in description_text(BEAD, bead, None, [], None)


def test_why_finite_strain_was_not_solved_is_said(bead):
    changed = bead | {"assumptions": bead["assumptions"] | {"by_solution": True, "unsolved": REASON}}
    assert REASON in description_text(BEAD, changed, None, [], None)


@pytest.mark.parametrize(("share", "is_recommendable"), [(0.45, True), (0.55, False)])
def test_nothing_is_recommended_for_a_wide_contact_whose_errors_are_unknown(share, is_recommendable, quickly):
    """The table has no solid as soft; vertical gaps alone cost 12 % where the contact has half of the radius."""
    gel = replace(BEAD, solid=Section("homogeneous", {"E": 5e4, "nu": 0.5}))
    assumed = quickly(gel, contact_radius=share * 5e-6, fscm=2.0)
    assert assumed["derjaguin"]["basis"] == assumed["strain"]["basis"] == "unknown"
    assert assumed["recommendable"] is is_recommendable
    assert bool(assumed["refusal"]) is not is_recommendable
    assert any(overview(gel, FORCE, assumed)["recommended"].values()) is is_recommendable


#: A gel under a large bead: at a Tabor number of 8e6 neighbouring nodes of the edge are one number to rounding.
LARGE_BEAD = on_solid("homogeneous", {"E": 20.0, "nu": 0.49}, R=1e-2)


def test_nodes_that_are_one_number_have_no_part_in_the_slopes(monkeypatch):
    """The gap is r^2, the punch r^2/2; the tension is largest at the node that is there twice."""
    r = np.array([0.0, 0.5, 1.0, 1.0, 1.5, 2.0])
    surface = SimpleNamespace(radius=r, gap=r**2, pressure=-np.array([0.0, 0.1, 1.0, 1.0, 0.1, 0.0]))
    monkeypatch.setattr(fscm_model.SharedAnalysis, "pull_off_surface", lambda *_: surface)
    assumed, units = module._measures(LARGE_BEAD), LARGE_BEAD.units
    assert assumed["contact_radius"] == units["radius"]
    slopes = [row["value"] * units["radius"] / units["gap"] for row in assumed["measures"]]
    slope = float(LARGE_BEAD.posed.punch.slope(np.array(1.0)))
    assert slopes == pytest.approx([slope, 2.0 - slope, 2.0])


@pytest.mark.heavy
def test_a_gel_under_a_large_bead_has_slopes():
    assert all(row["value"] > 0.5 for row in module._measures(LARGE_BEAD)["measures"])


def test_the_exact_sphere_has_no_error_of_its_shape(quickly):
    ball = replace(BEAD, punch=Section("ball", {"R": 5e-6}))
    assumed = quickly(ball)
    assert (assumed["geometry"]["error"], assumed["geometry"]["u_num"]) == (0.0, 0.0)
    total = (1.0 + assumed["strain"]["error"]) * (1.0 + assumed["derjaguin"]["error"]) - 1.0
    assert assumed["total"]["error"] == pytest.approx(total)
    force = row("fscm", value=1.5 * math.pi * 5e-6 * 0.05, u_num=1e-15)
    content = overview(ball, force)
    assert {"jkr-sphere", "jkr-sphere-projected"} <= {error["model"] for error in content["errors"]}
    assert "JKR" in content["regime"]


@pytest.mark.heavy
def test_finite_strain_of_a_solid_that_the_table_lacks_is_described(tmp_path, capsys):
    path = tmp_path / "offset.toml"
    path.write_text(
        '[solid]\nkind = "offset-power-law"\nE0 = "2 MPa"\nc0 = "1 um"\nz_s = "1 um"\nk = 0.4\nnu = 0.4\n'
        '[punch]\nkind = "sphere"\nR = "5 um"\n'
        '[law]\nkind = "lennard-jones-9-3"\nwork_of_adhesion = "10 mJ/m^2"\nz0 = "50 nm"\n'
    )
    assert main(["describe", str(path), "--large-strain", "--format", "json"]) == 0
    strain = json.loads(capsys.readouterr().out)["assumptions"]["strain"]
    assert abs(strain["error"]) < 0.01
    assert strain["u_num"] < 1e-4


def test_a_solution_counts_before_the_table_and_where_there_is_none(quickly):
    offset = Section("offset-power-law", {"E0": 2e6, "c0": 1e-6, "z_s": 1e-6, "k": 0.4, "nu": 0.4})
    for problem in (BEAD, replace(BEAD, solid=offset)):
        forces = {"fscm": 2.0, "vertical": 2.5, "fem-large-strain": 4.0}
        assumed = quickly(problem, by_solution=True, **forces)
        assert (assumed["strain"]["error"], assumed["strain"]["basis"]) == (pytest.approx(-0.2), "bound")
        assert (assumed["derjaguin"]["error"], assumed["derjaguin"]["basis"]) == (pytest.approx(-0.375), "bound")
    missing = quickly(BEAD, by_solution=True, **{"fscm": 2.0, "fem-large-strain": None})
    assert missing["unsolved"] == REASON
    for name in ("derjaguin", "strain"):
        assert missing[name] == quickly(BEAD, fscm=2.0)[name]
