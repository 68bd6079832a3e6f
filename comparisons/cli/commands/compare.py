"""``fscm-bench compare``: models beside a reference in cases of one's own, as one table and one figure."""

from __future__ import annotations

import argparse

from comparisons.cli.options import JOBS, MODEL_SPEC, OUT, QUIET, RETRY_FAILED, file, number, option
from comparisons.cli.screen import output
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, note
from comparisons.output.comparison import terminal_tables
from comparisons.output.run_summary import failure_lines
from comparisons.pipeline.compare import REFERENCES, compare

__all__ = ["call"]

EXAMPLES = ("fscm-bench compare jkr md-improved --n 1 2 --k 0 0.4 --mu 0.1 1 3",)


OPTIONS = (
    option("models", metavar="MODEL", nargs="+", help=MODEL_SPEC),
    file("--grid", help="[[grid]] tables as for fscm-bench sweep"),
    *(
        option(f"--{name}", metavar="X", type=number, nargs="+", help=text)
        for name, text in {
            "n": "values of n; every combination of --n, --k and --mu is a case",
            "k": "values of k",
            "mu": "values of mu",
            "nu": "Poisson's ratios, for models that need one",
        }.items()
    ),
    option("--quantity", metavar="NAME", nargs="+", help="see: fscm-bench list quantities (default: pull_off_force)"),
    option("--reference", choices=REFERENCES, help=f"(default: {REFERENCES[0]})"),
    option("--every", action="store_true", help="print every case, not the first 40"),
    JOBS,
    OUT,
    RETRY_FAILED,
    QUIET,
)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status."""
    if args.grid is not None and args.quantity is not None:
        raise ValueError("--grid states the quantities; leave out --quantity")
    finished = compare(
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
    if not args.quiet:
        console = output()
        for table in terminal_tables(finished.table, finished.summary, args.every, console.width):
            console.print(table)
    for line in failure_lines(finished.failures):
        log(line)
    note(f"comparison.csv, comparison.png and the results are in {finished.folder}")
    return FAILED if finished.failures else OK
