"""``fscm-bench bench``: error, CPU time and memory of the solvers, measured on this machine, as ratios.

For example::

    fscm-bench bench --only work-precision
"""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.bench.run import PARTS, run_bench
from comparisons.cli.options import QUIET, file, option, several
from comparisons.cli.screen import print_lines
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, note

_PARTS = "; ".join(f"{part.name}, {part.title}" for part in PARTS.values())

OPTIONS = (
    several("--only", metavar="PART", help=f"only these parts (default: all): {_PARTS}"),
    option("--full", action="store_true", help="also measure the settings that take long"),
    file(
        "--out",
        metavar="DIR",
        default=Path("results", "runs", "bench"),
        help="folder for the files (default: %(default)s); resumed if it has some measurements",
    ),
    QUIET,
)


def call(args: argparse.Namespace) -> int:
    """Measure what is missing, write and print; return the exit status."""
    finished = run_bench(args.out, args.only, full=args.full)
    if not args.quiet:
        print_lines(finished.summary)
    for failure in finished.failures:
        log(failure)
    note(f"tables, figures and record are in {args.out}")
    return FAILED if finished.failures else OK
