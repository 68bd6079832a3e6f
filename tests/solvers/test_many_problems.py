"""Pull-off forces of `fscm.solve_many` against the finite elements: inside the bounds of each other."""

import numpy as np
import pytest

from comparisons.models.fem_model import FiniteElements
from comparisons.problem import Problem
from fscm import solve_many
from tests.marks import heavy

#: A flat and a sharp punch on a homogeneous and a graded solid, rigid and soft.
FEW = np.array([(2.0, 0.0, 0.3), (1.3, 0.4, 1.0), (4.0, 0.2, 0.05)])


def random_problems(count):
    """Problems in the range of the batches, uniform in 1/n, k and ln mu."""
    random = np.random.default_rng(20261129)
    n, k = 1.0 / random.uniform(1.0 / 6.0, 1.0, count), random.uniform(0.0, 0.8, count)
    return np.stack([n, k, np.exp(random.uniform(np.log(0.01), np.log(10.0), count))], axis=1)


@pytest.mark.parametrize("problems", [FEW, *heavy(random_problems(30))])
def test_forces_of_a_batch_are_those_of_the_finite_elements(problems):
    forces = solve_many(*problems.T, "pull_off_force")
    assert forces.count("batch") == len(problems)
    for parameters, value, bound in zip(problems.tolist(), forces.value, forces.u_num, strict=True):
        elements = FiniteElements().evaluate(Problem.dimensionless(*parameters), "pull_off_force")
        assert abs(value - elements.value) <= bound + elements.u_num, parameters
