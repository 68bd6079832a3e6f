"""Error of what all models assume: its table, how it is continued, and what follows for the choice of a model."""

import itertools
import json
import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons.cli.main import main
from comparisons.description import assumptions as module
from comparisons.description import strain_errors
from comparisons.description.assumptions import SMALL, assumptions
from comparisons.description.forces import reference_force
from comparisons.description.overview import overview
from comparisons.description.strain_errors import Change, beyond, strain_change
from comparisons.description.text import description_text
from comparisons.problem import Section
from tests.comparisons.problem.strain_table import forces_of_a_ball
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
    assumed = bead["assumptions"]
    # JKR of the exact sphere is exact here: a second route to the error of the paraboloid.
    softness = 0.05 / (1.5e6 / 0.75 * 5e-6)
    assert softness == pytest.approx(5e-3)
    assert 1.0 / (1.0 + assumed["geometry"]["error"]) == pytest.approx(0.973699, abs=2e-5)
    assert -0.01 < assumed["strain"]["error"] < 0.0
    assert 0.02 < assumed["total"]["error"] + assumed["total"]["u_num"] < 0.05
    # The contact radius of JKR: a^3 = 9 pi w R^2 / (8 E*).
    a = (9 * math.pi * 0.05 * 5e-6**2 / (8 * 2e6)) ** (1 / 3)
    assert assumed["contact_radius"] == pytest.approx(a, rel=0.02)
    measures = {row["key"]: row["value"] for row in assumed["measures"]}
    assert measures["punch_slope"] == pytest.approx(assumed["contact_radius"] / 5e-6)
    assert min(measures.values()) > SMALL
    assert bead["recommended"] == {"1 %": "jkr-sphere", "5 %": "jkr"}
    errors = {row["model"]: row["error"] for row in bead["total_errors"]}
    assert errors["jkr"] == pytest.approx(assumed["total"]["error"], abs=1e-4)
    assert errors["jkr-sphere"] == pytest.approx(assumed["strain"]["error"], abs=1e-4)


@pytest.mark.parametrize("by_solution", [False, True])
def test_finite_strain_is_proposed_until_it_was_tried(bead, by_solution):
    strain = {"error": None, "u_num": None, "reason": "unknown"}
    changed = bead | {"assumptions": bead["assumptions"] | {"strain": strain, "by_solution": by_solution}}
    assert ("--large-strain" in description_text(BEAD, changed, None, [], None)) is not by_solution


FORCE = row("fscm", value=2.0, u_num=1e-9)


@pytest.fixture
def quickly(monkeypatch):
    """What the assumptions of a problem are beside a force of 2, with numbers in place of the solvers'."""

    def assumed(problem, by_solution=False, contact_radius=1e-9, **forces):
        monkeypatch.setattr(module, "_measures", lambda _: {"contact_radius": contact_radius, "measures": []})
        monkeypatch.setattr(module, "evaluate", lambda model, *_: row(model, value=forces[model], u_num=1e-9))
        return assumptions(problem, FORCE, by_solution)

    return assumed


def test_no_model_is_recommended_where_the_assumptions_exceed_the_limit(quickly):
    assumed = quickly(BEAD, **{"fscm": 1.8, "jkr-sphere": 2.4})
    assumed |= {"total": {"error": 0.06, "u_num": 0.0, "reason": ""}}
    assert assumed["geometry"]["error"] == pytest.approx(2.0 / 1.8 - 1.0)
    assert overview(BEAD, FORCE, assumed)["recommended"] == {"1 %": None, "5 %": None}


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"solid": Section("power-law", {"E0": 1e9, "c0": 1e-6, "k": 0.4, "nu": 0.3})}, "homogeneous"),
        ({"punch": Section("cone", {"half_angle": 1.2})}, "spheres"),
        ({"solid": Section("homogeneous", {"E": 5e4, "nu": 0.5})}, "as soft as"),
    ],
)
def test_where_nothing_was_computed_the_error_is_unknown(changed, reason, quickly):
    problem = replace(BEAD, **changed)
    assumed = quickly(problem, fscm=2.0)
    assert assumed["strain"]["error"] is assumed["total"]["error"] is None
    assert reason in assumed["strain"]["reason"]
    assert overview(problem, FORCE, assumed)["total_errors"] == []


def test_nothing_is_recommended_where_the_contact_is_larger_than_the_sphere(quickly):
    assumed = quickly(BEAD, contact_radius=6e-6)
    assert assumed["total"]["error"] is None
    assert overview(BEAD, FORCE, assumed)["recommended"] == {"1 %": None, "5 %": None}


