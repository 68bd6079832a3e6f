"""``fscm-bench list``: the models, quantities, cases or gates."""

from __future__ import annotations

import argparse

import pandas as pd

from comparisons.cli.options import OK, output
from comparisons.console.progress import log
from comparisons.external.model_source import installed
from comparisons.judging.gates import gates_text, load_gates
from comparisons.output.tables import rich_table
from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS, create
from comparisons.runs.cases import TIERS, grids

__all__ = ["add", "call"]


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("what", choices=_TABLES)


def call(args: argparse.Namespace) -> int:
    """Print the table; return the exit status."""
    table = _TABLES[args.what]()
    if table.empty:
        log(f"no {args.what} are declared")
    else:
        output().print(rich_table(table, args.what))
    return OK


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


def _gates() -> pd.DataFrame:
    return pd.DataFrame(
        {
            "id": gate.id,
            "tier": gate.tier,
            "requirement": gate.requirement,
            "candidate": gate.candidate,
            "reference": gate.reference,
            "metric": gate.metric,
            "limits": f"{gate.lower:g} to {gate.upper:g}",
            "basis": gate.basis,
        }
        for gate in load_gates(gates_text())
    )


_TABLES = {"models": _models, "quantities": _quantities, "cases": _cases, "gates": _gates}
