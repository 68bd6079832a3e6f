"""Bounds of the finite elements against errors: their distance from the integral equation, which is far more accurate.

``python -m tests.fem_reference.bounds_against_fscm [ACCURACY]`` prints a line for each problem and quantity.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

import fem_reference
import fscm
from tests.fem_reference.solved_together import problem_with

QUANTITIES = ("pull_off_force", "pull_off_displacement", "jump_out_displacement", "zero_load_displacement")
SEED = 20261125

#: Modulus and Poisson's ratio of a coating and of what it is on, its thickness and the length of its transition.
COATINGS = ((10.0, 1.0, 1.0, 0.0), (1.0, 10.0, 1.0, 0.0), (10.0, 1.0, 0.5, 0.1), (1.0, 3.0, 2.0, 0.5))


@dataclass(frozen=True)
class Row:
    """A value with its bound and its error, and the bound of the other method."""

    case: str
    quantity: str
    value: float
    u_num: float
    error: float
    u_other: float

    @property
    def holds(self) -> bool:
        """Whether the error is below both bounds."""
        return self.error <= self.u_num + self.u_other


def cases(count: int = 12) -> dict[str, list[float]]:
    """Solids, punches and laws of random power laws, and of all coatings, for both packages, by their names."""
    rng = np.random.default_rng(SEED)
    numbers_of: dict[str, list[float]] = {}
    for _ in range(count):
        n, k, mu = 10 ** rng.uniform(0.0, 0.8), rng.uniform(0.0, 0.7), 10 ** rng.uniform(-1.0, 0.5)
        numbers_of[f"n = {n:.3f}, k = {k:.3f}, mu = {mu:.3f}"] = [n, k, mu]
    for numbers in COATINGS:
        numbers_of[f"coating {numbers}"] = [*numbers]
    return numbers_of


def _problems(numbers: list[float]) -> tuple[fem_reference.Problem, fscm.Problem]:
    """The problem of the finite elements, and the same of the integral equation."""
    if len(numbers) == 3:
        n, k, mu = numbers
        elements = problem_with(k, mu, n)
        solid = fscm.PowerLaw(elements.solid.E0, 1.0, k, 0.3)
    else:
        n, constants = 2.0, (*numbers, 0.3)
        elements = fem_reference.Problem(
            fem_reference.Coating(*constants), fem_reference.PowerPunch(n, 1.0), fem_reference.LennardJones(1.0, 1.0)
        )
        solid = fscm.Coating(*constants)
    return elements, fscm.Problem(solid, fscm.PowerPunch(n, 1.0), fscm.LennardJones(1.0, 1.0))


def rows(name: str, accuracy: str = "quick") -> Iterator[Row]:
    """Compare every quantity of a case that both have."""
    elements, other = _problems(cases()[name])
    values = fem_reference.solve_together(elements, QUANTITIES, accuracy)
    exact = fscm.solve_together(other, QUANTITIES, accuracy=1e-9)
    for quantity, solution in values.items():
        reference = exact[quantity]
        if isinstance(solution, fem_reference.Solution) and isinstance(reference, fscm.Solution):
            error = abs(solution.value - reference.value)
            yield Row(name, quantity, solution.value, solution.u_num, error, reference.u_num)


def main(accuracy: str = "quick") -> None:
    """Print the bound, and the error as a share of it."""
    for name in cases():
        for row in rows(name, accuracy):
            bound, share = row.u_num / abs(row.value), row.error / row.u_num
            print(
                f"{row.case:36} {row.quantity:24} {bound:8.1e} {share:9.2e}{'' if row.holds else '  OUTSIDE'}",
                flush=True,
            )


if __name__ == "__main__":
    main(*sys.argv[1:])
