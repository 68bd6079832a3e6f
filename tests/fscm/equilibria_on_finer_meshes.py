"""States on coarse meshes, whose errors are far above rounding, and the equilibria on finer meshes."""

from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from fscm import Analysis, Problem
from fscm._bound.defect import Defect, finer
from fscm._path.arc_length import parameter_of, rates_of
from fscm._path.continuation import moved
from fscm._surface.discretisation import Discretisation
from fscm._surface.state import Rates, State
from fscm._typing import Array
from fscm.accuracy import Mesh, Meshes

FUNCTIONALS = ("load", "displacement", "central_gap", "energy")
#: Meshes of references: other panels on another coarse path, and an end that is ten times farther out.
FINER = Meshes(path=Mesh(10, 2e-5), check=Mesh(8, 1e-3), value=Mesh(18, 1e-9), end_height=1e7)


@cache
def finer_analysis(problem: Problem, end_height: float = FINER.end_height) -> Analysis:
    """The model on the meshes of references."""
    return Analysis(problem, replace(FINER, end_height=end_height))


@dataclass(frozen=True)
class Pair:
    """A state on a coarse mesh, its defect, and the equilibrium of the finer mesh at the same parameter."""

    state: State
    defect: Defect

    @property
    def parameter(self) -> str:
        return "central_gap" if self.state.parameter == "gap" else self.state.parameter

    @cached_property
    def exact(self) -> State:
        return self.solved(self.defect.fine)

    def solved(self, start: State) -> State:
        return moved(start, rates_of(start), parameter_of(self.state))

    @cached_property
    def rates(self) -> Rates:
        return rates_of(self.exact)

    def error(self, functional: str) -> float:
        return float(getattr(self.state, functional) - getattr(self.exact, functional))

    def with_matrix(self, matrix: Array) -> State:
        """The equilibrium of the finer mesh with another response matrix."""
        start = self.exact
        disc = Discretisation(start.disc.problem, start.disc.mesh)
        disc.elastic._matrix = matrix
        return self.solved(replace(start, disc=disc))

    def adjoint(self, functional: str) -> Array:
        """Effect on a functional of a unit residual at each node, at a fixed parameter (by the transposed system)."""
        system = self.defect._system.bordered(self.defect._gradient(self.parameter))
        return np.linalg.solve(system.matrix().T, self.defect._gradient(functional))[:-2]


@cache
def pair(n: float, k: float, mu: float, event: str, end_height: float = 1e6) -> Pair:
    """Return the state of an event on a mesh of order 8."""
    model = Analysis(Problem(n, k, mu), Meshes(value=Mesh(8, 1e-5), end_height=end_height))
    state = model.event(event).value
    return Pair(state, Defect(state, finer(state.disc)))
