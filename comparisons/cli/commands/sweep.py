"""``fscm-bench sweep``: grids of your own, computed with the errors of every model, without gates."""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.cli.commands.run import print_kappa
from comparisons.cli.options import FAILED, OK, add_jobs, add_out, add_retry_failed, output
from comparisons.console.progress import log
from comparisons.model import ComputationFailed
from comparisons.output.tables import rich_table, statuses
from comparisons.pipeline.run import run

__all__ = ["add", "call"]


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "file", metavar="FILE", type=Path, help="[[grid]] tables as in comparisons/data/cases.toml, without a tier"
    )
    parser.add_argument(
        "--model",
        metavar="SPEC",
        nargs="+",
        action="extend",
        help="compare these models instead of those each grid names",
    )
    add_jobs(parser)
    add_out(parser)
    add_retry_failed(parser)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status."""
    try:
        finished = run(args.file, models=args.model, folder=args.out, jobs=args.jobs, retry_failed=args.retry_failed)
    except ComputationFailed as failure:
        log(str(failure))
        return FAILED
    print_kappa(finished.tables.kappa)
    for row in finished.failures:
        log(f"{row.model}: {row.quantity} at n = {row.n:g}, k = {row.k:g}, mu = {row.mu:g}: {row.reason}")
    output().print(rich_table(statuses(finished.tables.results), "computations"))
    log(f"results are in {finished.folder}")
    return FAILED if finished.failures else OK
