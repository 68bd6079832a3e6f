"""Commands that judge: a run of the standing cases or of a file's, and stored results again."""

from __future__ import annotations

import argparse
from shlex import quote

from comparisons.cli.options import INTEGER, JOBS, OUT, QUIET, VERBOSE, command, file, option, several
from comparisons.cli.screen import output, print_end, print_text
from comparisons.console.exit_status import FAILED, FAILS, INCONCLUSIVE, OK
from comparisons.console.progress import log, note
from comparisons.judging.decision import Verdict
from comparisons.judging.report_card import card_lines, given_models
from comparisons.judging.summary import summarise
from comparisons.output.summaries import computations_sentence, largest_errors
from comparisons.output.verdicts import declared_sentence, gate_lines, gates_sentence, unexpected
from comparisons.pipeline.judgement import Judgement, judge_folder
from comparisons.pipeline.run import run
from comparisons.runs.cases import TIERS

#: Verdict over all gates -> exit status.
STATUS = {
    Verdict.ERROR: FAILED,
    Verdict.FAIL: FAILS,
    Verdict.XPASS: FAILS,
    Verdict.INCONCLUSIVE: INCONCLUSIVE,
    Verdict.XFAIL: OK,
    Verdict.PASS: OK,
}

#: A summary has so many gates with their commands, and so many gates in error with a sentence each.
_GATES, _ERRORS = 4, 2

_FRESH = "also judge each model of --model in N fresh cases of its domain"


@command(
    option("--tier", choices=TIERS, help=f"how much to compute (default: {TIERS[0]})"),
    file("--cases", help="[[grid]] tables, as for a sweep, instead of the standing cases; judged by --gates"),
    several("--model", metavar="SPEC", help="compute these models instead of those named by each grid"),
    file("--gates", help="judge by these gates instead of the standing ones"),
    option("--random", metavar="N", type=INTEGER, default=0, help=_FRESH),
    option("--seed", metavar="S", type=INTEGER, help="seed of the fresh cases (default: random)"),
    option("--pdf", action="store_true", help="write the figures as PDF, too"),
    JOBS,
    OUT,
    VERBOSE,
    QUIET,
)
def run_command(args: argparse.Namespace) -> int:
    """Run and print; return the exit status.

    For example::

        fscm-bench run
        fscm-bench run --model my_model.py:MyModel --out results/mine
        fscm-bench run --cases pads.toml --gates pad_gates.toml --out results/pads
    """
    if args.cases is not None and args.gates is None:
        raise ValueError("--cases FILE needs --gates FILE; fscm-bench sweep FILE computes cases without gates")
    if args.cases is not None and args.tier is not None:
        raise ValueError(f"--tier {args.tier} is of the standing cases; give it, or --cases FILE")
    cases = args.cases or args.tier or TIERS[0]
    fresh = {"random": args.random, "seed": args.seed}
    finished = run(cases, args.gates, args.model, args.out, jobs=args.jobs, pdf=args.pdf, **fresh)
    if not args.quiet:
        for table in largest_errors(finished.tables.kappa):
            output().print(table)
        print_text([computations_sentence(finished.counts)])
    assert finished.judgement is not None  # There are gates: the standing ones, or those of the user.
    _print_verdicts(finished.judgement, args)
    status = print_end(finished.failures, finished.folder)
    verdict = _end(finished.judgement)
    return status or verdict


@command(
    file("folder", metavar="DIR", help="folder of a finished run"),
    file("--gates", help="judge by these gates instead of those of the run"),
    VERBOSE,
    QUIET,
)
def judge_command(args: argparse.Namespace) -> int:
    """Judge stored results and print; return the exit status.

    For example::

        fscm-bench judge results/mine --verbose
    """
    judgement = judge_folder(args.folder, args.gates)
    _print_verdicts(judgement, args)
    return _end(judgement)


def _end(judgement: Judgement) -> int:
    """Name the next command; return the exit status of the verdict."""
    if not judgement.verdicts.empty:
        note(f"next: fscm-bench report {quote(str(judgement.folder))}")
    return STATUS[judgement.verdict]


def _print_verdicts(judgement: Judgement, args: argparse.Namespace) -> None:
    """Print the report cards and the gates: what is not as declared, or all; with --quiet only that, as messages."""
    checks = judgement.checks
    if judgement.verdicts.empty:
        log("no gate was evaluated")
        if not checks:
            return
    gates = summarise(judgement.verdicts)
    if args.quiet:
        for check in checks:
            if check.verdict is not Verdict.PASS:
                log(f"{check.verdict} {check.model}, {check.line}: {check.reason}")
        for line in gate_lines(unexpected(gates), judgement.inputs.specs, _GATES):
            log(line)
    else:
        print_text(_cards(judgement))
        rows, most = (gates, None) if args.verbose else (unexpected(gates), _GATES)
        print_text(gate_lines(rows, judgement.inputs.specs, most))
        print_text(filter(None, [declared_sentence(gates), gates_sentence(gates, judgement.verdicts, checks)]))
    wrong = gates[gates["verdict"] == Verdict.ERROR]
    for row in wrong.head(_ERRORS).itertuples():
        log(f"a gate is in error: {row.gate} of {row.candidate}: {row.reason}")
    if len(wrong) > _ERRORS:
        log(f"{len(wrong) - _ERRORS} more gates are in error")


def _cards(judgement: Judgement) -> list[str]:
    """Return the lines of the report cards of the given models."""
    lines: list[str] = []
    for name in given_models(judgement.inputs.models, judgement.verdicts, judgement.cards):
        recorded, domain = judgement.cards.get(name), judgement.inputs.domains.get(name)
        card = card_lines(name, judgement.verdicts, judgement.checks, recorded, domain)
        label_width = max(len(label) for label, _ in card)
        lines += [f"report card of {name}", *(f"  {label:{label_width}}  {text}" for label, text in card)]
    return lines
