"""``fscm-bench compare``: models beside a reference in cases of one's own, as one table and one figure."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from pathlib import Path

from comparisons.cli.options import (
    FAILED,
    MODEL_SPEC,
    OK,
    add_jobs,
    add_out,
    add_quiet,
    add_retry_failed,
    number,
    output,
)
from comparisons.console.progress import log, note, quiet
from comparisons.model import ComputationFailed
from comparisons.output.comparison import terminal_tables
from comparisons.output.run_summary import failure_lines
from comparisons.pipeline.compare import REFERENCES, compare

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench compare jkr md-improved --n 1 2 --k 0 0.4 --mu 0.1 1 3",)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("models", metavar="MODEL", nargs="+", help=MODEL_SPEC)
    parser.add_argument("--grid", metavar="FILE", type=Path, help="[[grid]] tables as for fscm-bench sweep")
    for name in ("n", "k", "mu"):
        meaning = f"values of {name}; every combination of --n, --k and --mu is a case"
        parser.add_argument(f"--{name}", metavar="X", type=number, nargs="+", help=meaning)
    parser.add_argument("--nu", metavar="X", type=number, nargs="+", help="Poisson's ratios, for models that need one")
    parser.add_argument(
        "--quantity", metavar="NAME", nargs="+", help="see: fscm-bench list quantities (default: pull_off_force)"
    )
    parser.add_argument("--reference", choices=REFERENCES, help=f"(default: {REFERENCES[0]})")
    parser.add_argument("--every", action="store_true", help="print every case, not the first 40")
    add_jobs(parser)
    add_out(parser)
    add_retry_failed(parser)
    add_quiet(parser)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status."""
    if args.grid is not None and args.quantity is not None:
        raise ValueError("--grid states the quantities; leave out --quantity")
    with quiet() if args.quiet else nullcontext():
        try:
            found = compare(
                args.models,
                args.grid,
                n=args.n,
                k=args.k,
                mu=args.mu,
                nu=args.nu,
                quantities=args.quantity or ["pull_off_force"],
                reference=args.reference,
                folder=args.out,
                jobs=args.jobs,
                retry_failed=args.retry_failed,
            )
        except ComputationFailed as failure:
            log(str(failure))
            return FAILED
        if not args.quiet:
            console = output()
            for table in terminal_tables(found.table, found.summary, args.every, console.width):
                console.print(table)
        for line in failure_lines(found.failures):
            log(line)
        note(f"comparison.csv, comparison.png and the results are in {found.folder}")
    return FAILED if found.failures else OK
