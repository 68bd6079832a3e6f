"""Conjugate gradients on pyamg: iterations, agreement with the factorisation, refusal to return a bad
iterate."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from fem_reference._elastic.assembly import HalfSpace, assemble_half_space
from fem_reference._elastic.condensation import surface_stiffness
from fem_reference._elastic.mesh import Grid, MeshSpec, edge_grid
from fem_reference._linear import linear_solver
from fem_reference._linear.conjugate_gradients import conjugate_gradients, products
from fem_reference._linear.linear_solver import solve_cg, solve_direct
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference.errors import Failure, NotConverged
from fem_reference.solid import PowerLaw, ScaledSolid
from fem_reference.verification.solver_study import FULL_STUDY, QUICK_STUDY, solver_table
from tests.marks import heavy
from tests.refusals import refused

#: Measured 5 to 7 for 1e4 to 3e5 unknowns.
ITERATIONS = 8

#: Iterations with the most unknowns over those with the fewest of one material: measured 1.2 at most.
GROWTH = 1.5

#: Error that a cycle of the vertex hierarchy leaves: measured 0.5 to 0.7. With pyamg's smoother, which changes one
#: vertex at a time, it was 0.96 to 0.999.
REDUCTION = 0.8

#: Residual 1e-10 times the condition number left by the preconditioner: measured 7e-12.
AGREEMENT = 1e-8


@pytest.fixture(scope="module")
def half_space():
    return assemble_half_space(edge_grid(edge_width=0.05, extent=16.0, density=0.9), PowerLaw(1.0, 1.0, 0.4, 0.3))


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
    half_space = assemble_half_space(MeshSpec(1e-3, 1e-4, 128.0, 0.35, 2).grid(), PowerLaw(1.0, 1.0, k, nu), order=2)
    hierarchy = ElasticPreconditioner(half_space)._coarse
    error = np.random.default_rng(1).normal(size=hierarchy.levels[0].A.shape[0])
    left = []
    for _ in range(12):
        before = np.sqrt(error @ (hierarchy.levels[0].A @ error))
        error = hierarchy.solve(np.zeros_like(error), x0=error, tol=1e-300, maxiter=1)
        left.append(np.sqrt(error @ (hierarchy.levels[0].A @ error)) / before)
    assert max(left) <= REDUCTION


def test_thin_elements_leave_no_force_by_rounding():
    """Refinement takes the residual to 1e-13; the forces of a matrix keep it at 2e-11 to 5e-11 (measured)."""
    grid = MeshSpec(edge_width=1e-6, surface_depth=1e-6, extent=64.0, density=1.5, order=4).grid()
    half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, 0.4, 0.3), 4)
    assert solve_cg(half_space, _pressed(half_space), tolerance=1e-12).residual <= 1e-12


def test_the_hierarchy_has_the_same_numbers_in_every_run():
    """pyamg takes its random vectors from NumPy's global generator, which is left as it was."""
    # Two levels would have no random numbers: the mesh has three.
    grid = MeshSpec(1e-3, 1e-4, 128.0, 0.45, 4).grid()
    half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, 0.4, 0.3), 4)
    b = np.random.default_rng(4).normal(size=half_space.free.size)
    applied = []
    for seed in (1, 2):
        np.random.seed(seed)  # noqa: NPY002  # that of pyamg
        drawn = np.random.random()  # noqa: NPY002  # that of pyamg
        np.random.seed(seed)  # noqa: NPY002  # that of pyamg
        applied.append(ElasticPreconditioner(half_space)(b))
        assert np.random.random() == drawn  # noqa: NPY002  # that of pyamg
    assert np.array_equal(*applied)


def _pressed(half_space, row=0):
    """A unit load on one row of the surface."""
    load = np.zeros(half_space.elements.size)
    load[half_space.surface[row]] = 1.0
    return load


def test_an_iteration_that_ends_early_raises(half_space):
    raised = refused("in 2 iterations", solve_cg, half_space, _pressed(half_space), iterations=2, error=NotConverged)
    assert raised.failure is Failure.LINEAR


def test_a_residual_that_rounding_keeps_up_is_refused_beyond_what_is_allowed(half_space, monkeypatch):
    """Rounding that is a hundred times the tolerance is a result only where the caller admits it."""
    load, exact = _pressed(half_space), HalfSpace.remainder
    monkeypatch.setattr(HalfSpace, "remainder", lambda *arguments: exact(*arguments) + 1e-8 * load[:, None])
    with pytest.raises(NotConverged, match="reached a residual"):
        solve_cg(half_space, load, rounding=0.0)
    assert 1e-10 < solve_cg(half_space, load, rounding=1e-6).residual <= 1e-6


def test_what_is_left_is_that_of_the_solution_and_of_all_loads(half_space):
    loads = np.stack([_pressed(half_space), np.zeros(half_space.elements.size), _pressed(half_space, 7)], axis=1)
    result = solve_cg(half_space, loads)
    assert result.iterations[1] == 0
    assert np.all(result.iterations[[0, 2]] > 0)
    free = half_space.free
    left = (loads - half_space.matrix @ result.solution)[free]
    assert np.abs(left - result.remainder[free]).max() <= 1e-12
    assert np.abs(left).max() <= 1e-7


def test_a_factorisation_that_misses_the_solution_is_refused(half_space, monkeypatch):
    factorise = linear_solver.factorise
    monkeypatch.setattr(linear_solver, "factorise", lambda A: factorise(A + 1e-6 * sparse.eye_array(A.shape[0])))
    refused("factorisation leaves a residual", solve_direct, half_space, _pressed(half_space), error=NotConverged)


def _shuffled(correction):
    return np.random.default_rng(3).permutation(correction)


