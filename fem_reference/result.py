"""Quantity of a contact problem, with a bound of its error in parts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fem_reference._contact.uncondensed import UncondensedValue
from fem_reference._numbers import Arithmetic
from fem_reference._presentation import with_bound

if TYPE_CHECKING:
    from uncertainties import UFloat

__all__ = ["Solution"]


@dataclass(frozen=True, slots=True, repr=False)
class Solution(Arithmetic):
    """One quantity, in the units of the input.

    Sums, products and ratios with numbers and with each other are values with a bound; the order is that of the values.

    Attributes
    ----------
    value, u_num : float
        The quantity and a bound on its numerical error, the sum of `parts`.
    size : int
        Unknowns of the finest finite-element mesh.
    iterations : int
        Conjugate-gradient iterations with pyamg at the events, on the finest mesh: the fewest of them, at least one.
    residual : float
        Residual of the whole nonlinear system there, relative to the traction.
    seconds : float
        Wall-clock time.
    degrees, values : tuple
        Degrees of the elements, rising, and the quantity with each from its condensed system (nan where the lowest
        degree has no such event).
    parts : mapping of str to float
        Contributions to `u_num` by cause: "mesh" (size and degree of the elements), "first layer",
        "interior and exterior" (extent of the mesh), "edge" (placement of the contact edge, size of the elements at the
        apex), "tail" (displacement beyond the mesh) and "rounding" (rounding and the error of the conjugate
        gradients, and the difference of `value` from the condensed one).
    unit : str
        Of the value if the input is in SI, as "N in SI"; empty where it is not known.

    Examples
    --------
    >>> force = Solution(2.5, 3e-9, 100, 3, 0.0, 0.1, (4, 5, 6), (2.4, 2.5, 2.5), unit="N in SI")
    >>> force, f"{force:.2f}", force > 2.4
    (Solution(2.500000000 +- 3e-09 N in SI), '2.50', True)
    """

    value: float
    u_num: float
    size: int
    iterations: int
    residual: float
    seconds: float
    degrees: tuple[int, int, int]
    values: tuple[float, float, float]
    parts: Mapping[str, float] = field(default_factory=dict, hash=False)
    unit: str = ""

    def __repr__(self) -> str:
        return f"Solution({with_bound(self.value, self.u_num)}{self.unit and ' '}{self.unit})"

    def as_ufloat(self) -> UFloat:
        """Return value and bound as a number of the package `uncertainties`, which propagates the bound."""
        from uncertainties import ufloat

        return ufloat(self.value, self.u_num)

    def with_part(self, name: str, error: float) -> Solution:
        """Return the solution with an error added to a part, and to the bound.

        Parameters
        ----------
        name : str
            Of a part, or of a new one.
        error : float
            Non-negative and finite.

        Raises
        ------
        ValueError
            If the error is negative or not finite.

        Examples
        --------
        >>> solution = Solution(1.0, 3e-9, 100, 3, 0.0, 0.1, (4, 5, 6), (1.0, 1.0, 1.0), {"mesh": 3e-9})
        >>> solution.with_part("rounding", 1e-9).parts
        {'mesh': 3e-09, 'rounding': 1e-09}
        """
        if not 0.0 <= error < math.inf:
            raise ValueError(f"error {error} of the part {name!r} is outside [0, inf): it is added to a bound")
        parts = {**self.parts, name: self.parts.get(name, 0.0) + error}
        return replace(self, u_num=self.u_num + error, parts=parts)

    def plus(self, addend: Solution) -> Solution:
        """Return the sum of two quantities, each on its own meshes of one accuracy, with the sum of their bounds.

        Examples
        --------
        >>> solution = Solution(1.0, 3e-9, 100, 3, 0.0, 0.1, (4, 5, 6), (1.0, 1.0, 1.0), {"mesh": 3e-9})
        >>> solution.plus(solution).value, solution.plus(solution).u_num
        (2.0, 6e-09)
        """
        (a, b, c), (p, q, r) = self.values, addend.values
        return replace(
            self,
            value=self.value + addend.value,
            u_num=self.u_num + addend.u_num,
            size=max(self.size, addend.size),
            iterations=self.iterations + addend.iterations,
            residual=max(self.residual, addend.residual),
            seconds=max(self.seconds, addend.seconds),
            values=(a + p, b + q, c + r),
            parts={name: error + addend.parts[name] for name, error in self.parts.items()},
        )

    def with_whole_system(self, uncondensed: UncondensedValue) -> Solution:
        """Return the solution with the value of the whole system, whose rounding is added to the bound."""
        added = self.with_part("rounding", uncondensed.rounding)
        return replace(added, value=uncondensed.value, iterations=uncondensed.iterations, residual=uncondensed.residual)
