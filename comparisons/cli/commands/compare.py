"""``fscm-bench compare``: models beside a reference in cases of one's own, as one table and one figure.

For example::

    fscm-bench compare jkr md-improved --n 1 2 --k 0 0.4 --mu 0.1 1 3
    fscm-bench compare --model all --n 2 --k 0 --mu 0.1:10:20 --latex > table.tex
    fscm-bench compare jkr dmt --problem pad.toml --vary "solid.thickness=5, 10, 20 nm"
"""

from __future__ import annotations

import argparse

from comparisons.cli.options import JOBS, MODEL_SPEC, OUT, QUIET, VARIED_FILE, file, numbers, option, several
from comparisons.cli.screen import output, print_end
from comparisons.console.exit_status import FAILED
from comparisons.console.progress import log
from comparisons.output.summaries import terminal_tables
from comparisons.pipeline.compare import ALL, compare

_MODELS = f"{MODEL_SPEC}; {ALL}: every model of fscm-bench that has a value in these cases"

OPTIONS = (
    option("models", metavar="MODEL", nargs="*", help=_MODELS),
    several("--model", metavar="MODEL", help="more models"),
    file("--grid", help="the cases: a file of [[grid]] tables, as for fscm-bench sweep"),
    *VARIED_FILE,
    numbers("--n", help="values of n, or FROM:TO:COUNT; every combination of --n, --k and --mu is a case"),
    numbers("--k", help="values of k, or FROM:TO:COUNT, equally spaced"),
    numbers("--mu", logarithmic=True, help="values of mu, or FROM:TO:COUNT, logarithmically spaced: 0.1:10:20"),
    numbers("--nu", help="Poisson's ratios, for models that need one"),
    option("--quantity", metavar="NAME", nargs="+", help="see: fscm-bench list quantities (default: pull_off_force)"),
    option("--reference", metavar="MODEL", help="the reference (default: fscm; atlas takes microseconds)"),
    option("--every", action="store_true", help="print every case, not only the first 40"),
    option(
        "--latex",
        action="store_true",
        help="print the tables, with every case, as LaTeX (booktabs, longtable, siunitx)",
    ),
    JOBS,
    OUT,
    QUIET,
)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status."""
    if args.grid is not None and args.quantity is not None:
        raise ValueError("--grid states the quantities; leave out --quantity")
    finished = compare(
        [*args.models, *(args.model or ())],
        args.grid,
        problem=args.problem,
        vary=args.vary or (),
        n=args.n,
        k=args.k,
        mu=args.mu,
        nu=args.nu,
        quantities=args.quantity or ["pull_off_force"],
        reference=args.reference,
        folder=args.out,
        jobs=args.jobs,
    )
    if args.latex:
        print(finished.latex(), end="")
    elif not args.quiet:
        console = output()
        for table in terminal_tables(finished.table, finished.summary, args.every, console.width):
            console.print(table)
    status = print_end(finished.failures, finished.folder, "comparison.csv, comparison.png and the results are")
    if finished.table["kappa"].isna().all():
        log("nothing was evaluated: in no case do both the reference and another model have a value")
        return FAILED
    return status
