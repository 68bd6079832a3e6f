"""``fscm-bench solve``: one quantity of one problem by one model."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from typing import Any

from comparisons.cli.options import CASE_OR_FILE, MODEL_SPEC, command, option, output_format, problem_of
from comparisons.cli.screen import print_text
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import waiting
from comparisons.numerics.number_text import case_text, short
from comparisons.problem import Problem
from comparisons.problem.evaluation import SOLVERS
from comparisons.problem.units import si_text
from comparisons.quantities import QUANTITIES, known_scalar
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate


@command(
    option("--model", metavar="SPEC", required=True, help=MODEL_SPEC),
    option("--quantity", metavar="NAME", required=True, help="see: fscm-bench list quantities"),
    *CASE_OR_FILE,
    output_format("json", "csv", help="json and csv have every digit (default: text)"),
)
def solve_command(args: argparse.Namespace) -> int:
    """Compute and print; return the exit status.

    For example::

        fscm-bench solve --model fscm --quantity pull_off_force --n 2 --k 0.4 --mu 1
        fscm-bench solve --model jkr --quantity jump_out_gap --n 2 --k 0 --mu 2 --format json
        fscm-bench solve --model fscm --quantity pull_off_force --problem pad.toml
        fscm-bench solve --model fscm --quantity critical_tabor_number --n 2 --k 0.4
    """
    known_scalar(args.quantity, "--quantity")
    without_mu = args.quantity == "critical_tabor_number" and args.problem is None and args.mu is None
    if without_mu:
        # Any mu leads to that at which jumps begin.
        args.mu = 1.0
    problem = problem_of(args)
    case = {name: number for name, number in problem.parameters.items() if not (without_mu and name == "mu")}
    is_long = args.model in SOLVERS and not problem.is_dimensionless
    with waiting(f"solving {case_text(case) or problem.label} with {args.model}", is_long):
        row = evaluate(args.model, args.quantity, problem)
    if args.format == "text":
        print_text(_lines(problem, row, case))
    else:
        print(_json(problem, row, case) if args.format == "json" else _csv(row), end="")
    return FAILED if row.status == "failed" else OK


def _json(problem: Problem, row: Row, case: Mapping[str, Any]) -> str:
    content: dict[str, Any] = {"model": row.model, "quantity": row.quantity}
    content |= {"case": dict(case)} if problem.is_dimensionless else {"problem": problem.content}
    content |= {name: getattr(row, name) for name in ("value", "u_num", "status", "unit", "seconds")}
    if row.dimensionless_unit:
        content["dimensionless"] = {name: getattr(row, f"dimensionless_{name}") for name in ("value", "u_num", "unit")}
    if row.reason:
        content["reason"] = row.reason
    if assumed := _assumed(problem, row):
        content["assumptions"] = assumed
    return json.dumps(content, allow_nan=False) + "\n"


def _assumed(problem: Problem, row: Row) -> dict[str, Any] | None:
    """The error of the assumptions in a force of a problem file."""
    if row.value is None or row.quantity != "pull_off_force" or problem.is_dimensionless:
        return None
    # Imported here: the other quantities and problems do not need the table of balls.
    from comparisons.description.budget import budget

    return budget(problem, row.model)


def _csv(row: Row) -> str:
    # Imported here: the other formats do not need the libraries of tables.
    from comparisons.runs.csv_format import csv_text
    from comparisons.runs.frames import frame

    return csv_text(frame([row]))


def _lines(problem: Problem, row: Row, case: Mapping[str, Any]) -> list[str]:
    quantity = QUANTITIES[row.quantity]
    # Jumps under a prescribed load begin at another Tabor number.
    control = ", at prescribed displacement" if row.quantity == "critical_tabor_number" else ""
    label = f"at {case_text(case)}" if problem.is_dimensionless else f"of {problem.label}"
    lines = [f"{row.model}: {row.quantity} {label}{control}"]
    if row.value is None or row.u_num is None:
        lines.append(f"  {row.status}: {row.reason}")
    elif not problem.is_dimensionless:
        lines.append(f"  {quantity.symbol} = {si_text(row.value, row.u_num, row.unit)}  ({row.seconds:.2g} s)")
    else:
        unit = "" if quantity.unit == "1" else f" {quantity.unit}"
        lines.append(f"  {quantity.symbol} = {short(row.value, row.u_num)}{unit}  ({row.seconds:.2g} s)")
    if row.dimensionless_value is not None and row.dimensionless_u_num is not None:
        scaled = si_text(row.dimensionless_value, row.dimensionless_u_num, "1")
        lines.append(f"  dimensionless: {scaled} {row.dimensionless_unit}")
    if row.value is not None and row.reason:
        lines.append(f"  {row.reason}")
    if (assumed := _assumed(problem, row)) and row.value and row.u_num is not None:
        from comparisons.description.budget import budget_line

        line = budget_line(assumed, row.u_num / abs(row.value))
        lines += [f"  {line}"] if line else []
    if (problem["n"], problem["k"]) == (2.0, 0.0) and "mu" in case:
        # Imported here: the other formats and problems do not need it.
        from comparisons.models.transition_formulas import maugis_parameter

        parameter = maugis_parameter(problem.mu)
        lines.append(f"  Maugis's lambda = {parameter:.4g} with the strength 16 sqrt(3)/27 dgamma / z0")
    return lines
