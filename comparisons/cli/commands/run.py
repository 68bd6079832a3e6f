"""``fscm-bench run``: the standing cases, or those of a file, computed and judged."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from pathlib import Path
from shlex import quote

from comparisons.cli.commands.judge import STATUS, show
from comparisons.cli.options import FAILED, add_jobs, add_out, add_quiet, add_retry_failed, add_verbose, output
from comparisons.cli.verdict_screen import error_lines, print_lines, verdict_lines
from comparisons.console.folding import folded
from comparisons.console.progress import log, note, quiet
from comparisons.model import ComputationFailed
from comparisons.output.markdown import to_step_summary
from comparisons.output.run_summary import (
    computations_sentence,
    every_error,
    failure_lines,
    largest_errors,
    largest_table,
    paper_sentence,
)
from comparisons.pipeline.finished_run import FinishedRun
from comparisons.pipeline.run import run
from comparisons.runs.cases import TIERS

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = (
    "fscm-bench run",
    "fscm-bench run --model my_model.py:MyModel --out results/mine",
    "fscm-bench run --cases pads.toml --gates pad_gates.toml --out results/pads",
)

#: Lines of the whole output without --verbose, at 80 columns or more; of these for the messages on stderr.
_LINES, _MESSAGES = 40, 7

#: Lines of the smallest table of errors: title, columns, rule and two models.
_LEAST_TABLE = 6


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("--tier", choices=TIERS, help=f"how much to compute (default: {TIERS[0]})")
    parser.add_argument(
        "--cases",
        metavar="FILE",
        type=Path,
        help="in place of the standing cases: [[grid]] tables as of a sweep, judged by --gates",
    )
    parser.add_argument(
        "--model",
        metavar="SPEC",
        nargs="+",
        action="extend",
        help="compare these models instead of those each grid names",
    )
    parser.add_argument("--gates", metavar="FILE", type=Path, help="judge by these gates instead of the standing ones")
    parser.add_argument(
        "--random",
        metavar="N",
        type=int,
        default=0,
        help="judge each model of --model in N fresh cases of its own domain, too",
    )
    parser.add_argument("--seed", metavar="S", type=int, help="seed of the fresh cases (default: a new one)")
    add_jobs(parser)
    add_out(parser)
    add_retry_failed(parser)
    add_verbose(parser)
    add_quiet(parser)


def call(args: argparse.Namespace) -> int:
    """Run and print; return the exit status."""
    if args.cases is not None and args.gates is None:
        raise ValueError("--cases FILE needs --gates FILE; fscm-bench sweep FILE computes cases without gates")
    if args.cases is not None and args.tier is not None:
        raise ValueError(
            f"--tier {args.tier} is of the standing cases, and --cases FILE states others; give one of them"
        )
    to_step_summary("")
    with quiet() if args.quiet else nullcontext():
        try:
            finished = run(
                args.cases or args.tier or TIERS[0],
                args.gates,
                args.model,
                args.out,
                jobs=args.jobs,
                retry_failed=args.retry_failed,
                random=args.random,
                seed=args.seed,
            )
        except ComputationFailed as failure:
            log(str(failure))
            return FAILED
        judgement = finished.judgement
        if args.verbose:
            for every in every_error(finished.tables.results, finished.tables.kappa, finished.tables.largest):
                output().print(every)
        _show(finished, verbose=args.verbose, failures_only=args.quiet, with_paper=args.gates is None)
        note(f"results are in {finished.folder}")
        if judgement is not None and not judgement.verdicts.empty:
            note(f"next: fscm-bench report {quote(str(finished.folder))}")
    # Last: a disk that is full here loses nothing.
    if judgement is not None:
        to_step_summary(judgement.markdown)
    failed = finished.failures or judgement is None
    return FAILED if failed or judgement is None else STATUS[judgement.verdict]


def _show(finished: FinishedRun, *, verbose: bool, failures_only: bool, with_paper: bool) -> None:
    """Print the errors and the verdicts, and the failed computations on stderr.

    The numbers of the paper belong to the standing gates: by gates of one's own they are not shown.
    """
    judgement, maxima = finished.judgement, finished.tables.largest
    failures = list(failure_lines(finished.failures))
    lines = taken = 0
    judged = judgement is not None and not judgement.verdicts.empty
    if not (verbose or failures_only):
        width = output().width
        sentences = [computations_sentence(finished.counts), paper_sentence(maxima) if with_paper else ""]
        below = [line for sentence in sentences if sentence for line in folded(sentence, width)]
        messages = [*failures, *(error_lines(judgement) if judgement is not None and judged else ())]
        room = _LINES - _MESSAGES - len(below) - sum(len(folded(line, width)) for line in messages)
        if judgement is not None and judged:
            lines = room - _LEAST_TABLE
            taken = len(verdict_lines(judgement, width, lines))
        table = largest_table(maxima, width, room - taken)
        if table is not None:
            output().print(table)
        kappa = finished.tables.kappa
        if "problem" in kappa:
            output().print(largest_errors(kappa[kappa["problem"].fillna("") != ""]))
        print_lines(below)
    if judgement is not None:
        show(judgement, verbose=verbose, failures_only=failures_only, lines=lines)
    for line in failures:
        log(line)
