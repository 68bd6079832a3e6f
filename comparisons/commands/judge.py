"""``fscm-bench judge``: judge the stored results of a run again, by the same gates or others."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path

import pandas as pd

from comparisons.cases import Grid, asked_of, cases_text, grids
from comparisons.commands.options import FAILED, FAILS, INCONCLUSIVE, OK, output
from comparisons.gates import Gate, gates_text, load_gates, of_tier
from comparisons.judge import judge, left_out
from comparisons.outputs.markdown import to_step_summary
from comparisons.outputs.verdicts import matrix, write_verdicts
from comparisons.progress import log
from comparisons.record import read_record
from comparisons.store import read_table
from comparisons.tables import rich_table
from comparisons.verdict import Verdict, roll_up

__all__ = ["STATUS", "add", "call", "judge_and_write", "own_gates", "print_verdicts"]

#: Verdict over all gates -> exit status.
STATUS = {
    Verdict.ERROR: FAILED,
    Verdict.FAIL: FAILS,
    Verdict.XPASS: FAILS,
    Verdict.INCONCLUSIVE: INCONCLUSIVE,
    Verdict.XFAIL: OK,
    Verdict.PASS: OK,
}


def add(parsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the arguments."""
    parser = parsers.add_parser("judge", help="judge stored results again without computing", description=__doc__)
    parser.add_argument("folder", metavar="DIR", type=Path, help="folder of a finished run")
    parser.add_argument("--gates", metavar="FILE", type=Path, help="judge by these gates, not the standing ones")
    parser.set_defaults(call=call)


def call(args: argparse.Namespace) -> int:
    """Read, judge, write and print; return the exit status."""
    record = read_record(args.folder / "run.json")
    models, tier = record["arguments"]["model"], record["arguments"]["tier"]
    text = gates_text(args.gates)
    chosen = asked_of(grids(tier), models)
    gates = of_tier(load_gates(text), tier) if args.gates is None else own_gates(text, args.gates, tier, chosen, models)
    rows, curves = (read_table(args.folder / name) for name in ("results.parquet", "curves.parquet"))
    for name, content in {"cases": cases_text(), "gates": text}.items():
        if sha256(content.encode()).hexdigest() != record[f"{name}_sha256"]:
            log(f"the {name} have changed since {args.folder} was computed; judged by those of today")
    specs = record["arguments"]["outside"]
    judged = judge_and_write(args.folder, gates, chosen, rows, curves, models, specs)
    print_verdicts(judged, specs)
    return STATUS[roll_up(judged["verdict"])]


def own_gates(text: str, path: Path, tier: str, chosen: Sequence[Grid], models: Sequence[str] | None) -> list[Gate]:
    """Return the gates of a file of somebody's own that a run can judge, and say how many it leaves out.

    Parameters
    ----------
    text, path
        Of the file.
    tier : str
        Of the run.
    chosen : sequence of Grid
        What the run computes.
    models : sequence of str or None
        Models given in place of those each grid names.

    Raises
    ------
    ValueError
        If a gate is wrong or needs a model that is not computed; one sentence says which.
    """
    every = load_gates(text, models or ())
    gates = of_tier(every, tier)
    others = left_out(gates, chosen, models)
    if others:
        log(f"{len(others)} of {len(every)} gates of {path} are left out: their candidate is not given to this run")
    if len(gates) < len(every):
        log(f"{len(every) - len(gates)} of {len(every)} gates of {path} are left out: they are of the tier full")
    return gates


def judge_and_write(
    folder: Path,
    gates: list[Gate],
    chosen: list[Grid],
    rows: pd.DataFrame,
    curves: pd.DataFrame,
    models: list[str] | None,
    specs: Mapping[str, str],
) -> pd.DataFrame:
    """Judge and write the verdicts beside the results; return what `comparisons.judge.judge` does."""
    judged = judge(gates, chosen, rows, curves, models)
    to_step_summary(write_verdicts(folder, judged, gates, specs))
    return judged


def print_verdicts(judged: pd.DataFrame, specs: Mapping[str, str]) -> None:
    """Print the matrix of gates, worst first, and the verdict over all.

    Parameters
    ----------
    judged : DataFrame
        As `comparisons.judge.judge` returns it.
    specs : mapping of str to str
        The SPEC that finds each model from outside: the command that computes a case again needs it.
    """
    console = output()
    if judged.empty:
        log("no gate was evaluated")
        return
    shown = matrix(judged, specs)
    console.print(rich_table(shown.drop(columns=["command", "reason"]), "verdicts, worst first"))
    width = shown["gate"].str.len().max()
    console.print("the worst case of each gate is computed again by", style="bold")
    for gate, line, reason in zip(shown["gate"], shown["command"], shown["reason"], strict=True):
        console.print(f"{gate:{width}}  {line}" + (f"  # {reason}" if reason else ""), markup=False, soft_wrap=True)
    counts = judged["verdict"].map(str).value_counts()
    console.print(
        f"{roll_up(judged['verdict'])}: {len(shown)} gates, "
        + ", ".join(f"{count} cases {name}" for name, count in counts.items()),
        style="bold",
    )
    for record in shown[shown["verdict"] == Verdict.ERROR].itertuples():
        log(f"a gate is in error: {record.gate} of {record.candidate}: {record.reason}")
