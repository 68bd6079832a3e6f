"""``fscm-bench run``: the standing cases, computed and judged, with verdicts, tables and figures."""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd
from rich.table import Table

from comparisons.cli.commands.judge import STATUS, print_verdicts
from comparisons.cli.options import FAILED, add_jobs, add_out, add_retry_failed, output
from comparisons.console.progress import log
from comparisons.model import ComputationFailed
from comparisons.output.markdown import to_step_summary
from comparisons.output.tables import beside_paper_values, by_case, largest_by_gradient, rich_table, statuses
from comparisons.pipeline.run import run
from comparisons.pipeline.tables import RunTables
from comparisons.runs.cases import TIERS

__all__ = ["add", "call"]


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("--tier", choices=TIERS, default=TIERS[0], help="how much to compute (default: %(default)s)")
    parser.add_argument(
        "--model",
        metavar="SPEC",
        nargs="+",
        action="extend",
        help="compare these models instead of those each grid names",
    )
    parser.add_argument("--gates", metavar="FILE", type=Path, help="judge by these gates instead of the standing ones")
    parser.add_argument(
        "--random",
        metavar="N",
        type=int,
        default=0,
        help="judge each model of --model in N fresh cases of its own domain, too",
    )
    parser.add_argument("--seed", metavar="S", type=int, help="seed of the fresh cases (default: a new one)")
    add_jobs(parser)
    add_out(parser)
    add_retry_failed(parser)
    parser.add_argument(
        "--recompute",
        action="store_true",
        help="compute the values of fscm and fem that are shipped with this program, too",
    )


def call(args: argparse.Namespace) -> int:
    """Run and print; return the exit status."""
    to_step_summary("")
    try:
        finished = run(
            args.tier,
            args.gates,
            args.model,
            args.out,
            jobs=args.jobs,
            retry_failed=args.retry_failed,
            recompute=args.recompute,
            random=args.random,
            seed=args.seed,
        )
    except ComputationFailed as failure:
        log(str(failure))
        return FAILED
    status = FAILED
    _print(finished.tables)
    if finished.judgement is not None:
        print_verdicts(finished.judgement)
        status = STATUS[finished.judgement.verdict]
    if finished.failures:
        log(f"{len(finished.failures)} computations failed")
        status = FAILED
    log(f"results are in {finished.folder}")
    if finished.judgement is not None:
        # The last: where it cannot be written, the results and verdicts are stored and printed.
        to_step_summary(finished.judgement.markdown)
    return status


def _print_kappa(kappa: pd.DataFrame) -> None:
    """Print the relative errors: a table for each quantity and reference, a row for each case."""
    console = output()
    for (quantity, reference), group in kappa.groupby(["quantity", "reference"]):
        title = f"{quantity} of {reference} with its u_num, and kappa of each model in percent"
        console.print(_titled(by_case(group), title))


def _print(tables: RunTables) -> None:
    """Print the details first: the end of the output is what a user of a terminal sees."""
    _print_kappa(tables.kappa)
    console = output()
    results = tables.results
    failed = results.loc[results["status"] == "failed", ["model", "quantity", "n", "k", "mu", "reason"]]
    if len(failed):
        console.print(rich_table(failed, "failed computations"))
    console.print(rich_table(statuses(results), "computations"))
    console.print(_titled(largest_by_gradient(tables.largest), "largest abs(kappa) in percent"))
    stated = beside_paper_values(tables.largest)
    if not stated[0].empty:
        title = "largest abs(kappa) in percent beside the published (at_end: at an end of the range of mu)"
        console.print(_titled(stated, title))


def _titled(shown: tuple[pd.DataFrame, dict[str, str]], title: str) -> Table:
    table, formats = shown
    return rich_table(table, title, formats)
