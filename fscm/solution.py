"""Values with their numerical uncertainty, in parts by cause."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

from fscm._numbers import Arithmetic
from fscm._presentation import with_bound
from fscm._surface.state import State

if TYPE_CHECKING:
    from uncertainties import UFloat

__all__ = ["FLOOR", "SAFETY", "EventPair", "Parts", "Solution", "State", "solution_of"]

#: Factor on the difference between two meshes in the bound on a curve or a field: it covers accidental agreement.
SAFETY = 3.0
#: Rounding and quadrature, shared by two meshes, relative to 1 + |value|: measured worst 1.3e-13 of the pull-off force
#: (n = 3.4, k = 0, mu = 0.04) against meshes of order 18 over 45 random problems.
FLOOR = 2e-13


@dataclass(frozen=True)
class Parts(Mapping[str, float]):
    """Bounds on the error of a value by its causes; their sum bounds the error.

    Attributes
    ----------
    mesh : float
        Panels of the mesh.
    tail : float
        Closed form of the attraction beyond the mesh.
    domain : float
        Neglected beyond the mesh: the deformation there, and the radii of the rings of the tail.
    rounding : float
        Rounding, amplified by the condition of the event.
    law : float
        Uncertainty of a smoothed law by its data (see `TabulatedLaw`).  Under the potential of a punch, other than a
        ball, an estimate of what distance and curvature of its face leave out.
    kernel : float
        Response of a graded solid to a ring; zero for a power law, whose response is exact.

    Examples
    --------
    >>> parts = Parts(mesh=1e-12, tail=1e-14)
    >>> parts["mesh"], sum(parts.values()) == parts.total
    (1e-12, True)
    """

    mesh: float = 0.0
    tail: float = 0.0
    domain: float = 0.0
    rounding: float = 0.0
    law: float = 0.0
    kernel: float = 0.0

    def __getitem__(self, name: str) -> float:
        if name not in _CAUSES:
            raise KeyError(name)
        return float(getattr(self, name))

    def __iter__(self) -> Iterator[str]:
        return iter(_CAUSES)

    def __len__(self) -> int:
        return len(_CAUSES)

    @property
    def total(self) -> float:
        """Their sum."""
        return sum(self.values())

    @property
    def largest(self) -> str:
        """Name of the largest one."""
        return max(_CAUSES, key=self.__getitem__)

    def times(self, factor: float) -> Parts:
        """Bounds of the value times a positive number."""
        return Parts(*(factor * bound for bound in self.values()))

    def plus(self, other: Parts) -> Parts:
        """Bounds of a sum of two values."""
        return Parts(*(a + b for a, b in zip(self.values(), other.values(), strict=True)))


_CAUSES = tuple(field.name for field in fields(Parts))


@dataclass(frozen=True, repr=False)
class Solution(Arithmetic):
    """A number with its numerical uncertainty.

    Sums, products and ratios with numbers and with each other are values with a bound; the order is that of the values.

    Attributes
    ----------
    value : float
        In the units of the problem.
    parts : Parts
        Bounds on its error by cause, in the same unit.
    size : int
        Unknowns of the mesh.
    iterations : int
        Newton iterations on it.
    residual : float
        Largest residual relative to 1 + |H| before the last Newton step.
    seconds : float
    unit : str
        What the value is measured in: of a dimensionless problem a scale, as "z0"; of a physical one "N in SI", or
        what corresponds to it in the units of the problem; empty where it is not known.

    Examples
    --------
    >>> from fscm import Problem, solve
    >>> solution = solve(Problem(n=2, k=0, mu=1.0), "pull_off_force")
    >>> solution.u_num < 1e-10, solution.residual < 1e-12
    (True, True)
    >>> list(solution.parts), sum(solution.parts.values()) == solution.u_num
    (['mesh', 'tail', 'domain', 'rounding', 'law', 'kernel'], True)

    It prints as value and bound, and is a number where one is asked:

    >>> force = Solution(1.788481710, Parts(mesh=2e-9), size=9, iterations=3, residual=0.0, seconds=0.1, unit="N")
    >>> force
    Solution(1.788481710 +- 2e-09 N)
    >>> print(force, f"{force:.3f}", force > 1.7, 2 * force)
    1.788481710 +- 2e-09 1.788 True 3.576963420 +- 4e-09
    >>> float(force)
    1.78848171
    >>> solution.as_ufloat().std_dev == solution.u_num
    True
    """

    value: float
    parts: Parts
    size: int
    iterations: int
    residual: float
    seconds: float
    unit: str = ""

    @property
    def u_num(self) -> float:
        """Bound on the error of the value: the sum of the parts."""
        return self.parts.total

    def __repr__(self) -> str:
        return f"Solution({with_bound(self.value, self.u_num)}{self.unit and ' '}{self.unit})"

    def as_ufloat(self) -> UFloat:
        """Return value and bound as a number of the package `uncertainties`, which propagates the bound."""
        from uncertainties import ufloat

        return ufloat(self.value, self.u_num)

    def times(self, factor: float, unit: str = "") -> Solution:
        """The solution multiplied by the unit of a dimensionless value, whose name it gets.

        Examples
        --------
        >>> Solution(2.0, Parts(mesh=1e-12), size=9, iterations=3, residual=0.0, seconds=0.1).times(0.5).value
        1.0
        """
        return replace(self, value=self.value * factor, parts=self.parts.times(factor), unit=unit)


@dataclass(frozen=True, eq=False)
class EventPair:
    """A state on the value mesh, and on the check mesh on demand."""

    value: State
    solved_again: Callable[[], State]

    @cached_property
    def check(self) -> State:
        """The state on the check mesh: the difference of two fields bounds the error of both."""
        return self.solved_again()

    def difference(self, *functionals: Callable[[State], float]) -> float:
        """Largest difference between the two meshes."""
        return max(abs(f(self.value) - f(self.check)) for f in functionals)


def solution_of(value: float, parts: Parts, pairs: Sequence[EventPair]) -> Solution:
    """A value at events with its bound."""
    states = [pair.value for pair in pairs]
    return Solution(
        float(value),
        parts,
        max(len(state.gap) for state in states) + 2,
        sum(state.iterations for state in states),
        max(state.residual for state in states),
        0.0,
    )
