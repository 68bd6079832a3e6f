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
from comparisons.description.strain_errors import Change, beyond, body_change, strain_change
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
    assert assumed["total"]["error"] == pytest.approx(-0.013, abs=1.5e-3)
    assert assumed["total"]["u_num"] < 3e-3
    bases = [assumed[name]["basis"] for name in ("geometry", "derjaguin", "strain", "total")]
    assert bases == ["bound", "estimate", "estimate", "estimate"]
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
    projected = (1.0 + assumed["strain"]["error"]) * (1.0 + area["error"]) - 1.0
    assert errors["jkr-sphere-projected"] == pytest.approx(projected, abs=1e-4)


@pytest.mark.parametrize("by_solution", [False, True])
def test_finite_strain_is_proposed_until_it_was_tried(bead, by_solution):
    strain = {"error": None, "u_num": None, "basis": "unknown", "reason": "unknown"}
    changed = bead | {"assumptions": bead["assumptions"] | {"strain": strain, "by_solution": by_solution}}
    assert ("--large-strain" in description_text(BEAD, changed, None, [], None)) is not by_solution


FORCE = row("fscm", value=2.0, u_num=1e-9)


@pytest.fixture
def quickly(monkeypatch):
    """What the assumptions of a problem are beside a force of 2, with numbers in place of the solvers'."""

    def assumed(problem, by_solution=False, contact_radius=1e-9, **forces):
        monkeypatch.setattr(module, "_measures", lambda _: {"contact_radius": contact_radius, "measures": []})
        forces.setdefault("vertical", forces.get("fem-large-strain"))
        monkeypatch.setattr(module, "LargeStrain", lambda interaction: "vertical")
        monkeypatch.setattr(module, "evaluate", lambda model, *_: row(model, value=forces.get(model), u_num=1e-9))
        return assumptions(problem, FORCE, by_solution)

    return assumed


def test_no_model_is_recommended_where_the_assumptions_exceed_the_limit(quickly):
    assumed = quickly(BEAD, **{"fscm": 1.8, "jkr-sphere": 2.4})
    assumed |= {"total": {"error": 0.06, "u_num": 0.0, "basis": "bound", "reason": ""}}
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
    assumed = quickly(problem, fscm=1.6)
    for name in ("derjaguin", "strain"):
        assert (assumed[name]["error"], assumed[name]["basis"]) == (None, "unknown")
    assert reason in assumed["strain"]["reason"]
    assert "vertical gaps and small strains" in assumed["total"]["reason"]
    is_sphere = problem.punch.kind == "sphere"
    assert assumed["total"]["error"] == (pytest.approx(0.25) if is_sphere else None)


def test_what_is_known_counts_beside_what_is_not(quickly):
    """A gel whose paraboloid is off by 16 %: nothing is recommended within 5 % although strain is unknown."""
    coated = replace(BEAD, solid=Section("offset-power-law", {"E0": 2e6, "c0": 1e-6, "z_s": 1e-6, "k": 0.4, "nu": 0.4}))
    assumed = quickly(coated, fscm=2.0 / 1.16)
    assert assumed["total"]["error"] == pytest.approx(0.16)
    assert assumed["total"]["reason"]
    assert overview(coated, FORCE, assumed)["recommended"] == {"1 %": None, "5 %": None}


def test_nothing_is_recommended_where_the_contact_is_larger_than_the_sphere(quickly):
    assumed = quickly(BEAD, contact_radius=6e-6)
    assert assumed["total"]["error"] is None
    assert overview(BEAD, FORCE, assumed)["recommended"] == {"1 %": None, "5 %": None}


def test_the_exact_sphere_has_no_error_of_its_shape(quickly):
    ball = replace(BEAD, punch=Section("ball", {"R": 5e-6}))
    assumed = quickly(ball)
    assert (assumed["geometry"]["error"], assumed["geometry"]["u_num"]) == (0.0, 0.0)
    total = (1.0 + assumed["strain"]["error"]) * (1.0 + assumed["derjaguin"]["error"]) - 1.0
    assert assumed["total"]["error"] == pytest.approx(total)
    force = row("fscm", value=1.5 * math.pi * 5e-6 * 0.05, u_num=1e-15)
    content = overview(ball, force)
    assert {error["model"] for error in content["errors"]} == {"jkr-sphere", "jkr-sphere-projected"}
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
    for name in ("derjaguin", "strain"):
        assert missing[name] == quickly(BEAD, fscm=2.0)[name]


