"""``fscm-bench list``: the models, quantities, cases, gates, and the kinds of a problem file."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from comparisons.cli.options import command, option, output_format
from comparisons.cli.screen import output
from comparisons.console.exit_status import OK
from comparisons.data.toml_text import shipped
from comparisons.external.installed import installed
from comparisons.output.terminal import records

_Row = Mapping[str, Any]


@command(
    option("what", choices=("models", "quantities", "cases", "gates", "kinds"), help="what to list"),
    output_format("csv", "json", help="csv and json have every digit, one row for each case of a grid (default: text)"),
)
def list_command(args: argparse.Namespace) -> int:
    """Print a table; return the exit status.

    For example::

        fscm-bench list models
        fscm-bench list gates --format json
    """
    rows = list(_ROWS[args.what](args.format != "text"))
    if args.format == "json":
        print(json.dumps([_finite(row) for row in rows], allow_nan=False, ensure_ascii=False, indent=0))
    elif args.format == "csv":
        # Imported here: text and JSON need no library of tables.
        import pandas as pd

        from comparisons.runs.csv_format import csv_text

        print(csv_text(pd.DataFrame(rows)), end="")
    else:
        output().print(records({name: [row[name] for row in rows] for name in rows[0]}, args.what))
    return OK


def _finite(row: _Row) -> _Row:
    """The row for JSON, which has no infinity and no NaN: what is missing or has no limit is null."""
    return {name: None if isinstance(cell, float) and not math.isfinite(cell) else cell for name, cell in row.items()}


def _models(exact: bool) -> Iterator[_Row]:
    yield from ({"name": name, **facts} for name, facts in shipped("models.toml").items())
    # The domain of an installed model is in its code, which is not run for a list.
    for name, package, version in installed():
        yield {"name": name, "version": version, "domain": f"installed by {package}", "citation": ""}


def _quantities(exact: bool) -> Iterator[_Row]:
    from comparisons.quantities import ALL_QUANTITIES

    names = ("name", "symbol", "kind", "meaning", "unit", "sign")
    yield from ({name: str(getattr(quantity, name)) for name in names} for quantity in ALL_QUANTITIES.values())


def _cases(exact: bool) -> Iterator[_Row]:
    """Yield a row for each grid, or for each of its cases."""
    from comparisons.problem import PARAMETERS
    from comparisons.runs.cases import TIERS, grids

    for grid in grids(TIERS[-1]):
        of_grid = {"id": grid.id, "tier": grid.tier, "title": grid.title, "quantities": ", ".join(grid.quantities)}
        if not exact:
            yield of_grid | {"reference": grid.reference, "models": ", ".join(grid.models), "cases": len(grid.cases)}
            continue
        for case in grid.cases:
            numbers = {name: math.nan if case[name] is None else float(case[name]) for name in PARAMETERS}
            models = {"models": " ".join(grid.models), "quantities": " ".join(grid.quantities)}
            head = {"grid": grid.id, "tier": grid.tier, **numbers, "problem": case.name, "reference": grid.reference}
            yield head | models


def _kinds(exact: bool) -> Iterator[_Row]:
    from comparisons.problem.kinds import kind_rows

    return kind_rows()


def _gates(exact: bool) -> Iterator[_Row]:
    """Yield a row for each gate; its limits as two numbers, or in words."""
    from comparisons.judging.gates import gates_text, load_gates
    from comparisons.numerics.number_text import limits_text

    names = ("id", "tier", "requirement", "candidate", "reference", "metric")
    for gate in load_gates(gates_text()):
        limits = {} if exact else {"limits": limits_text(gate.lower, gate.upper)}
        numbers = {"lower": float(gate.lower), "upper": float(gate.upper)} if exact else {}
        yield {name: str(getattr(gate, name)) for name in names} | limits | {"basis": str(gate.basis)} | numbers


#: The imports are in the functions: the list of models needs none of the others.
_ROWS: dict[str, Callable[[bool], Iterable[_Row]]] = {
    "models": _models,
    "quantities": _quantities,
    "cases": _cases,
    "gates": _gates,
    "kinds": _kinds,
}
