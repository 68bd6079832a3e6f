"""``fscm-bench sweep``: grids of your own, computed with the errors of every model, without gates.

For example::

    fscm-bench sweep my_cases.toml --model jkr md-improved --out results/sweep
    fscm-bench sweep --problem pad.toml --vary "solid.thickness=5, 10, 20 nm" --vary "punch.R=50:250:5 nm" --out pads
"""

from __future__ import annotations

import argparse

from comparisons.cli.options import JOBS, OUT, QUIET, VARIED_FILE, file, option, several
from comparisons.cli.screen import output, print_end, print_lines
from comparisons.output.summaries import computations_sentence, sweep_tables
from comparisons.pipeline.finished_run import FinishedRun
from comparisons.pipeline.inputs import cases_of_problem
from comparisons.pipeline.run import run
from comparisons.registry import identify

OPTIONS = (
    file("file", nargs="?", help="[[grid]] tables as in comparisons/data/cases.toml, without a tier"),
    *VARIED_FILE,
    several("--quantity", metavar="NAME", help="quantities of the problem file (default: pull_off_force)"),
    several(
        "--model",
        metavar="SPEC",
        help="compute these models instead of those named by each grid (default with --problem: fscm)",
    ),
    JOBS,
    option("--shard", metavar="i/N", help="compute the i-th of N parts, to be put together by fscm-bench merge"),
    OUT,
    QUIET,
)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status."""
    if args.shard is not None and args.out is None:
        raise ValueError(
            f"--shard {args.shard} needs --out DIR: each shard has a folder of its own, which is merged later"
        )
    _require_one_form(args)
    cases, models = args.file, args.model
    if args.problem is not None:
        models = args.model or ["fscm"]
        names, _ = identify(models)
        cases = cases_of_problem(args.problem, args.vary or [], names, args.quantity or ["pull_off_force"])
    finished = run(
        cases,
        models=models,
        folder=args.out,
        jobs=args.jobs,
        shard=args.shard,
    )
    return show(finished, with_summary=not args.quiet)


def _require_one_form(args: argparse.Namespace) -> None:
    """Refuse options of both forms of the command, or of none."""
    if (args.file is None) == (args.problem is None):
        raise ValueError("a sweep is of one file: FILE with [[grid]] tables, or --problem FILE")
    if args.problem is None and (args.vary or args.quantity):
        name = "--vary" if args.vary else "--quantity"
        raise ValueError(f"{name} is for --problem FILE; the [[grid]] tables state their cases and quantities")


def show(finished: FinishedRun, *, with_summary: bool) -> int:
    """Print the summary of a sweep and its failures; return the exit status."""
    if with_summary:
        console, tables = output(), finished.tables
        for table in sweep_tables(tables.results, tables.kappa):
            console.print(table)
        print_lines([computations_sentence(finished.counts)])
    return print_end(finished.failures, finished.folder)
