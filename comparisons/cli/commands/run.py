"""``fscm-bench run``: the standing cases, or those of a file, computed and judged.

For example::

    fscm-bench run
    fscm-bench run --model my_model.py:MyModel --out results/mine
    fscm-bench run --cases pads.toml --gates pad_gates.toml --out results/pads
"""

from __future__ import annotations

import argparse
from shlex import quote

from comparisons.cli.options import JOBS, OUT, QUIET, VERBOSE, file, option, several
from comparisons.cli.screen import output, print_end, print_lines
from comparisons.cli.verdict_screen import STATUS, print_verdicts
from comparisons.console.progress import note
from comparisons.output.summaries import computations_sentence, largest_errors
from comparisons.pipeline.run import run
from comparisons.runs.cases import TIERS

_FRESH = "also judge each model of --model in N fresh cases of its domain"

OPTIONS = (
    option("--tier", choices=TIERS, help=f"how much to compute (default: {TIERS[0]})"),
    file("--cases", help="[[grid]] tables, as for a sweep, instead of the standing cases; judged by --gates"),
    several("--model", metavar="SPEC", help="compute these models instead of those named by each grid"),
    file("--gates", help="judge by these gates instead of the standing ones"),
    option("--random", metavar="N", type=int, default=0, help=_FRESH),
    option("--seed", metavar="S", type=int, help="seed of the fresh cases (default: random)"),
    JOBS,
    OUT,
    VERBOSE,
    QUIET,
)


def call(args: argparse.Namespace) -> int:
    """Run and print; return the exit status."""
    if args.cases is not None and args.gates is None:
        raise ValueError("--cases FILE needs --gates FILE; fscm-bench sweep FILE computes cases without gates")
    if args.cases is not None and args.tier is not None:
        raise ValueError(f"--tier {args.tier} is of the standing cases; give it, or --cases FILE")
    finished = run(
        args.cases or args.tier or TIERS[0],
        args.gates,
        args.model,
        args.out,
        jobs=args.jobs,
        random=args.random,
        seed=args.seed,
    )
    judgement = finished.judgement
    if not args.quiet:
        if len(finished.tables.kappa):
            output().print(largest_errors(finished.tables.kappa))
        print_lines([computations_sentence(finished.counts)])
    assert judgement is not None  # There are gates: the standing ones, or those of the user.
    print_verdicts(judgement, verbose=args.verbose, quiet=args.quiet)
    status = print_end(finished.failures, finished.folder)
    if not judgement.verdicts.empty:
        note(f"next: fscm-bench report {quote(str(finished.folder))}")
    return status or STATUS[judgement.verdict]
