"""``fscm-bench list``: the models, quantities, cases or gates, as text, CSV or JSON."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable
from typing import Any

import pandas as pd

from comparisons.cli.options import OK, output
from comparisons.console.progress import log
from comparisons.external.model_source import installed
from comparisons.judging.gates import gates_text, load_gates
from comparisons.numerics.number_text import limits_text
from comparisons.output.terminal import records
from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS, create
from comparisons.runs.cases import TIERS, grids
from comparisons.runs.csv_format import csv_text

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = (
    "fscm-bench list models",
    "fscm-bench list gates --format json",
)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("what", choices=tuple(_TABLES), help="what is listed")
    parser.add_argument(
        "--format",
        choices=("text", "csv", "json"),
        default="text",
        help="csv and json have every digit, and one row for each case of a grid (default: text)",
    )


def call(args: argparse.Namespace) -> int:
    """Print the table; return the exit status."""
    if args.format != "text":
        table = _EXACT.get(args.what, _TABLES[args.what])()
        print(csv_text(table) if args.format == "csv" else _json(table), end="")
        return OK
    table = _TABLES[args.what]()
    if table.empty:
        log(f"no {args.what} are declared")
    else:
        output().print(records(table, args.what))
    return OK


def _json(table: pd.DataFrame) -> str:
    """Return a list of objects, one a line; null for what is missing or without limit."""
    lines = [
        json.dumps({name: _plain(value) for name, value in row.items()}, allow_nan=False, ensure_ascii=False)
        for row in table.to_dict("records")
    ]
    return "[\n" + ",\n".join(lines) + "\n]\n"


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _models() -> pd.DataFrame:
    columns = ("name", "version", "domain", "citation")
    ours = pd.DataFrame([[getattr(create(name), column) for column in columns] for name in MODELS])
    # The domain of an installed model is in its code, which is not run for a list.
    theirs = pd.DataFrame([[name, version, f"installed by {package}", ""] for name, package, version in installed()])
    return pd.concat([ours, theirs], ignore_index=True).set_axis(list(columns), axis="columns")


def _quantities() -> pd.DataFrame:
    columns = ("name", "symbol", "kind", "meaning", "unit", "sign")
    return pd.DataFrame(
        [[str(getattr(one, column)) for column in columns] for one in ALL_QUANTITIES.values()]
    ).set_axis(list(columns), axis="columns")


def _cases() -> pd.DataFrame:
    return pd.DataFrame(
        {
            "id": grid.id,
            "tier": grid.tier,
            "title": grid.title,
            "quantities": ", ".join(grid.quantities),
            "reference": grid.reference,
            "models": ", ".join(grid.models),
            "cases": len(grid.cases),
        }
        for grid in grids(TIERS[-1])
    )


def _each_case() -> pd.DataFrame:
    """Return one row for each case of each grid; a row names the reference, the quantities and the models."""
    return pd.DataFrame(
        {
            "grid": grid.id,
            "tier": grid.tier,
            "n": case.n,
            "k": case.k,
            "mu": case.mu,
            "nu": math.nan if case.nu is None else case.nu,
            "reference": grid.reference,
            "models": " ".join(grid.models),
            "quantities": " ".join(grid.quantities),
        }
        for grid in grids(TIERS[-1])
        for case in grid.cases
    )


def _gates() -> pd.DataFrame:
    return pd.DataFrame(
        {
            "id": gate.id,
            "tier": gate.tier,
            "requirement": gate.requirement,
            "candidate": gate.candidate,
            "reference": gate.reference,
            "metric": gate.metric,
            "limits": limits_text(gate.lower, gate.upper),
            "basis": gate.basis,
        }
        for gate in load_gates(gates_text())
    )


def _exact_gates() -> pd.DataFrame:
    limits = pd.DataFrame({"lower": gate.lower, "upper": gate.upper} for gate in load_gates(gates_text()))
    table = _gates().drop(columns="limits").astype(str)
    return pd.concat([table, limits.astype(float)], axis="columns")


_TABLES: dict[str, Callable[[], pd.DataFrame]] = {
    "models": _models,
    "quantities": _quantities,
    "cases": _cases,
    "gates": _gates,
}

#: Tables that differ where every digit is printed.
_EXACT: dict[str, Callable[[], pd.DataFrame]] = {"cases": _each_case, "gates": _exact_gates}
