"""``fscm-bench list``: the models, quantities, cases, gates or kinds, as text, CSV or JSON.

For example::

    fscm-bench list models
    fscm-bench list gates --format json
"""

from __future__ import annotations

import argparse
import json

import numpy as np
import pandas as pd

from comparisons.cli.options import option, output_format
from comparisons.cli.screen import output
from comparisons.console.exit_status import OK
from comparisons.external.model_source import installed
from comparisons.judging.gates import gates_text, load_gates
from comparisons.numerics.number_text import limits_text
from comparisons.output.terminal import records
from comparisons.problem import PARAMETERS
from comparisons.problem.kinds import kind_rows
from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS, create
from comparisons.runs.cases import TIERS, grids
from comparisons.runs.csv_format import csv_text

OPTIONS = (
    option("what", choices=("models", "quantities", "cases", "gates", "kinds"), help="what to list"),
    output_format("csv", "json", help="csv and json have every digit, one row for each case of a grid (default: text)"),
)


def call(args: argparse.Namespace) -> int:
    """Print the table; return the exit status."""
    exact = args.format != "text"
    table = _TABLES[args.what](exact)
    if args.format == "json":
        # JSON has no infinity and no NaN: what is missing or has no limit is null.
        content = table.astype(object).where(table.notna() & ~table.isin([np.inf, -np.inf]), None)
        print(json.dumps(content.to_dict("records"), allow_nan=False, ensure_ascii=False, indent=0))
    elif args.format == "csv":
        print(csv_text(table), end="")
    else:
        output().print(records(table, args.what))
    return OK


def _models(exact: bool) -> pd.DataFrame:
    names = ["name", "version", "domain", "citation"]
    ours = [[getattr(create(name), column) for column in names] for name in MODELS]
    # The domain of an installed model is in its code, which is not run for a list.
    theirs = [[name, version, f"installed by {package}", ""] for name, package, version in installed()]
    return pd.DataFrame([*ours, *theirs], columns=names)


def _quantities(exact: bool) -> pd.DataFrame:
    names = ["name", "symbol", "kind", "meaning", "unit", "sign"]
    rows = [[str(getattr(quantity, column)) for column in names] for quantity in ALL_QUANTITIES.values()]
    return pd.DataFrame(rows, columns=names)


def _cases(exact: bool) -> pd.DataFrame:
    """Return a row for each grid, or for each of its cases."""
    standing = grids(TIERS[-1])
    if exact:
        return pd.DataFrame(
            {"grid": grid.id, "tier": grid.tier, **{name: case[name] for name in PARAMETERS}, "problem": case.name}
            | {"reference": grid.reference, "models": " ".join(grid.models), "quantities": " ".join(grid.quantities)}
            for grid in standing
            for case in grid.cases
        ).astype(dict.fromkeys(PARAMETERS, float))
    return pd.DataFrame(
        {"id": grid.id, "tier": grid.tier, "title": grid.title, "quantities": ", ".join(grid.quantities)}
        | {"reference": grid.reference, "models": ", ".join(grid.models), "cases": len(grid.cases)}
        for grid in standing
    )


def _kinds(exact: bool) -> pd.DataFrame:
    return pd.DataFrame(kind_rows())


def _gates(exact: bool) -> pd.DataFrame:
    """Return a row for each gate; its limits as two numbers, or in words."""
    names = ["id", "tier", "requirement", "candidate", "reference", "metric"]
    return pd.DataFrame(
        {name: str(getattr(gate, name)) for name in names}
        | ({} if exact else {"limits": limits_text(gate.lower, gate.upper)})
        | {"basis": str(gate.basis)}
        | ({"lower": float(gate.lower), "upper": float(gate.upper)} if exact else {})
        for gate in load_gates(gates_text())
    )


_TABLES = {"models": _models, "quantities": _quantities, "cases": _cases, "gates": _gates, "kinds": _kinds}
