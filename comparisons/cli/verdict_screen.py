"""Verdicts on the terminal: every gate, or a summary of few lines."""

from __future__ import annotations

from comparisons.cli.screen import print_lines
from comparisons.console.exit_status import FAILED, FAILS, INCONCLUSIVE, OK
from comparisons.console.progress import log
from comparisons.judging.decision import Verdict
from comparisons.judging.report_card import card_lines, given_models, without_card_gates
from comparisons.judging.summary import summarise
from comparisons.output.verdicts import declared_sentence, gate_lines, gates_sentence, unexpected
from comparisons.pipeline.judgement import Judgement

#: Verdict over all gates -> exit status.
STATUS = {
    Verdict.ERROR: FAILED,
    Verdict.FAIL: FAILS,
    Verdict.XPASS: FAILS,
    Verdict.INCONCLUSIVE: INCONCLUSIVE,
    Verdict.XFAIL: OK,
    Verdict.PASS: OK,
}

#: A summary has so many gates with their commands.
_GATES = 4

#: Gates in error with a sentence each.
_ERRORS = 2


def print_verdicts(judgement: Judgement, *, verbose: bool, quiet: bool) -> None:
    """Print the report cards and the gates: what is not as declared, or all; with `quiet` only that, as messages."""
    if without_card_gates(judgement.verdicts).empty:
        log("no gate was evaluated")
    if judgement.verdicts.empty:
        return
    gates = summarise(judgement.verdicts)
    if quiet:
        for line in gate_lines(unexpected(gates), judgement.inputs.specs, _GATES):
            log(line)
    else:
        print_lines(_cards(judgement))
        rows, most = (gates, None) if verbose else (unexpected(gates), _GATES)
        print_lines(gate_lines(rows, judgement.inputs.specs, most))
        print_lines(filter(None, [declared_sentence(gates), gates_sentence(gates, judgement.verdicts)]))
    wrong = gates[gates["verdict"] == Verdict.ERROR]
    for row in wrong.head(_ERRORS).itertuples():
        log(f"a gate is in error: {row.gate} of {row.candidate}: {row.reason}")
    if len(wrong) > _ERRORS:
        log(f"{len(wrong) - _ERRORS} more gates are in error")


def _cards(judgement: Judgement) -> list[str]:
    """Return the lines of the report cards of the given models."""
    lines: list[str] = []
    for name in given_models(judgement.inputs.models, judgement.verdicts):
        card = card_lines(name, judgement.verdicts, judgement.cards.get(name), judgement.inputs.domains.get(name))
        label_width = max(len(label) for label, _ in card)
        lines += [f"report card of {name}", *(f"  {label:{label_width}}  {text}" for label, text in card)]
    return lines
