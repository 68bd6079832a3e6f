"""Commands on what there is, and on models of one's own: lists, a template, and checks of the contract."""

from __future__ import annotations

import argparse
import json
from shlex import quote

import numpy as np
import pandas as pd

from comparisons.cli.options import MODEL_SPEC, command, file, option, output_format
from comparisons.cli.screen import output, print_lines
from comparisons.console.exit_status import FAILED, FAILS, OK
from comparisons.console.progress import log, waiting
from comparisons.external.contract_checks import SKIPPED, examine
from comparisons.external.model_source import installed
from comparisons.external.template import write_template
from comparisons.judging.gates import gates_text, load_gates
from comparisons.numerics.number_text import limits_text
from comparisons.output.terminal import records
from comparisons.problem import PARAMETERS
from comparisons.problem.kinds import kind_rows
from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS, create, external_model
from comparisons.runs.atomic_files import writing
from comparisons.runs.cases import TIERS, grids
from comparisons.runs.csv_format import csv_text

#: Columns of the status, the longest of which is "not checked".
_STATUS = len(SKIPPED)


@command(file("folder", metavar="DIR", help="new folder, e.g. my-model; its name becomes that of the model"))
def new_model_command(args: argparse.Namespace) -> int:
    """Write a new package with a working model, a test and a CI workflow; return the exit status.

    For example::

        fscm-bench new-model my-model
    """
    with writing(args.folder, "folder", "choose another one"):
        written, spec = write_template(args.folder, reserved=MODELS)
    for path in written:
        print(path)
    log(f"change what the model computes; then: fscm-bench check-model {quote(spec)}")
    return OK


@command(option("spec", metavar="SPEC", help=MODEL_SPEC))
def check_model_command(args: argparse.Namespace) -> int:
    """Examine and print; return 4 if a computation failed, 1 if something is wrong, else 0.

    For example::

        fscm-bench check-model my_model.py:MyModel
    """
    if args.spec in MODELS:
        raise ValueError(f"{args.spec} is a model of fscm-bench; its tests are in tests/comparisons/models")
    model = external_model(args.spec)
    with waiting(f"checking {model.name}"):
        findings = examine(model)
    print_lines(f"{finding.status:{_STATUS}}  {finding.check}: {finding.text}" for finding in findings)
    statuses = {finding.status for finding in findings}
    return FAILED if "failed" in statuses else FAILS if "wrong" in statuses else OK


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
    table = _TABLES[args.what](args.format != "text")
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
