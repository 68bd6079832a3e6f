"""Conjugate gradients on pyamg: iterations, agreement with the factorisation, refusal to return a bad
iterate."""

from dataclasses import replace

import numpy as np
import pytest

from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.condensation import surface_stiffness
from fem_reference._elastic.mesh import Grid, MeshSpec, graded_grid
from fem_reference._linear.linear_solver import solve_cg, solve_direct
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference.errors import NotConverged
from fem_reference.modulus import PowerLawModulus
from fem_reference.verification.solver_study import FULL_STUDY, QUICK_STUDY, solver_table
from tests.marks import heavy
from tests.refusals import refused

#: Measured 6 to 9 for 1e4 to 5e5 unknowns.
ITERATIONS = 10

#: Iterations with the most unknowns over those with the fewest of one material: measured 1.2 at most.
GROWTH = 1.5

#: Error that a cycle of the vertex hierarchy leaves: measured 0.5 to 0.7. With pyamg's smoother, which changes one
#: vertex at a time, it was 0.96 to 0.999.
REDUCTION = 0.8

#: Residual 1e-10 times the condition number left by the preconditioner: measured 7e-12.
AGREEMENT = 1e-8


@pytest.fixture(scope="module")
def half_space():
    return assemble_half_space(
        graded_grid(edge_width=0.05, extent=16.0, density=0.9), PowerLawModulus(1.0, 1.0, 0.4), 0.3
    )


@pytest.mark.parametrize("study", [QUICK_STUDY, *heavy((FULL_STUDY,))], ids=len)
def test_the_iterations_do_not_grow_with_the_unknowns(study):
    rows = solver_table(study)
    for row in rows:
        assert row.iterations <= ITERATIONS, row
        assert row.residual <= 1e-10, row
        assert row.agreement <= AGREEMENT, row
        assert row.megabytes <= 4000, row
        of_material = [r for r in rows if (r.k, r.nu, r.edge_width) == (row.k, row.nu, row.edge_width)]
        fewest = min(of_material, key=lambda r: r.unknowns)
        assert row.iterations <= GROWTH * fewest.iterations, row


@pytest.mark.parametrize(("k", "nu"), [(0.0, 0.0), (0.8, 0.45)])
def test_a_cycle_of_the_hierarchy_reduces_every_error(k, nu):
    """On elements of every aspect ratio, too; otherwise the iterations grow with the mesh."""
    half_space = assemble_half_space(
        MeshSpec(1e-3, 1e-4, 128.0, 0.35, 2).grid(), PowerLawModulus(1.0, 1.0, k), nu, order=2
    )
    hierarchy = ElasticPreconditioner(half_space)._coarse
    error = np.random.default_rng(1).normal(size=hierarchy.levels[0].A.shape[0])
    left = []
    for _ in range(12):
        before = np.sqrt(error @ (hierarchy.levels[0].A @ error))
        error = hierarchy.solve(np.zeros_like(error), x0=error, tol=1e-300, maxiter=1)
        left.append(np.sqrt(error @ (hierarchy.levels[0].A @ error)) / before)
    assert max(left) <= REDUCTION


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 1e-18, reason="this machine has no extended precision")
def test_thin_elements_leave_no_force_by_rounding():
    """The residual is 1e-13; with sums in double precision it was 2e-11 to 5e-11 (measured)."""
    grid = MeshSpec(edge_width=1e-6, surface_depth=1e-6, extent=64.0, density=1.5, order=4).grid()
    half_space = assemble_half_space(grid, PowerLawModulus(1.0, 1.0, 0.4), 0.3, 4)
    load = np.zeros(half_space.elements.size)
    load[half_space.surface[0]] = 1.0
    assert solve_cg(half_space, load, tolerance=1e-12).residual <= 1e-12


def test_the_hierarchy_has_the_same_numbers_in_every_run():
    """pyamg takes its random vectors from NumPy's global generator, which is left as it was."""
    # Two levels would have no random numbers: the mesh has three.
    grid = MeshSpec(1e-3, 1e-4, 128.0, 0.45, 4).grid()
    half_space = assemble_half_space(grid, PowerLawModulus(1.0, 1.0, 0.4), 0.3, 4)
    b = np.random.default_rng(4).normal(size=half_space.free.size)
    applied = []
    for seed in (1, 2):
        np.random.seed(seed)  # noqa: NPY002  # that of pyamg
        drawn = np.random.random()  # noqa: NPY002  # that of pyamg
        np.random.seed(seed)  # noqa: NPY002  # that of pyamg
        applied.append(ElasticPreconditioner(half_space)(b))
        assert np.random.random() == drawn  # noqa: NPY002  # that of pyamg
    assert np.array_equal(*applied)


def test_an_iteration_that_ends_early_raises_and_what_rounding_leaves_does_not(half_space):
    load = np.zeros(half_space.matrix.shape[0])
    load[half_space.surface[0]] = 1.0
    refused("allow more iterations", solve_cg, half_space, load, iterations=2, error=NotConverged)
    with pytest.raises(NotConverged, match="conjugate gradients reached a residual"):
        solve_cg(half_space, load, tolerance=1e-18, rounding=0.0)
    assert 1e-18 < solve_cg(half_space, load, tolerance=1e-18).residual <= 1e-12


def _with_elements(half_space, change):
    """The half-space whose elements have another stiffness."""
    stiffness = half_space.elements.stiffness.copy()
    change(stiffness, half_space.elements.sides, half_space.surface)
    return replace(half_space, elements=replace(half_space.elements, stiffness=stiffness))


def _cut_loose(stiffness, sides, surface):
    """An unknown that nothing holds: its rows and columns are gone."""
    element, column = np.nonzero(sides == surface[3])
    stiffness[element, column, :] = 0.0
    stiffness[element, :, column] = 0.0


def _made_indefinite(stiffness, sides, surface):
    """A spring that pushes: the diagonal stays positive."""
    element, column = np.nonzero(sides == surface[3])
    stiffness[element, column, column] *= 1e-3


@pytest.mark.filterwarnings("ignore:divide by zero")
@pytest.mark.parametrize("solve", [solve_direct, solve_cg])
def test_a_singular_matrix_raises_with_what_to_check(half_space, solve):
    load = np.zeros(half_space.elements.size)
    load[half_space.surface[3]] = 1.0
    refused(r"check modulus|more iterations", solve, _with_elements(half_space, _cut_loose), load, error=NotConverged)


@pytest.mark.parametrize("change", [_cut_loose, _made_indefinite])
def test_a_stiffness_that_is_not_positive_definite_is_not_condensed(half_space, change):
    refused(r"singular|positive", surface_stiffness, _with_elements(half_space, change), error=NotConverged)


def test_a_mesh_folded_over_is_refused():
    grid = graded_grid()
    folded = grid.r.copy()
    folded[[3, 4]] = folded[[4, 3]]
    refused("folded over", Grid, folded, grid.z)
