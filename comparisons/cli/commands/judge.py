"""``fscm-bench judge``: a new judgement of the stored results of a run, by its own gates or others."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.table import Table
from rich.text import Text

from comparisons.cli.options import FAILED, FAILS, INCONCLUSIVE, OK, output
from comparisons.console.progress import log
from comparisons.judging.decision import Verdict
from comparisons.judging.report_card import card_lines, given_models
from comparisons.judging.summary import summarise
from comparisons.output.markdown import to_step_summary
from comparisons.output.tables import rich_table
from comparisons.output.verdicts import matrix
from comparisons.pipeline.judgement import Judgement, judge_folder

__all__ = ["STATUS", "add", "call", "print_verdicts"]

#: Verdict over all gates -> exit status.
STATUS = {
    Verdict.ERROR: FAILED,
    Verdict.FAIL: FAILS,
    Verdict.XPASS: FAILS,
    Verdict.INCONCLUSIVE: INCONCLUSIVE,
    Verdict.XFAIL: OK,
    Verdict.PASS: OK,
}

#: On a console with fewer columns the table of verdicts is without what the gates and the command line have.
_WIDE = 110


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("folder", metavar="DIR", type=Path, help="folder of a finished run")
    parser.add_argument("--gates", metavar="FILE", type=Path, help="judge by these gates, not by those of the run")


def call(args: argparse.Namespace) -> int:
    """Judge and print; return the exit status."""
    to_step_summary("")
    judgement = judge_folder(args.folder, args.gates)
    print_verdicts(judgement)
    to_step_summary(judgement.markdown)
    return STATUS[judgement.verdict]


def print_verdicts(judgement: Judgement) -> None:
    """Print the matrix of gates, worst first, and the verdict over all."""
    console = output()
    if judgement.verdicts.empty:
        log("no gate was evaluated")
        return
    shown = matrix(summarise(judgement.verdicts), judgement.specs)
    hidden = ["command", "reason"]
    if console.width < _WIDE:
        hidden += ["reference", "limits"] + ["candidate"] * (shown["candidate"].nunique() == 1)
    table = rich_table(shown.drop(columns=hidden), "verdicts, worst first")
    for column in table.columns:
        column.overflow = "fold"
    console.print(table)
    width = shown["gate"].str.len().max()
    console.print("the worst case of each gate is computed again by", style="bold")
    for gate, line, reason in zip(shown["gate"], shown["command"], shown["reason"], strict=True):
        console.print(f"{gate:{width}}  {line}" + (f"  # {reason}" if reason else ""), markup=False, soft_wrap=True)
    _print_cards(judgement)
    counts = judgement.verdicts["verdict"].map(str).value_counts()
    console.print(
        f"{judgement.verdict}: {len(shown)} gates, "
        + ", ".join(f"{count} cases {name}" for name, count in counts.items()),
        style="bold",
    )
    for record in shown[shown["verdict"] == Verdict.ERROR].itertuples():
        log(f"a gate is in error: {record.gate} of {record.candidate}: {record.reason}")


def _print_cards(judgement: Judgement) -> None:
    """Print the report card of each given model."""
    console = output()
    for name in given_models(judgement.models, judgement.verdicts):
        lines = card_lines(name, judgement.verdicts, judgement.cards.get(name), judgement.domains.get(name))
        grid = Table.grid(padding=(0, 2))
        grid.add_column(no_wrap=True)
        grid.add_column(overflow="fold")
        for label, text in lines:
            grid.add_row(Text(f"  {label}"), Text(text))
        console.print(f"report card of {name}", style="bold", markup=False)
        console.print(grid)