def test_a_larger_tabor_number_is_inside_the_uncertainty_of_smaller_ones():
    worst = 0.0
    for softness, nu in itertools.product(strain_errors.SOFTNESS, strain_errors.POISSON_RATIOS):
        nodes = strain_errors._strains(softness, nu)
        numbers = np.array(sorted(nodes))
        for count in range(3, numbers.size):
            change = beyond(numbers[:count], [nodes[number] for number in numbers[:count]])
            worst = max(
                worst, *(abs(nodes[number].value - change.value) / change.uncertainty for number in numbers[count:])
            )
    assert 0.5 < worst < 0.7


@pytest.mark.parametrize("column", ["strain", "area"])
def test_towards_its_limit_a_change_is_inside_the_uncertainty_of_smaller_tabor_numbers(column):
    """The last row of a compressible solid apart, each from those before it and the limit."""
    for softness in strain_errors.SOFTNESS[:4]:
        if column == "strain":
            nodes, limit = strain_errors._strains(softness, 0.5), strain_errors._limit(softness, 0.5)
        else:
            nodes, limit = strain_errors._areas(softness), Change(1.0, 0.0)
        numbers = sorted(mu for mu in nodes if mu >= 2.0)
        for last, mu in itertools.pairwise(numbers):
            change = strain_errors._towards(limit, nodes[last], last / mu)
            assert abs(nodes[mu].value - change.value) <= change.uncertainty + nodes[mu].uncertainty, (softness, mu)
            assert change.uncertainty < 0.25 * abs(limit.value)


def test_between_rows_the_error_is_inside_the_bound():
    """A row that is left out, from its neighbours in w/(E* R)."""
    roots, ratios = np.cbrt(strain_errors.SOFTNESS), []
    columns = [(nu, strain_errors._strains) for nu in strain_errors.POISSON_RATIOS] + [(0.5, strain_errors._areas)]
    for (nu, column), mu in itertools.product(columns, (0.3, 1.0, 2.0)):
        nodes = [column(softness, nu).get(mu) for softness in strain_errors.SOFTNESS]
        known = [i for i, node in enumerate(nodes) if node is not None]
        for left_out in known[1:-1]:
            others = [i for i in known if i != left_out]
            change = strain_errors._between(roots[others], [nodes[i] for i in others], roots[left_out])
            ratios.append(abs(change.value - nodes[left_out].value) / change.uncertainty)
    assert 0.5 < max(ratios) < 1.0


def test_the_area_of_another_poisson_ratio_is_that_of_the_incompressible_solid_within_its_uncertainty():
    shares = []
    for softness, nu in itertools.product(strain_errors.SOFTNESS, strain_errors.POISSON_RATIOS[:-1]):
        for mu, node in strain_errors._areas(softness, nu).items():
            distance = abs(node.value - strain_errors._areas(softness)[mu].value)
            shares.append(distance / (strain_errors.OTHER_RATIOS * np.cbrt(softness)))
    assert 0.5 < max(shares) < 1.0


def test_the_potential_of_a_ball_on_a_rigid_solid():
    """Both loads are one integral but for the shape of the punch beyond 0.95 R, whose effect falls as (z0/R)^2."""
    changes = [strain_errors.rigid_change(share) for share in (0.02, 0.01)]
    assert changes[0] / changes[1] == pytest.approx(4.0, rel=0.02)
    # By the elements at w/(E* R) = 1e-3 and mu = 0.02, a stiff ball for its z0 of R/2.
    assert strain_errors.rigid_change(0.5) == pytest.approx(-0.0966, abs=1e-3)


def test_the_limits_of_the_table():
    small, smaller = strain_change(1e-5, 1.0, 0.5), strain_change(1e-8, 1.0, 0.5)
    assert smaller.value == pytest.approx(small.value / 10.0, rel=0.05)
    assert strain_change(1e-3, 0.05, 0.5).uncertainty < 1e-4
    assert strain_change(0.11, 1.0, 0.5) is body_change(0.11, 1.0, 0.5) is None
    assert body_change(1e-3, 1e6, 0.5).value == pytest.approx(1.002354 / 0.990819 - 1.0, rel=2e-3)
    assert beyond(np.array([1.0, 2.0]), [Change(1.0, 0.0), Change(1.5, 0.1)]) == (1.75, 0.5 + 0.75 + 0.1)


@pytest.mark.heavy
@pytest.mark.parametrize(("softness", "mu", "nu"), [(5e-3, 2.0, 0.5), (4e-2, 0.6, 0.45), (2e-3, 0.05, 0.3)])
def test_rows_and_values_between_them_are_what_both_references_give(softness, mu, nu):
    body, vertical, small = forces_of_a_ball(softness, mu, nu)
    pairs = ((strain_change, vertical, small), (body_change, body, vertical))
    for function, changed, force in pairs:
        change = function(softness, mu, nu)
        bound = change.uncertainty + (changed.u_num + force.u_num) / force.value
        assert changed.value / force.value - 1.0 == pytest.approx(change.value, abs=bound)
