"""Parts of the bound: they add up, each responds to its cause, none is taken from another method."""

import math
import re
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

import fem_reference
from fem_reference import LennardJones, NotConverged, PowerPunch, Problem, Solution, solve
from fem_reference._contact import error_parts
from fem_reference._contact.error_parts import PARTS, events_on_meshes
from fem_reference._contact.mesh_choice import chosen
from fem_reference._contact.resolved import ResolvedEvents
from fem_reference._contact.tail import TailContact
from fem_reference._elastic.compliance import ScalingCompliance
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.variants import FEATURES, variant
from fem_reference.modulus import CustomModulus
from fem_reference.quantities import LOSSES, TABLE
from tests.fem_reference.profile_solid import ProfileSolid
from tests.fem_reference.solved_together import PROBLEM, problem_with, solved


def _coated(z):
    return 1.0 + 10.0 * np.exp(-z / 2.0)


SPEC = MeshSpec(0.0625, 0.01, 64.0, 1.4, 4, 0.05)


@lru_cache(maxsize=1)
def _chosen():
    return chosen(PROBLEM, ("zero_load", "landing"), "quick")


@lru_cache(maxsize=1)
def _meshes():
    return events_on_meshes(*_chosen())


def _contact(spec):
    choice, _, size = _chosen()
    return choice.contact(spec, size)


@lru_cache(maxsize=1)
def _finer_events():
    """The same events on a mesh of another degree, on which every feature is finer too."""
    choice, spec, _ = _chosen()
    depth, density = spec.surface_depth / 4, 0.85 * choice.level.density
    finer = replace(spec, order=7, density=density, surface_depth=depth, extent=4 * spec.extent)
    return ResolvedEvents(_meshes().fine, _contact(finer))


@pytest.mark.parametrize("quantity", TABLE)
def test_parts_add_up(quantity):
    solution = solved()[quantity]
    assert tuple(solution.parts) == PARTS
    assert all(0.0 <= part < math.inf for part in solution.parts.values())
    assert math.fsum(solution.parts.values()) == pytest.approx(solution.u_num, rel=1e-12)
    assert solution.u_num > 0.0


@pytest.mark.parametrize("quantity", TABLE)
def test_bound_covers_the_error_against_a_finer_mesh(quantity):
    reference = TABLE[quantity].functional(_finer_events())
    solution = solved()[quantity]
    assert abs(solution.value - reference) <= solution.u_num


def test_the_losses_of_both_jumps_are_the_hysteresis():
    losses = [solved()[name].value for name in LOSSES]
    assert min(losses) > 0.0
    assert math.fsum(losses) == pytest.approx(solved()["hysteresis_energy"].value, rel=1e-12)


def test_added_part_is_added_to_the_bound():
    solution = Solution(1.0, 3e-9, 100, 3, 0.0, 0.1, (4, 6, 7), (1.0, 1.0, 1.0), {"mesh": 3e-9})
    more = solution.with_part("algebra", 1e-9).with_part("algebra", 1e-9).with_part("mesh", 5e-9)
    assert more.parts == {"mesh": 8e-9, "algebra": 2e-9}
    assert more.u_num == pytest.approx(math.fsum(more.parts.values()))
    assert solution.parts == {"mesh": 3e-9}
    for error in (-1e-9, math.nan, math.inf):
        with pytest.raises(ValueError, match="outside"):
            solution.with_part("algebra", error)


#: Part of a bound -> how much worse a mesh is made in the feature that causes it.
CAUSES = {
    "first layer": {"surface_depth": 16.0},
    "interior and exterior": {"extent": 1 / 16},
    "edge": {"edge_width": 4.0},
    "tail": {"extent": 1 / 16},
}


def _parts_on_a_worse_mesh(change):
    """The parts on the mesh, and on one that is worse in some features."""
    choice, spec, size = _chosen()
    worse = replace(spec, **{name: factor * getattr(spec, name) for name, factor in change.items()})
    functional = TABLE["jump_in_displacement"].functional
    return (meshes.estimate(functional).parts for meshes in (_meshes(), events_on_meshes(choice, worse, size)))


def test_every_part_responds_to_a_mesh_that_is_worse_in_every_feature():
    """The next test has each part and its cause alone."""
    good, bad = _parts_on_a_worse_mesh({name: factor for one in CAUSES.values() for name, factor in one.items()})
    assert [part for part in CAUSES if not bad[part] > 3.0 * good[part]] == []


@pytest.mark.heavy
@pytest.mark.parametrize("part", CAUSES)
def test_a_part_responds_to_its_cause(part):
    """A mesh that is worse in one feature has a larger part of that name."""
    good, bad = _parts_on_a_worse_mesh(CAUSES[part])
    assert bad[part] > 3.0 * good[part]


@pytest.mark.heavy
def test_mesh_part_falls_with_the_accuracy():
    parts = [
        solve(problem_with(0.0, 0.3), "pull_off_force", accuracy).parts["mesh"] for accuracy in ("quick", "default")
    ]
    assert 0.0 < parts[1] < 0.3 * parts[0]