#: What is made of pyamg's corrections, and whether it is refused; otherwise it costs iterations.
BROKEN = {
    "none": (np.zeros_like, True),
    "doubled": (lambda correction: 2.0 * correction, True),
    "against the residual": (np.negative, True),
    "reversed": (lambda correction: correction[::-1], True),
    "shuffled": (_shuffled, True),
    "not a number": (lambda correction: np.nan * correction, True),
    "half": (lambda correction: 0.5 * correction, False),
}


@pytest.mark.parametrize("broken", BROKEN)
def test_a_broken_correction_by_pyamg_is_refused_or_costs_iterations(half_space, monkeypatch, broken):
    preconditioner, load = ElasticPreconditioner(half_space), _pressed(half_space)
    whole = solve_cg(half_space, load, preconditioner)
    (change, is_refused), right = BROKEN[broken], preconditioner._coarse.solve
    monkeypatch.setattr(preconditioner._coarse, "solve", lambda *args, **options: change(right(*args, **options)))
    if is_refused:
        refused("correction by pyamg|preconditioner", solve_cg, half_space, load, preconditioner, error=NotConverged)
        return
    result = solve_cg(half_space, load, preconditioner)
    assert result.iterations[0] >= 1.3 * whole.iterations[0]
    assert result.solution == pytest.approx(whole.solution, abs=1e-8 * np.abs(whole.solution).max())


def test_a_sweep_that_is_not_its_own_adjoint_is_refused(half_space, monkeypatch):
    preconditioner = ElasticPreconditioner(half_space)
    columns, (row, _) = preconditioner._columns, preconditioner._rows
    monkeypatch.setattr(preconditioner, "_rows", [row, columns[0]])
    symmetric = solve_cg(half_space, _pressed(half_space), preconditioner)
    assert symmetric.residual <= 1e-10
    monkeypatch.setattr(preconditioner, "_columns", _OneWay(columns))
    refused("not symmetric", solve_cg, half_space, _pressed(half_space), preconditioner, error=NotConverged)


#: Half-spaces whose strips differ in what they hold: an even and an odd number of elements, a surface that is bonded or
#: under tension, a degree without functions between lines of more than one, and a nearly incompressible exterior.
HALF_SPACES = {
    "even": (Grid(np.arange(5.0), np.array([0.0, 1.0, 2.0, 3.0, 4.0])), PowerLaw(1.0, 1.0, 0.0, 0.3), 4),
    "odd": (Grid(np.arange(8.0), np.array([0.0, 0.1, 0.5, 2.0, 4.0, 7.0])), PowerLaw(1.0, 1.0, 0.6, 0.499), 3),
    "one element": (Grid(np.array([0.0, 1.0]), np.array([0.0, 1.0])), PowerLaw(1.0, 1.0, 0.2, 0.3), 5),
    "bonded": (edge_grid(extent=16.0, density=1.5), ScaledSolid(PowerLaw(1.0, 1.0, 0.4, 0.3), bonded=True), 2),
    "tense": (edge_grid(extent=16.0, density=1.5), PowerLaw(1.0, 1.0, 0.0, 0.3, surface_tension=0.7), 3),
}


@pytest.mark.parametrize("name", HALF_SPACES)
def test_strips_are_solved_exactly(name):
    """With the exterior, which couples them all."""
    half_space = assemble_half_space(*HALF_SPACES[name])
    preconditioner, free = ElasticPreconditioner(half_space), half_space.free
    scaled = preconditioner.scale[:, None] * half_space.matrix[free][:, free].toarray() * preconditioner.scale
    for strips in (*preconditioner._columns, *preconditioner._rows):
        load = np.random.default_rng(3).normal(size=(strips.inside.size, 2))
        forces = scaled[strips.inside][:, strips.inside] @ strips.factors.solve(load)
        assert forces == pytest.approx(load, abs=1e-9)


class _OneWay(list):
    """Strips that the way back leaves out."""

    def __reversed__(self):
        return iter(())


@pytest.mark.parametrize(
    ("precondition", "words"),
    [
        (lambda b: 0.0 * b, "not positive definite"),
        (lambda b: -b, "not positive definite"),
        (lambda b: np.nan * b, "not positive definite"),
        (lambda b: b + 0.5 * np.roll(b, 1, axis=0), "not symmetric"),
        (lambda b: 2.0 * b, "no approximate inverse"),
        (lambda b: 1e-4 * b, "no approximate inverse"),
    ],
)
def test_a_preconditioner_that_is_none_is_recognised(precondition, words):
    """Without one this matrix, of eigenvalues 0.5 to 1, is solved."""
    matrix = sparse.diags_array(np.linspace(0.5, 1.0, 40)).tocsr()
    r = np.random.default_rng(2).normal(size=(40, 2))

    def solved(precondition):
        left = precondition(r)
        return conjugate_gradients(matrix, precondition, r, left, 1e-20 * np.abs(products(r, left)), 60)

    assert matrix @ solved(np.copy).solution == pytest.approx(r, abs=1e-8)
    with pytest.raises(NotConverged, match=words):
        solved(precondition)


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
    loose = _with_elements(half_space, _cut_loose)
    raised = refused("; check modulus", solve, loose, _pressed(half_space, 3), error=NotConverged)
    assert raised.failure in (Failure.STIFFNESS, Failure.LINEAR)


@pytest.mark.parametrize("change", [_cut_loose, _made_indefinite])
def test_a_stiffness_that_is_not_positive_definite_is_not_condensed(half_space, change):
    refused(r"singular|positive", surface_stiffness, _with_elements(half_space, change), error=NotConverged)


def test_a_mesh_folded_over_is_refused():
    grid = edge_grid()
    folded = grid.r.copy()
    folded[[3, 4]] = folded[[4, 3]]
    refused("folded over", Grid, folded, grid.z)
