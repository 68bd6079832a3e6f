"""Plans: the calls that a table, a picture or a verdict needs, and the function that makes it of their results."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any, Generic, TypeVar

import pandas as pd

from comparisons.paper.cache import CachedCall, Outcome

T = TypeVar("T")
S = TypeVar("S")
K = TypeVar("K")


@dataclass(frozen=True, slots=True)
class Plan(Generic[T]):
    """Calls, by keys of the plan's own, and the function that makes something of their results by the same keys.

    Examples
    --------
    >>> plan = rows_of(pow, cases(base=[2], exp=[3, 4, 3])).then(len)
    >>> [call.arguments for call in plan.needed]
    [(2, 3), (2, 4)]
    >>> plan.make({0: {"power": 8}, 1: {"power": 16}, 2: {"power": 8}})
    3
    """

    calls: Mapping[Any, CachedCall]
    make: Callable[[Mapping[Any, Any]], T]

    @property
    def needed(self) -> list[CachedCall]:
        """The calls, each once."""
        return list(dict.fromkeys(self.calls.values()))

    def then(self, further: Callable[[T], S]) -> Plan[S]:
        """Plan what a function makes of what this plan makes."""
        return Plan(self.calls, lambda results: further(self.make(results)))

    def given(self, outcomes: Mapping[CachedCall, Outcome]) -> T:
        """Return what is made of the outcomes of the calls.

        Raises
        ------
        ComputationFailed
            If a call has failed.
        """
        return self.make({key: outcomes[call].get() for key, call in self.calls.items()})


def together(plans: Mapping[K, Plan[Any]]) -> Plan[dict[K, Any]]:
    """Plan what several plans make, by their keys."""
    calls = {(key, name): call for key, plan in plans.items() for name, call in plan.calls.items()}

    def make(results: Mapping[Any, Any]) -> dict[K, Any]:
        return {key: plan.make({name: results[key, name] for name in plan.calls}) for key, plan in plans.items()}

    return Plan(calls, make)


def result_of(function: Callable[..., Any], *arguments: float | str, **named: float | str) -> Plan[Any]:
    """Plan the result of one call."""
    return Plan({"": CachedCall.of(function, *arguments, **named)}, lambda results: results[""])


def cases(**values: Iterable[Any]) -> list[dict[str, Any]]:
    """Return every combination of values, by their names.

    Examples
    --------
    >>> cases(n=[2.0], k=[0.0, 0.4])
    [{'n': 2.0, 'k': 0.0}, {'n': 2.0, 'k': 0.4}]
    """
    return [dict(zip(values, combination, strict=True)) for combination in product(*values.values())]


def rows_of(
    function: Callable[..., Any], keys: Iterable[Mapping[str, Any]], *names: str, **fixed: float | str
) -> Plan[pd.DataFrame]:
    """Plan the table of a function: its arguments in each row, and its result, of which these names, by default all.

    A result that lacks a name has NaN there.  What is fixed are arguments that the table does not show.
    """
    rows = list(keys)

    def make(results: Mapping[Any, Any]) -> pd.DataFrame:
        columns = [{name: results[index].get(name, math.nan) for name in names} or results[index] for index in results]
        return table_of({**row, **of_row} for row, of_row in zip(rows, columns, strict=True))

    return Plan({index: CachedCall.of(function, **row, **fixed) for index, row in enumerate(rows)}, make)


def table_of(rows: Iterable[Mapping[str, Any]]) -> pd.DataFrame:
    """Return a table of rows of the same names; lists of one length make as many rows, with the numbers repeated.

    Examples
    --------
    >>> table_of([{"k": 0.4, "load": [0.0, -1.0]}, {"k": 0.6, "load": 2.0}]).values.tolist()
    [[0.4, 0.0], [0.4, -1.0], [0.6, 2.0]]
    """
    columns: dict[str, list[Any]] = {}
    for row in rows:
        length = max(len(value) if isinstance(value, list) else 1 for value in row.values())
        for name, value in row.items():
            columns.setdefault(name, []).extend(value if isinstance(value, list) else [value] * length)
    return pd.DataFrame(columns)