@pytest.mark.heavy
def test_a_coated_solid_on_a_larger_interior_stays_within_its_part():
    """E = 1 + 10 exp(-z/2): how far the mesh reaches decides the displacement, and only a longer mesh shows it."""
    solid = ProfileSolid(CustomModulus(_coated, 0.0, 0.0, surface_depth=2.0), 0.3)
    problem = Problem(solid, PowerPunch(5.0, 1.0), LennardJones(1.0, 1.0))
    solution = solve(problem, "pull_off_displacement", "quick")
    choice, spec, size = chosen(problem, ("pull_off",), "quick")
    larger = replace(spec, extent=4.0 * spec.extent)
    reference = ResolvedEvents(events_on_meshes(choice, spec, size).fine, choice.contact(larger, size)).at("pull_off")
    change = abs(reference.state.displacement - solution.value)
    mesh = solution.parts["mesh"] + solution.parts["first layer"]
    assert change <= solution.parts["interior and exterior"] + mesh
    assert solution.u_num < 1e-3


def test_algebra_part_responds_to_rounding(monkeypatch):
    meshes = _meshes()
    contact = meshes.fine.contact
    matrix = contact.compliance.matrix
    monkeypatch.setattr(
        ScalingCompliance, "rounded", lambda self: replace(self, matrix=self.matrix * (1 + 1e-6), rounding=0.0)
    )
    worse = replace(meshes, rounding=ResolvedEvents(meshes.fine, error_parts._rounded(contact)))
    functional = TABLE["pull_off_displacement"].functional
    small, large = (each.estimate(functional).parts["algebra"] for each in (meshes, worse))
    assert small < 1e-10
    assert large > 1e-8
    assert contact.compliance.matrix is matrix


def test_condensation_shows_its_rounding():
    """The two triangles of the factorisation differ by rounding, and the inverse of either is the compliance."""
    compliance = _contact(SPEC).compliance
    change = compliance.rounded().matrix - compliance.matrix
    largest = np.abs(compliance.matrix).max()
    assert 0.0 < np.abs(change).max() < 1e-9 * largest
    assert change == pytest.approx(change.T, abs=1e-15 * largest)


@pytest.mark.heavy
def test_tail_is_that_of_a_longer_mesh():
    """What the mesh leaves out is found again on one that ends much farther away."""
    problem = problem_with(0.2, 0.5, n=1.2)
    choice, spec, size = chosen(problem, ("pull_off",), "quick")
    path = choice.traced(spec, size)
    functional = TABLE["pull_off_displacement"].functional
    short = replace(spec, extent=64.0)
    near, far = (choice.contact(mesh, size) for mesh in (short, spec))
    tail = TailContact(near.punch, near.law, near.compliance, 0.2)
    plain, corrected, complete = (functional(ResolvedEvents(path, c)) for c in (near, tail, far))
    assert abs(plain - complete) > 1e-6
    assert abs(corrected - complete) < 0.2 * abs(plain - complete)


def test_tail_has_the_derivative_of_its_load():
    plain = _contact(replace(SPEC, extent=16.0))
    contact = TailContact(plain.punch, plain.law, plain.compliance, 0.3)
    y = np.concatenate([np.full(contact.unknowns, 0.1), [-0.5, 1.5]])
    h = 1e-6
    for index in (0, int(contact.compliance.trace.nodes.size) - 1, -2, -1):
        step = np.zeros(y.size)
        step[index] = h
        slope = (contact.load(y + step) - contact.load(y - step)) / (2 * h)
        assert contact.load_gradient(y)[index] == pytest.approx(slope, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("feature", FEATURES)
def test_variant_changes_one_feature(feature):
    plain, other = SPEC.grid(), variant(SPEC, feature).grid()
    assert hash(variant(SPEC, feature)) != hash(SPEC)
    if feature == "extent":
        assert 2.0 <= plain.extent / other.extent < 16.0
        assert np.isin(other.r, plain.r).all()
        assert np.isin(other.z[:-1], plain.z).all()
    else:
        kept, changed = ("r", "z") if feature == "first layer" else ("z", "r")
        assert np.array_equal(getattr(plain, kept), getattr(other, kept))
        assert np.array_equal(np.delete(getattr(plain, changed), 1), getattr(other, changed))
    with pytest.raises(ValueError, match="choose one of"):
        variant(SPEC, "edge")


def test_placement_moves_the_edge_over_the_mesh():
    meshes = _meshes()
    inward, outward = (events.at("pull_off") for events in meshes.placements)
    plain = meshes.fine.at("pull_off")
    assert inward.state.size < plain.state.size < outward.state.size
    for moved in (inward, outward):
        assert moved.state.load == pytest.approx(plain.state.load, rel=1e-6)


def test_event_that_another_mesh_does_not_have_is_refused():
    """Here the load of the other problem has no point without load near that of the path."""
    meshes = _meshes()
    contact = meshes.fine.contact
    stiffer = replace(contact, compliance=replace(contact.compliance, matrix=1e-3 * contact.compliance.matrix))
    with pytest.raises(NotConverged):
        ResolvedEvents(meshes.fine, stiffer).at("jump_in")


def test_no_constant_is_taken_from_the_other_method():
    """The package names the integral equation nowhere but in the rule of its independence."""
    for path in Path(fem_reference.__file__).parent.rglob("*.py"):
        assert not re.search(r"integral equation|\bfscm\b|FSCM", path.read_text(encoding="utf-8")), path.name
