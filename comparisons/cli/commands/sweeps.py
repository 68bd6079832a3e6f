"""Commands on cases of one's own, without gates: a sweep, its shards in one folder, and a comparison."""

from __future__ import annotations

import argparse
from shlex import quote

from comparisons.cli.options import (
    JOBS,
    MODEL_SPEC,
    OUT,
    QUIET,
    VARIED_FILE,
    command,
    file,
    numbers,
    option,
    several,
)
from comparisons.cli.screen import output, print_end, print_text
from comparisons.console.exit_status import FAILED
from comparisons.console.progress import log, note
from comparisons.description.budget import line_of_results
from comparisons.output.summaries import computations_sentence, refusal_lines, sweep_tables, terminal_tables
from comparisons.pipeline.compare import ALL, compare
from comparisons.pipeline.finished_run import FinishedRun
from comparisons.pipeline.inputs import cases_of_problem
from comparisons.pipeline.merge import merge
from comparisons.pipeline.run import run
from comparisons.registry import identify

_MODELS = f"{MODEL_SPEC}; {ALL}: every model of fscm-bench that has a value in these cases"
_OWN_MODELS = "compute these models instead of those named by each grid (default with --problem: fscm)"
_LATEX = "print the tables, with every case, as LaTeX (booktabs, longtable, siunitx)"


@command(
    file("file", nargs="?", help="[[grid]] tables as in comparisons/data/cases.toml, without a tier"),
    *VARIED_FILE,
    several("--quantity", metavar="NAME", help="quantities of the problem file (default: pull_off_force)"),
    several("--model", metavar="SPEC", help=_OWN_MODELS),
    JOBS,
    option("--shard", metavar="i/N", help="compute the i-th of N parts, to be put together by fscm-bench merge"),
    OUT,
    QUIET,
)
def sweep_command(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status.

    For example::

        fscm-bench sweep my_cases.toml --model jkr md-improved --out results/sweep
        fscm-bench sweep --problem pad.toml --vary "solid.thickness=5, 10, 20 nm" --vary "punch.R=50:250:5 nm"
    """
    if args.shard is not None and args.out is None:
        raise ValueError(
            f"--shard {args.shard} needs --out DIR: each shard has a folder of its own, which is merged later"
        )
    if (args.file is None) == (args.problem is None):
        raise ValueError("a sweep is of one file: FILE with [[grid]] tables, or --problem FILE")
    cases, models = args.file, args.model
    if args.problem is not None:
        models = args.model or ["fscm"]
        names, _ = identify(models)
        cases = cases_of_problem(args.problem, args.vary or [], names, args.quantity or ["pull_off_force"])
    elif args.vary or args.quantity:
        name = "--vary" if args.vary else "--quantity"
        raise ValueError(f"{name} is for --problem FILE; the [[grid]] tables state their cases and quantities")
    return _show(run(cases, models=models, folder=args.out, jobs=args.jobs, shard=args.shard), args.quiet)


@command(
    file("folders", metavar="DIR", nargs="+", help="folders written by fscm-bench sweep --shard"),
    file("--out", metavar="DIR", required=True, help="folder for the whole sweep"),
    QUIET,
)
def merge_command(args: argparse.Namespace) -> int:
    """Merge, write and print; return the exit status.

    For example::

        fscm-bench merge results/shard1 results/shard2 --out results/sweep
    """
    return _show(merge(args.folders, args.out), args.quiet)


def _show(finished: FinishedRun, quiet: bool) -> int:
    """Print the summary of a sweep and its failures; return the exit status."""
    if not quiet:
        console = output()
        for table in sweep_tables(finished.tables.results, finished.tables.kappa):
            console.print(table)
        problems = (problem for grid in finished.inputs.cases.grids for problem in grid.cases)
        line = line_of_results(problems, finished.tables.results)
        print_text([computations_sentence(finished.counts), *filter(None, [line])])
    status = print_end(finished.failures, finished.folder)
    note(f"next: fscm-bench report {quote(str(finished.folder))}, a page with tables and plots")
    return status


@command(
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
    option("--latex", action="store_true", help=_LATEX),
    JOBS,
    OUT,
    QUIET,
)
def compare_command(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status.

    For example::

        fscm-bench compare jkr md-improved --n 1 2 --k 0 0.4 --mu 0.1 1 3
        fscm-bench compare --model all --n 2 --k 0 --mu 0.1:10:20 --latex > table.tex
        fscm-bench compare jkr dmt --problem pad.toml --vary "solid.thickness=5, 10, 20 nm"
    """
    if args.grid is not None and args.quantity is not None:
        raise ValueError("--grid states the quantities; leave out --quantity")
    finished = compare(
        [*args.models, *(args.model or ())],
        args.grid,
        problem=args.problem,
        vary=args.vary or (),
        **{name: getattr(args, name) for name in ("n", "k", "mu", "nu", "reference", "jobs")},
        quantities=args.quantity or ["pull_off_force"],
        folder=args.out,
    )
    if args.latex:
        print(finished.latex(), end="")
    elif not args.quiet:
        console = output()
        for table in terminal_tables(finished.table, finished.summary, args.every, console.width):
            console.print(table)
        print_text([*refusal_lines(finished.table), *filter(None, [finished.assumptions])])
    status = print_end(finished.failures, finished.folder, "comparison.csv, comparison.png and the results are")
    if finished.table["kappa"].isna().all():
        log("nothing was evaluated: in no case do both the reference and another model have a value")
        return FAILED
    return status
