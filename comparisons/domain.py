"""What a model takes: the method `skip` of ours, and the declared domain of an external one.

An external model declares its domain in the attribute `applies_to`, a table or a tuple of tables:

    applies_to = {"quantities": ["pull_off_force"], "n": [2, 2], "k": [0, 0.9], "mu": [0.01, math.inf]}

Both ends belong to a range, a parameter that is not named is not restricted, and None is no limit (for a program, whose
JSON has no infinity).  Outside the domain the model is not evaluated.  Inside, "not applicable" is a failure of the
model, unless the reference has no value either: below the critical Tabor number there is no jump.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from comparisons.data.toml_text import is_real
from comparisons.data.validation import known_name, shown
from comparisons.model import HasCurve, HasProfile, HasSkip, Model
from comparisons.problem import PARAMETERS
from comparisons.problem.problem import Problem, beyond_numbers
from comparisons.quantities import ALL_QUANTITIES, Kind

#: The most tables of a domain.  A domain is to be read by people; thousands of points would be a table of results.
MOST_TABLES = 20

_QUANTITIES = "quantities"
_FORM = 'such as {"quantities": ["pull_off_force"], "n": [2, 2], "k": [0, 0.9], "mu": [0.01, 10]}'


@dataclass(frozen=True, slots=True)
class Range:
    """A table of a domain.

    Attributes
    ----------
    quantities : tuple of str
    limits : dict of str to (float, float)
        Smallest and largest value of a parameter; a parameter that is not there is not restricted.
    """

    quantities: tuple[str, ...]
    limits: dict[str, tuple[float, float]] = field(hash=False)

    def within(self, case: Mapping[str, Any]) -> bool:
        """Whether a case is inside; a parameter that is None in the case is not restricted."""
        values = ((case.get(name), *ends) for name, ends in self.limits.items())
        return all(value is None or low <= value <= high for value, low, high in values)

    def __str__(self) -> str:
        limits = ", ".join(_limits(name, *ends) for name, ends in self.limits.items())
        return ", ".join(self.quantities) + (f" for {limits}" if limits else "")


@dataclass(frozen=True, slots=True)
class Domain:
    """The domain that a model declares.

    Attributes
    ----------
    tables : tuple of Range
        A case is inside if it is inside one of them.  Without tables the domain is a list of cases that the model
        itself has: predictions as data.

    Examples
    --------
    >>> domain = Domain.of({"quantities": ["pull_off_force"], "n": [2, 2], "k": [0, 0.9]})
    >>> domain.contains("pull_off_force", {"n": 2.0, "k": 0.4, "mu": 1.0})
    True
    >>> domain.contains("jump_in_gap", {"n": 2.0, "k": 0.4, "mu": 1.0})
    False
    >>> str(domain)
    'pull_off_force for n = 2, 0 <= k <= 0.9'
    """

    tables: tuple[Range, ...]

    @classmethod
    def of(cls, declared: object) -> Domain:
        """Read the attribute `applies_to` of a model.

        Raises
        ------
        ValueError
            If it is not a table or a sequence of tables of this form; one sentence says what and why.

        Examples
        --------
        >>> Domain.of({"quantities": ["pull_off_force"], "n": [2, 1]})
        Traceback (most recent call last):
        ValueError: applies_to: n = [2, 1] is not [low, high], two numbers with low <= high
        """
        tables = [declared] if isinstance(declared, Mapping) else declared
        if not isinstance(tables, tuple | list) or not all(isinstance(table, Mapping) for table in tables):
            raise ValueError(f"applies_to is {type(declared).__name__} and not a table {_FORM}, or a list of such")
        if not 1 <= len(tables) <= MOST_TABLES:
            raise ValueError(f"applies_to has {len(tables)} tables, outside 1 to {MOST_TABLES}: people read it")
        return cls(tuple(_table(table) for table in tables))

    @classmethod
    def of_json(cls, tables: list[dict[str, Any]]) -> Domain:
        """Return the domain that `as_json` has written."""
        return cls.of(tables) if tables else cls(())

    @property
    def is_list(self) -> bool:
        """Whether the domain is a list of cases that the model itself has."""
        return not self.tables

    def of_quantity(self, quantity: str) -> list[Range]:
        """Return the tables that have a quantity."""
        return [table for table in self.tables if quantity in table.quantities]

    def contains(self, quantity: str, case: Mapping[str, Any]) -> bool:
        """Whether a quantity is promised in a case.

        Parameters
        ----------
        quantity : str
        case : mapping
            n, k, mu and perhaps nu.
        """
        return self.is_list or any(table.within(case) for table in self.of_quantity(quantity))

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why a quantity is not evaluated for a problem of n, k and mu that is not inside; None for others.

        Examples
        --------
        >>> Domain.of({"quantities": ["jump_in_gap"], "n": [2, 2]}).skip(Problem.dimensionless(1, 0, 1), "jump_in_gap")
        'outside the domain that the model declares: jump_in_gap for n = 2'
        """
        if not problem.is_of_the_paper() or self.contains(quantity, problem.numbers):
            return None
        tables = self.of_quantity(quantity)
        stated = "; ".join(map(str, tables)) if tables else f"it has no {quantity}"
        return f"outside the domain that the model declares: {stated}"

    def as_json(self) -> list[dict[str, Any]]:
        """Return the tables as JSON has them; None is no limit.

        Examples
        --------
        >>> Domain.of({"quantities": ["jump_in_gap"], "mu": [2, math.inf]}).as_json()
        [{'quantities': ['jump_in_gap'], 'mu': [2.0, None]}]
        """
        return [{_QUANTITIES: list(table.quantities), **_json_limits(table)} for table in self.tables]

    def __str__(self) -> str:
        return "; ".join(map(str, self.tables)) or "the cases of its data"