def test_the_exact_sphere_has_no_error_of_its_shape(quickly):
    ball = replace(BEAD, punch=Section("ball", {"R": 5e-6}))
    assumed = quickly(ball)
    assert (assumed["geometry"]["error"], assumed["geometry"]["u_num"]) == (0.0, 0.0)
    assert assumed["total"]["error"] == pytest.approx(assumed["strain"]["error"])
    force = row("fscm", value=1.5 * math.pi * 5e-6 * 0.05, u_num=1e-15)
    content = overview(ball, force)
    assert [error["model"] for error in content["errors"]] == ["jkr-sphere"]
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
        strain = quickly(problem, by_solution=True, **{"fscm": 2.0, "fem-large-strain": 2.5})["strain"]
        assert strain["error"] == pytest.approx(-0.2)
    strain = quickly(BEAD, by_solution=True, **{"fscm": 2.0, "fem-large-strain": None})["strain"]
    assert strain == quickly(BEAD, fscm=2.0)["strain"]


def test_a_larger_tabor_number_is_inside_the_bound_of_smaller_ones():
    worst = 0.0
    for nodes in strain_errors._table().values():
        numbers = np.array(sorted(nodes))
        for count in range(3, numbers.size):
            change = beyond(numbers[:count], [nodes[number] for number in numbers[:count]])
            worst = max(
                worst, *(abs(nodes[number].value - change.value) / change.uncertainty for number in numbers[count:])
            )
    assert 0.5 < worst < 0.7


def test_between_rows_the_error_is_inside_the_bound():
    """A row that is left out, from its neighbours in w/(E* R)."""
    roots, ratios = np.cbrt(strain_errors.SOFTNESS), []
    for nu, mu in itertools.product(strain_errors.POISSON_RATIOS, (0.3, 1.0, 2.0)):
        nodes = [strain_errors._table()[softness, nu].get(mu) for softness in strain_errors.SOFTNESS]
        known = [i for i, node in enumerate(nodes) if node is not None]
        for left_out in known[1:-1]:
            others = [i for i in known if i != left_out]
            change = strain_errors._between(roots[others], [nodes[i] for i in others], roots[left_out])
            ratios.append(abs(change.value - nodes[left_out].value) / change.uncertainty)
    assert 0.5 < max(ratios) < 1.0


def test_the_limits_of_the_table():
    small, smaller = strain_change(1e-5, 1.0, 0.5), strain_change(1e-8, 1.0, 0.5)
    assert smaller.value == pytest.approx(small.value / 10.0, rel=0.05)
    assert strain_change(1e-3, 0.05, 0.5).uncertainty < 1e-4
    assert strain_change(0.11, 1.0, 0.5) is None
    assert beyond(np.array([1.0, 2.0]), [Change(1.0, 0.0), Change(1.5, 0.1)]) == (1.75, 0.5 + 0.75 + 0.1, True)


@pytest.mark.parametrize(
    ("softness", "mu", "nu", "is_extrapolated"),
    [
        # Rows of the table, values between them, and beyond the last Tabor number of either neighbour.
        (5e-3, 2.0, 0.5, False),
        (5e-3, 0.1, 0.0, False),
        (2e-3, 1.5, 0.4, False),
        (5e-3, 365.0, 0.5, True),
        (2e-2, 2.0, 0.4, True),
        (3e-3, 4.0, 0.5, True),
        # Below the first Tabor number, and below the least w/(E* R).
        (5e-3, 0.05, 0.5, True),
        (9e-6, 1.0, 0.5, True),
    ],
)
def test_a_change_outside_the_table_is_an_estimate(softness, mu, nu, is_extrapolated):
    assert strain_change(softness, mu, nu).is_extrapolated is is_extrapolated


def test_an_estimated_error_of_the_assumptions_is_called_so(quickly):
    """The bead has the Tabor number 365; that of a small sphere on a stiff solid, 2.4, is in the table."""
    for problem, is_estimate in ((BEAD, True), (on_solid("homogeneous", {"E": 4e8, "nu": 0.5}), False)):
        assumed = quickly(problem, **{"fscm": 2.0, "jkr-sphere": 2.0})
        assert [assumed[key]["is_estimate"] for key in ("geometry", "strain", "total")] == [
            False,
            is_estimate,
            is_estimate,
        ]
        errors = overview(problem, FORCE, assumed)["total_errors"]
        assert {error["is_estimate"] for error in errors} == {is_estimate}


def test_the_text_calls_an_estimate_one(bead):
    """Those of the strain, of all assumptions together, and of the models with them."""
    assert description_text(BEAD, bead, None, [], None).count("an estimate") == 3


@pytest.mark.heavy
@pytest.mark.parametrize(("softness", "mu", "nu"), [(5e-3, 2.0, 0.5), (4e-2, 0.6, 0.45), (2e-3, 0.05, 0.3)])
def test_rows_and_values_between_them_are_what_both_references_give(softness, mu, nu):
    finite, small = forces_of_a_ball(softness, mu, nu)
    change = strain_change(softness, mu, nu)
    bound = change.uncertainty + (finite.u_num + small.u_num) / small.value
    assert finite.value / small.value - 1.0 == pytest.approx(change.value, abs=bound)
