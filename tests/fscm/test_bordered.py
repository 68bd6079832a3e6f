"""The bordered tangent: its elimination, and what it leaves to the nodes far out."""

import numpy as np
import pytest

from fscm import NotConverged
from fscm._surface import bordered_factor
from fscm._surface.bordered import FAR, Bordered
from fscm._surface.bordered_factor import BorderedFactor
from fscm._surface.elimination import Elimination

#: Rounding of the solutions, relative to the largest one; measured worst 2e-13.
ROUNDED = 1e-11
SIZE = 230


def bordered(seed=0, matrix=None, far=0):
    """A bordered matrix of random entries, or of those given, with nodes far out."""
    rng = np.random.default_rng(seed)
    matrix = np.eye(SIZE) + rng.normal(size=(SIZE, SIZE)) / SIZE if matrix is None else matrix
    slope = np.full(SIZE, -1.0)
    slope[SIZE - far :] = 0.0
    return Bordered(matrix - np.eye(SIZE), slope, rng.normal(size=(SIZE, 2)), rng.normal(size=(2, SIZE + 2)))


def difference(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


@pytest.mark.parametrize("largest", [1, 7, 60, SIZE])
@pytest.mark.parametrize("count", [(), (3,)], ids=["vector", "matrix"])
def test_blocks_of_any_size_solve_the_system(largest, count):
    rng = np.random.default_rng(1)
    matrix, right = 2.0 * np.eye(SIZE) + rng.normal(size=(SIZE, SIZE)) / SIZE, rng.normal(size=(SIZE, *count))
    solution = right.copy()
    Elimination(matrix.copy(), largest).solve(solution)
    assert difference(solution, np.linalg.solve(matrix, right)) < ROUNDED


@pytest.mark.parametrize("far", [0, 40, SIZE])
def test_the_near_nodes_give_the_solutions_of_all(far):
    system, right = bordered(far=far), np.random.default_rng(2).normal(size=(SIZE + 2, 3))
    matrix = system.matrix()
    assert system.near(FAR) == SIZE - far
    assert np.allclose(matrix @ right[:, 0], system @ right[:, 0], rtol=0.0, atol=ROUNDED)
    adjoints = system.condensed(SIZE - far).adjoints(right)
    assert difference(adjoints, np.linalg.solve(matrix.T, right)) < ROUNDED
    row = right[:, 1]
    matrix[-1] = row
    assert difference(BorderedFactor(system).solve(right[:, 0], row), np.linalg.solve(matrix, right[:, 0])) < ROUNDED


@pytest.mark.parametrize("pivot", [0.0, 1e-13], ids=["singular", "nearly singular"])
def test_a_matrix_whose_first_block_is_singular_is_inverted_as_a_whole(pivot):
    half = np.eye(SIZE // 2)
    system = bordered(matrix=np.block([[pivot * half, half], [half, 0.0 * half]]))
    unit = np.zeros(SIZE + 2)
    unit[-1] = 1.0
    assert difference(BorderedFactor(system).tangent, np.linalg.solve(system.matrix(), unit)) < ROUNDED


def test_a_tangent_that_blocks_give_to_some_digits_is_corrected(monkeypatch):
    """Nodes whose entries differ from 1 by 1e-6 are taken for far ones."""
    system = bordered()
    system.slope[SIZE - 40 :] *= 1e-6
    exact = BorderedFactor(system).tangent
    monkeypatch.setattr(bordered_factor, "FAR", 1e-5)
    factor = BorderedFactor(system)
    assert len(factor._condensed.far) == 40
    assert difference(factor.tangent, exact) < ROUNDED


def test_a_singular_matrix_is_refused():
    system = bordered()
    system.rows[:] = 0.0
    with pytest.raises(NotConverged, match="singular tangent"):
        BorderedFactor(system)