def declared_domain(model: object) -> Domain | None:
    """Return the domain that a model declares, or None.

    Raises
    ------
    ValueError
        As `Domain.of`.

    Examples
    --------
    >>> declared_domain(object()) is None
    True
    """
    declared = getattr(model, "applies_to", None)
    return declared if declared is None or isinstance(declared, Domain) else Domain.of(declared)


def skip(model: Model, problem: Problem, quantity: str) -> str | None:
    """Return why a model does not take a quantity of a problem; None if it does.

    An external model has no method `skip`: it knows n, k and mu alone, has a curve or a surface if it has the method,
    and takes what is inside the domain that it declares.

    Examples
    --------
    >>> from comparisons.models.jkr import JKR
    >>> skip(JKR(), Problem.dimensionless(2, 0, 1), "jump_in_gap")
    'jkr does not define jump_in_gap: its equations hold in contact only, where the gap is zero'
    """
    if isinstance(model, HasSkip):
        return model.skip(problem, quantity)
    kind = ALL_QUANTITIES[quantity].kind
    if kind is Kind.CURVE and not isinstance(model, HasCurve):
        return "the model has no force-displacement curve"
    if kind is Kind.FIELD and not isinstance(model, HasProfile):
        return "the model does not know the surface at pull-off"
    domain = declared_domain(model)
    return beyond_numbers(problem, model.name) or (None if domain is None else domain.skip(problem, quantity))


def _table(table: Mapping[Any, Any]) -> Range:
    for key in table:
        known_name("key", str(key), (_QUANTITIES, *PARAMETERS), "applies_to")
    quantities = table.get(_QUANTITIES)
    if not isinstance(quantities, tuple | list) or not quantities:
        raise ValueError(f"applies_to: {_QUANTITIES} = {shown(quantities)} is not a list of at least one quantity")
    for quantity in quantities:
        known_name("quantity", str(quantity), ALL_QUANTITIES, "applies_to")
    limits = {name: _ends(name, table[name]) for name in PARAMETERS if name in table}
    return Range(tuple(dict.fromkeys(quantities)), limits)


def _ends(name: str, stated: object) -> tuple[float, float]:
    if isinstance(stated, tuple | list) and len(stated) == 2 and all(map(_is_end, stated)):
        low, high = (default if end is None else float(end) for end, default in zip(stated, NO_LIMITS, strict=True))
        if low <= high:
            return low, high
    raise ValueError(f"applies_to: {name} = {shown(stated)} is not [low, high], two numbers with low <= high")


#: The meaning of None as the smallest and as the largest value.
NO_LIMITS = (-math.inf, math.inf)


def _is_end(end: object) -> bool:
    # Not an integer beyond the doubles, which is no number of a domain.
    is_number = isinstance(end, numbers.Real) and not isinstance(end, bool)
    return end is None or (is_number and (not isinstance(end, int) or is_real(end)))


def _json_limits(table: Range) -> dict[str, list[float | None]]:
    return {name: [end if math.isfinite(end) else None for end in ends] for name, ends in table.limits.items()}


def _limits(name: str, low: float, high: float) -> str:
    if low == high:
        return f"{name} = {low:g}"
    if math.isinf(high):
        return f"{name} >= {low:g}" if math.isfinite(low) else f"any {name}"
    return f"{low:g} <= {name} <= {high:g}" if math.isfinite(low) else f"{name} <= {high:g}"
