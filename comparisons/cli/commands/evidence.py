"""Commands that compute the evidence again: the figures of the paper, and the benchmark of the solvers."""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.bench.run import PARTS, run_bench
from comparisons.cli.options import JOBS, QUIET, command, file, option, several
from comparisons.cli.screen import output, print_text
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, note
from comparisons.paper.registry import NAMES
from comparisons.pipeline.figures import make_figures

_PARTS = "; ".join(f"{part.name}, {part.title}" for part in PARTS.values())


@command(
    several("--figure", "--only", metavar="N", help=f"only these of {', '.join(NAMES)} (default: all)"),
    JOBS,
    file(
        "--out",
        metavar="DIR",
        default=Path("results", "runs", "paper"),
        help="folder for the files (default: %(default)s); resumed if it has some results",
    ),
)
def paper_command(args: argparse.Namespace) -> int:
    """Compute what is missing, write the figures, print their files; return the exit status.

    For example::

        fscm-bench paper --figure 16 --out results/paper
    """
    finished = make_figures(args.figure, args.out, jobs=args.jobs)
    console = output()
    for written in finished:
        figure = written.figure
        if written.failure:
            log(f"{figure.stem}: {written.failure}")
            continue
        console.print(f"{figure.stem}: {figure.title} ({len(written.files)} files)")
        if printed := figure.printed(written.tables):
            console.print(printed)
    console.print(f"written to {args.out}")
    return FAILED if any(written.failure for written in finished) else OK


@command(
    several("--only", metavar="PART", help=f"only these parts (default: all): {_PARTS}"),
    option("--full", action="store_true", help="also measure the settings that take long"),
    file(
        "--out",
        metavar="DIR",
        default=Path("results", "runs", "bench"),
        help="folder for the files (default: %(default)s); resumed if it has some measurements",
    ),
    file("--against", metavar="DIR", help="folder of a run to compare with (default: the committed one of a clone)"),
    QUIET,
)
def bench_command(args: argparse.Namespace) -> int:
    """Measure what is missing, write and print; return the exit status.

    For example::

        fscm-bench bench --only work-precision
    """
    finished = run_bench(args.out, args.only, full=args.full, against=args.against)
    if not args.quiet:
        print_text(finished.summary)
    for failure in finished.failures:
        log(failure)
    note(f"tables, figures and record are in {args.out}")
    return FAILED if finished.failures else OK
