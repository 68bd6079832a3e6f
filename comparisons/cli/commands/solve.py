"""``fscm-bench solve``: one quantity of one problem by one model."""

from __future__ import annotations

import argparse
import json

from comparisons.cli.options import FAILED, MODEL_SPEC, OK, add_case_or_file, case_of, for_terminal
from comparisons.console.progress import waiting
from comparisons.numerics.number_text import case_text, short
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from comparisons.runs.cases import Case
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = (
    "fscm-bench solve --model fscm --quantity pull_off_force --n 2 --k 0.4 --mu 1",
    "fscm-bench solve --model jkr --quantity jump_out_gap --n 2 --k 0 --mu 2 --format json",
    "fscm-bench solve --model fscm --quantity pull_off_force --problem pad.toml",
)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("--model", metavar="SPEC", required=True, help=MODEL_SPEC)
    parser.add_argument("--quantity", metavar="NAME", required=True, help="see: fscm-bench list quantities")
    add_case_or_file(parser)
    parser.add_argument(
        "--format", choices=tuple(_FORMATS), default="text", help="json and csv have every digit (default: %(default)s)"
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
    shown = _FORMATS[args.format](row)
    print(for_terminal(shown.splitlines()) if args.format == "text" else shown, end="")
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


def _text(row: Row) -> str:
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
    return "\n".join(lines) + "\n"


_FORMATS = {"text": _text, "json": _json, "csv": _csv}
