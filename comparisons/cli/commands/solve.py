"""``fscm-bench solve``: one quantity of one problem by one model."""

from __future__ import annotations

import argparse
import json

from comparisons.cli.options import CASE_OR_FILE, MODEL_SPEC, case_of, option
from comparisons.cli.screen import print_lines
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import waiting
from comparisons.numerics.number_text import case_text, short
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from comparisons.runs.cases import Case
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

__all__ = ["EXAMPLES", "OPTIONS", "call"]

EXAMPLES = (
    "fscm-bench solve --model fscm --quantity pull_off_force --n 2 --k 0.4 --mu 1",
    "fscm-bench solve --model jkr --quantity jump_out_gap --n 2 --k 0 --mu 2 --format json",
    "fscm-bench solve --model fscm --quantity pull_off_force --problem pad.toml",
)


OPTIONS = (
    option("--model", metavar="SPEC", required=True, help=MODEL_SPEC),
    option("--quantity", metavar="NAME", required=True, help="see: fscm-bench list quantities"),
    *CASE_OR_FILE,
    option(
        "--format",
        choices=("text", "json", "csv"),
        default="text",
        help="json and csv have every digit (default: %(default)s)",
    ),
)


def call(args: argparse.Namespace) -> int:
    """Compute and print; return the exit status."""
    if args.quantity not in QUANTITIES:
        raise ValueError(f"unknown quantity {args.quantity!r}; the quantities are {', '.join(QUANTITIES)}")
    if args.problem is not None:
        # Imported here: a dimensionless problem does not need it.
        from comparisons.cli.problem_output import solve_file

        return solve_file(args)
    case = case_of(args)
    model = create(args.model, case.nu)
    with waiting(f"{args.model}, {case.label}"):
        row = evaluate(model, args.quantity, case)
    if args.format == "text":
        print_lines(_lines(row))
    else:
        print({"json": _json, "csv": _csv}[args.format](row), end="")
    return FAILED if row.status == "failed" else OK


def _case(row: Row) -> dict[str, float]:
    return Case.of_row(row).parameters


def _json(row: Row) -> str:
    content = {
        "model": row.model,
        "quantity": row.quantity,
        "case": _case(row),
        "value": row.value,
        "u_num": row.u_num,
        "status": row.status,
        "unit": row.unit,
        "seconds": row.seconds,
    }
    if row.reason:
        content["reason"] = row.reason
    return json.dumps(content, allow_nan=False) + "\n"


def _csv(row: Row) -> str:
    # Imported here: the other formats do not need the libraries of tables.
    from comparisons.runs.csv_format import csv_text
    from comparisons.runs.frames import frame

    return csv_text(frame([row]))


def _lines(row: Row) -> list[str]:
    quantity = QUANTITIES[row.quantity]
    lines = [f"{row.model}: {row.quantity} at {case_text(_case(row))}"]
    if row.value is None or row.u_num is None:
        lines.append(f"  {row.status}: {row.reason}")
    else:
        unit = "" if quantity.unit == "1" else f" {quantity.unit}"
        lines.append(f"  {quantity.symbol} = {short(row.value, row.u_num)}{unit}  ({row.seconds:.2g} s)")
    if (row.n, row.k) == (2.0, 0.0) and row.mu is not None:
        # Imported here: the other formats and problems do not need it.
        from comparisons.models.maugis_parameter import maugis_parameter

        lines.append(f"  Maugis's lambda = {maugis_parameter(row.mu):.4g} with the strength 16 sqrt(3)/27 dgamma / z0")
    return lines
