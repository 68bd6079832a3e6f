"""``fscm-bench judge``: a new judgement of the stored results of a run, by its own gates or others."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from pathlib import Path
from shlex import quote

from comparisons.cli.options import FAILED, FAILS, INCONCLUSIVE, OK, add_quiet, add_verbose, output
from comparisons.cli.verdict_screen import (
    error_lines,
    print_every_verdict,
    print_lines,
    unexpected_lines,
    verdict_lines,
)
from comparisons.console.progress import log, quiet
from comparisons.judging.card_gates import without_card_gates
from comparisons.judging.decision import Verdict
from comparisons.output.markdown import to_step_summary
from comparisons.pipeline.judgement import Judgement, judge_folder

__all__ = ["EXAMPLES", "STATUS", "add", "call", "show"]

#: Examples of the help.
EXAMPLES = ("fscm-bench judge results/mine --verbose",)

#: Verdict over all gates -> exit status.
STATUS = {
    Verdict.ERROR: FAILED,
    Verdict.FAIL: FAILS,
    Verdict.XPASS: FAILS,
    Verdict.INCONCLUSIVE: INCONCLUSIVE,
    Verdict.XFAIL: OK,
    Verdict.PASS: OK,
}

#: Lines of the summary; the other ten of a terminal's forty are for messages.
_LINES = 30


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("folder", metavar="DIR", type=Path, help="folder of a finished run")
    parser.add_argument("--gates", metavar="FILE", type=Path, help="judge by these gates, not by those of the run")
    add_verbose(parser)
    add_quiet(parser)


def call(args: argparse.Namespace) -> int:
    """Judge and print; return the exit status."""
    to_step_summary("")
    with quiet() if args.quiet else nullcontext():
        judgement = judge_folder(args.folder, args.gates)
    show(judgement, verbose=args.verbose, failures_only=args.quiet)
    if not args.quiet and not judgement.verdicts.empty:
        log(f"next: fscm-bench report {quote(str(args.folder))}")
    to_step_summary(judgement.markdown)
    return STATUS[judgement.verdict]


def show(judgement: Judgement, *, verbose: bool, failures_only: bool, lines: int = _LINES) -> None:
    """Print the verdicts: a summary of so many lines, all rows, or what does not behave as declared."""
    if without_card_gates(judgement.verdicts).empty:
        log("no gate was evaluated")
    if judgement.verdicts.empty:
        return
    width = output().width
    if failures_only:
        for line in unexpected_lines(judgement, width):
            log(line)
    elif verbose:
        print_every_verdict(judgement)
    else:
        print_lines(verdict_lines(judgement, width, lines))
    for line in error_lines(judgement):
        log(line)
