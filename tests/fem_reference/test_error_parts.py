"""Parts of the bound: they add up, each responds to its cause, none is taken from another method."""

import math
from dataclasses import replace

import pytest

from fem_reference._contact.carried import CarriedEvents
from fem_reference._contact.event_mesh import chosen
from fem_reference._contact.parts import PARTS, events_on_meshes
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.quantities import LOSSES, TABLE
from tests.fem_reference.solved_together import PROBLEM, solved

SPEC = MeshSpec(0.0625, 0.01, 64.0, 1.4, 4, 0.05)


@pytest.fixture(scope="module")
def solutions():
    return solved()


@pytest.fixture(scope="module")
def mesh():
    return chosen(PROBLEM, ("zero_load", "landing"), "quick")


@pytest.fixture(scope="module")
def meshes(mesh):
    return events_on_meshes(mesh)


@pytest.fixture(scope="module")
def finer_events(mesh, meshes):
    """The same events on a mesh of another degree, on which every feature is finer too."""
    spec = mesh.spec
    depth, density = spec.surface_depth / 4, 0.85 * mesh.meshes.level.density
    finer = replace(spec, order=7, density=density, surface_depth=depth, extent=4 * spec.extent)
    return CarriedEvents(meshes.fine, mesh.meshes.contact(finer, mesh.size))


@pytest.mark.parametrize("quantity", TABLE)
def test_parts_add_up_to_a_bound_that_covers_the_error_against_a_finer_mesh(quantity, solutions, finer_events):
    solution = solutions[quantity]
    assert abs(solution.value - TABLE[quantity].value(finer_events.at)) <= solution.u_num
    assert tuple(solution.parts) == PARTS
    assert all(0.0 <= part < math.inf for part in solution.parts.values())
    assert math.fsum(solution.parts.values()) == pytest.approx(solution.u_num, rel=1e-12)
    assert solution.u_num > 0.0


def test_the_losses_of_both_jumps_are_the_hysteresis(solutions):
    losses = [solutions[name].value for name in LOSSES]
    assert min(losses) > 0.0
    assert math.fsum(losses) == pytest.approx(solutions["hysteresis_energy"].value, rel=1e-12)


#: How much worse a mesh is made in each feature.
WORSE = {"surface_depth": 16.0, "extent": 1 / 16, "edge_width": 4.0}


def test_every_part_responds_to_a_mesh_that_is_worse_in_every_feature(mesh, meshes):
    spec = mesh.spec
    worse = replace(spec, **{name: factor * getattr(spec, name) for name, factor in WORSE.items()})
    row = TABLE["jump_in_displacement"]
    good, bad = (
        each.estimate(lambda events: row.value(events.at)).parts
        for each in (meshes, events_on_meshes(replace(mesh, spec=worse)))
    )
    assert all(bad[part] > 3.0 * good[part] for part in ("first layer", "interior and exterior", "edge", "tail"))


def test_placement_moves_the_edge_over_the_mesh(meshes):
    inward, outward = (events.at("pull_off") for events in meshes.placements)
    plain = meshes.fine.at("pull_off")
    assert inward.state.size < plain.state.size < outward.state.size
    for moved in (inward, outward):
        assert moved.state.load == pytest.approx(plain.state.load, rel=1e-6)
