"""``fscm-bench bench``: error, CPU time and memory of the solvers, measured on this machine, as ratios."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from pathlib import Path

from comparisons.bench.part import Measurement
from comparisons.bench.registry import PARTS
from comparisons.bench.run import run_bench
from comparisons.cli.options import FAILED, OK, add_quiet, output
from comparisons.console.progress import log, note, quiet

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench bench --only work-precision",)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "--only",
        metavar="PART",
        nargs="+",
        action="extend",
        help="only these parts (default: all): " + "; ".join(f"{part.name}, {part.title}" for part in PARTS.values()),
    )
    parser.add_argument("--full", action="store_true", help="measure the largest sizes, too (half an hour)")
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=Path("results", "runs", "bench"),
        help="folder for the files (default: %(default)s); resumed if it has some measurements",
    )
    parser.add_argument("--again", action="store_true", help="drop stored measurements and measure everything again")
    parser.add_argument("--retry-failed", action="store_true", help="measure stored failures again")
    add_quiet(parser)


def call(args: argparse.Namespace) -> int:
    """Measure what is missing, write and print; return the exit status."""
    with quiet() if args.quiet else nullcontext():
        finished = run_bench(args.out, args.only, full=args.full, again=args.again, retry_failed=args.retry_failed)
        if not args.quiet:
            console = output()
            for line in finished.summary:
                console.print(line, markup=False, soft_wrap=True)
        for failure in finished.failures:
            log(_sentence(failure))
        note(f"tables, figures and record are in {finished.folder}")
    return FAILED if finished.failures else OK


def _sentence(failure: Measurement) -> str:
    settings = ", ".join(f"{name} = {value}" for name, value in failure.settings.items())
    return f"{failure.part} ({settings}): failed: {failure.reason}"
