"""Verdicts of a run on the terminal: all rows, or a summary of few lines."""

from __future__ import annotations

from collections.abc import Iterable

from comparisons.cli.options import output
from comparisons.console.folding import folded, hanging
from comparisons.judging.decision import Verdict
from comparisons.judging.report_card import card_lines, given_models, verdict_sentence
from comparisons.judging.summary import summarise
from comparisons.output.gate_sentence import declared_sentence, gate_lines, gates_line, unexpected
from comparisons.pipeline.judgement import Judgement
from comparisons.runs.folder import RunFolder
from comparisons.runs.tables import read_table

__all__ = [
    "card_summary",
    "error_lines",
    "print_every_verdict",
    "print_lines",
    "summary_lines",
    "unexpected_lines",
    "verdict_lines",
]

#: Gates that do not pass and are shown with their command, and given models with a sentence each where their report
#: cards are long; cards have at most so many lines.
SHOWN, _CARD_LINES = 4, 12

#: Gates in error with a sentence each.
_ERRORS = 2


def summary_lines(judgement: Judgement, width: int, most: int = SHOWN) -> list[str]:
    """Return what does not pass with its command, what fails as declared, and the sentence on all gates.

    Parameters
    ----------
    judgement : Judgement
    width : int
        Columns of the terminal.
    most : int
        Gates that are shown with their command, and given models with a sentence.
    """
    gates = summarise(judgement.verdicts)
    files = RunFolder(judgement.folder)
    required = read_table(files.parquet(files.gates))
    bases = dict(zip(required["id"], required["basis"], strict=True))
    declared = declared_sentence(gates)
    return [
        *gate_lines(unexpected(gates), judgement.specs, width, most),
        *(hanging(declared, width) if declared else ()),
        *folded(gates_line(gates, judgement.verdicts, bases), width),
    ]


def verdict_lines(judgement: Judgement, width: int, lines: int) -> list[str]:
    """Return the report cards and the summary; with so few gates and models in full that the lines suffice."""
    found: list[str] = []
    for most in range(SHOWN, 0, -1):
        found = [*card_summary(judgement, width, most), *summary_lines(judgement, width, most)]
        if len(found) <= lines:
            break
    return found


def unexpected_lines(judgement: Judgement, width: int) -> list[str]:
    """Return what does not behave as declared, with its commands: the output of a command with --quiet."""
    return gate_lines(unexpected(summarise(judgement.verdicts)), judgement.specs, width, SHOWN)


def error_lines(judgement: Judgement) -> list[str]:
    """Return a sentence for each of the first gates in error, which explain the exit status 4, and one for the others.

    A gate is in error where a value or a bound is not finite, or where there are too few cases.
    """
    gates = summarise(judgement.verdicts)
    wrong = gates[gates["verdict"] == Verdict.ERROR]
    lines = [
        f"a gate is in error: {row.gate} of {row.candidate}: {row.reason}" for row in wrong.head(_ERRORS).itertuples()
    ]
    if len(wrong) > _ERRORS:
        lines.append(f"{len(wrong) - _ERRORS} more gates are in error")
    return lines


def card_summary(judgement: Judgement, width: int, most: int = SHOWN, full: bool = False) -> list[str]:
    """Return the lines of the report cards of the given models; where they are long, a sentence for the first ones."""
    names = given_models(judgement.models, judgement.verdicts)
    cards = [line for name in names for line in _card(judgement, name, width)]
    if full or len(cards) <= _CARD_LINES:
        return cards
    lines = [
        line for name in names[:most] for line in folded(f"{name}: {verdict_sentence(name, judgement.verdicts)}", width)
    ]
    hidden = len(names) - most
    more = f"{hidden} more given models; " if hidden > 0 else ""
    return [*lines, f"{more}--verbose prints the report cards"]


def _card(judgement: Judgement, name: str, width: int) -> list[str]:
    found = card_lines(name, judgement.verdicts, judgement.cards.get(name), judgement.domains.get(name))
    label_width = max(len(label) for label, _ in found)
    lines = [f"report card of {name}", *(f"  {label:{label_width}}  {text}" for label, text in found)]
    return [part for line in lines for part in hanging(line, width)]


def print_every_verdict(judgement: Judgement) -> None:
    """Print all gates, worst first, with their commands, the report cards, and the sentence on all gates."""
    width = output().width
    print_lines(["verdicts, worst first, each with the command that computes its worst case again"])
    print_lines(gate_lines(summarise(judgement.verdicts), judgement.specs, width))
    print_lines(card_summary(judgement, width, full=True))
    print_lines(summary_lines(judgement, width))


def print_lines(lines: Iterable[str]) -> None:
    """Print lines on stdout as they are."""
    console = output()
    for line in lines:
        console.print(line, markup=False, no_wrap=True, overflow="ignore")
