"""The part of the model contract that every closed form has in common.

A closed form computes the quantities for which it has a method of that name, and has one reason for all others.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

from comparisons.model import Curve, Result, refuse
from comparisons.problem import Problem
from comparisons.problem.problem import beyond_numbers
from comparisons.quantities import ALL_QUANTITIES, QUANTITIES, Kind

#: Distance of 1 to the next number.
EPS = 2.0**-52

#: Relative error of one Gamma or Beta function of scipy over the arguments in use: measured worst 2e-15
#: (7 eps) on B(3 - 2/n, 2/n), 0.7 <= n <= 20; 16 leaves a factor of two.
FACTOR_ROUNDING = 16.0 * EPS

#: Points of a curve.
POINTS = 401

#: Tabor numbers for which the limits of stiff and of soft solids are used (Johnson & Greenwood, J. Colloid Interface
#: Sci. 192 (1997) 326-333).
STIFF, SOFT = {"mu": (0.0, 0.1)}, {"mu": (5.0, math.inf)}


def monomial(*factors: tuple[float, float]) -> Result:
    """Return the product of base**exponent with its rounding bound.

    Parameters
    ----------
    *factors : tuple of float
        (base, exponent), base > 0, or base = 0 with exponent = 0, which counts as 1.

    Examples
    --------
    >>> monomial((2.0, 3.0), (4.0, -0.5)).value
    4.0
    """
    logs = [exponent * math.log(base) if exponent != 0.0 else 0.0 for base, exponent in factors]
    value = math.prod(base**exponent for base, exponent in factors)
    amplification = sum(abs(log) for log in logs) * EPS + sum(abs(e) for _, e in factors) * FACTOR_ROUNDING
    return Result(value, abs(value) * amplification)


class ClosedForm:
    """Base of the closed forms: it calls the method of a quantity that the model takes.

    A closed form computes the quantities for which it has a method: `pull_off_force` and the other numbers by their
    names, which return a `Result`, `force_curve`, and `pull_off_profile` for both fields.

    Attributes
    ----------
    name, version, citation, domain : str
        As in `comparisons.model.Model`.
    undefined : str
        Why the model does not define the other quantities.
    validity : dict of str to (float, float)
        Limits of parameters for which the model is meant.  It is evaluated beyond them, but pages judge it within.

    Examples
    --------
    >>> from comparisons.models.jkr import JKR
    >>> round(JKR().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 12)   # (k + 3) / 2
    1.7
    """

    name: ClassVar[str]
    version: ClassVar[str] = "1"
    citation: ClassVar[str]
    domain: ClassVar[str]
    undefined: ClassVar[str] = "its equations hold in contact only, where the gap is zero"
    validity: ClassVar[Mapping[str, tuple[float, float]]] = {}

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why the model does not take a quantity of a problem; None if it does.

        By default it takes every problem of n, k and mu; a model with narrower equations adds its reasons.
        """
        return self._undefined(quantity) or beyond_numbers(problem, self.name)

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity for the problem.

        Raises
        ------
        ValueError
            If `quantity` is not in the registry of quantities.
        NotApplicable
            If the model does not take it, or if the problem has no such event.
        ComputationFailed
            If a root was not found.
        """
        if quantity not in QUANTITIES:
            raise ValueError(f"quantity {quantity!r} is unknown; the known ones are {', '.join(QUANTITIES)}")
        return self._call(quantity, problem)

    def curve(self, problem: Problem) -> Curve:
        """Return the force-displacement curve, or raise as `evaluate` does."""
        return self._call("force_curve", problem)

    def _undefined(self, quantity: str) -> str | None:
        """Return why the model does not define a quantity; None if it has the method."""
        is_field = ALL_QUANTITIES[quantity].kind is Kind.FIELD
        if hasattr(self, "pull_off_profile" if is_field else quantity):
            return None
        return f"{self.name} does not define {quantity}: {self.undefined}"

    def _call(self, quantity: str, problem: Problem) -> Any:
        refuse(self.skip(problem, quantity))
        return getattr(self, quantity)(problem)


class ContactBranch(ClosedForm, ABC):
    """Base of the closed forms of a branch in contact, whose three events have displacements by one function."""

    @abstractmethod
    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at ``pull_off``, ``jump_out`` or ``zero_load``."""

    def pull_off_displacement(self, problem: Problem) -> Result:
        """Delta where P is smallest."""
        return self.displacement_at(problem, "pull_off")

    def jump_out_displacement(self, problem: Problem) -> Result:
        """Smallest delta on the branch, which retreat meets first."""
        return self.displacement_at(problem, "jump_out")

    def zero_load_displacement(self, problem: Problem) -> Result:
        """Delta in contact where P = 0."""
        return self.displacement_at(problem, "zero_load")
