"""``fscm-bench sweep``: grids of your own, computed with the errors of every model, without gates."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from pathlib import Path

from comparisons.cli.options import FAILED, OK, add_jobs, add_out, add_quiet, add_retry_failed, output
from comparisons.console.progress import log, note, quiet
from comparisons.model import ComputationFailed
from comparisons.output.problem_values import values_of_problems
from comparisons.output.run_summary import failure_lines, summary_tables
from comparisons.pipeline.finished_run import FinishedRun
from comparisons.pipeline.inputs import cases_of_problem
from comparisons.pipeline.run import run
from comparisons.registry import identify
from comparisons.runs.backends import BACKENDS

__all__ = ["EXAMPLES", "add", "call", "show"]

#: Examples of the help.
EXAMPLES = (
    "fscm-bench sweep my_cases.toml --model jkr md-improved --out results/sweep",
    'fscm-bench sweep --problem pad.toml --vary "solid.thickness=5, 10, 20 nm" --vary "punch.R=50:250:5 nm" --out pads',
)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "file",
        metavar="FILE",
        nargs="?",
        type=Path,
        help="[[grid]] tables as in comparisons/data/cases.toml, without a tier",
    )
    parser.add_argument(
        "--problem", metavar="FILE", type=Path, help="in place of these: a problem file, whose keys are varied; in SI"
    )
    parser.add_argument(
        "--vary",
        metavar="KEY=VALUES",
        action="append",
        help="values of a key of the problem file: SECTION.KEY=A, B, C UNIT or SECTION.KEY=FIRST:LAST:NUMBER UNIT",
    )
    parser.add_argument(
        "--quantity",
        metavar="NAME",
        nargs="+",
        action="extend",
        help="quantities of the problem file (default: pull_off_force)",
    )
    parser.add_argument(
        "--model",
        metavar="SPEC",
        nargs="+",
        action="extend",
        help="compare these models instead of those each grid names; of a problem file: fscm if there are none",
    )
    add_jobs(parser)
    parser.add_argument(
        "--backend", choices=BACKENDS, default=BACKENDS[0], help="where it is computed (default: %(default)s)"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="scheduler of a Dask cluster (default: one is started on this machine)"
    )
    parser.add_argument(
        "--shard", metavar="i/N", help="compute the i-th of N parts, to be put together by fscm-bench merge"
    )
    add_out(parser)
    add_retry_failed(parser)
    add_quiet(parser)


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
        cases = cases_of_problem(args.problem, args.vary, names, args.quantity or ["pull_off_force"])
    with quiet() if args.quiet else nullcontext():
        try:
            finished = run(
                cases,
                models=models,
                folder=args.out,
                jobs=args.jobs,
                retry_failed=args.retry_failed,
                backend=args.backend,
                scheduler=args.scheduler,
                shard=args.shard,
            )
        except ComputationFailed as failure:
            log(str(failure))
            return FAILED
        return show(finished, with_summary=not args.quiet)


def _require_one_form(args: argparse.Namespace) -> None:
    """Refuse arguments of both forms of the command, or of none."""
    if (args.file is None) == (args.problem is None):
        raise ValueError("a sweep is of one file: FILE with [[grid]] tables, or --problem FILE with --vary KEY=VALUES")
    if args.problem is None and (args.vary or args.quantity):
        option = "--vary" if args.vary else "--quantity"
        raise ValueError(f"{option} is for --problem FILE; the [[grid]] tables state their cases and quantities")
    if args.problem is not None and not args.vary:
        raise ValueError("--problem needs --vary KEY=VALUES; fscm-bench solve --problem computes a single problem")


def show(finished: FinishedRun, *, with_summary: bool) -> int:
    """Print the summary of a sweep and its failures; return the exit status."""
    if with_summary:
        console = output()
        for table in values_of_problems(finished.tables.results):
            console.print(table)
        for table in summary_tables(finished.tables.results, finished.tables.curves, finished.tables.kappa):
            console.print(table)
    for line in failure_lines(finished.failures):
        log(line)
    note(f"results are in {finished.folder}")
    return FAILED if finished.failures else OK
