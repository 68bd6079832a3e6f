"""``fscm-bench judge``: judge the stored results of a run again, by its own gates or others."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path

import pandas as pd

from comparisons.cli.options import FAILED, FAILS, INCONCLUSIVE, OK, output
from comparisons.console.progress import log
from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.gates import Gate, gates_text, load_gates, of_tier
from comparisons.judging.judge import judge
from comparisons.judging.selection import load_user_gates
from comparisons.judging.summary import summarise
from comparisons.output.markdown import to_step_summary
from comparisons.output.tables import rich_table
from comparisons.output.verdicts import FILES, matrix, write_verdicts
from comparisons.runs.cases import Grid, cases_text, grids, grids_for
from comparisons.runs.environment import fingerprint
from comparisons.runs.record import check_files, read_record, warn_of_other_code, write_record
from comparisons.runs.tables import read_table

__all__ = ["GATES", "STATUS", "add", "call", "counted", "judge_and_write", "print_verdicts"]

#: What a run keeps the text of its gates in: the file it was given may change, or be gone.
GATES = "gates.toml"

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
    parser.add_argument("--gates", metavar="FILE", type=Path, help="judge by these gates, not by those of the run")
    parser.set_defaults(call=call)


def call(args: argparse.Namespace) -> int:
    """Read, judge, write and print; return the exit status."""
    to_step_summary("")
    record = read_record(args.folder / "run.json")
    check_files(record, args.folder, written_again=FILES)
    other_code = warn_of_other_code(record, args.folder)
    models, tier = record["arguments"]["model"], record["arguments"]["tier"]
    stored = args.folder / GATES
    path = args.gates or (stored if stored.exists() else None)
    text = gates_text(path)
    chosen = grids_for(grids(tier), models)
    # A run without --gates keeps the standing ones, most of which are about models that were not given to it.
    standing = path is None or (args.gates is None and record["arguments"]["gates"] is None)
    gates = (
        load_user_gates(text, path, tier, chosen, models) if path and not standing else of_tier(load_gates(text), tier)
    )
    rows, curves = (read_table(args.folder / name) for name in ("results.parquet", "curves.parquet"))
    if sha256(cases_text().encode()).hexdigest() != record["cases_sha256"]:
        log(f"the cases have changed since {args.folder} was computed; judged by those of today")
    digest = sha256(text.encode()).hexdigest()
    name = "the standing gates" if path is None else str(path)
    own = digest == record["gates_sha256"]
    log(f"judged by {name}, " + ("the gates of the run" if own else f"not by the gates {args.folder} was run with"))
    specs = record["arguments"]["outside"]
    judged = judge_and_write(args.folder, gates, chosen, rows, curves, models, specs)
    # The record agrees with the verdicts beside it, and says by which gates they are.
    record["verdicts"] = counted(judged)
    record.pop("judged_again", None)
    record.pop("judged_by_other_code", None)
    if other_code:
        record["judged_by_other_code"] = fingerprint()
    if not own:
        record["judged_again"] = {"gates": name, "gates_sha256": digest}
    write_record(record, args.folder / "run.json")
    print_verdicts(judged, specs)
    return STATUS[roll_up(judged["verdict"])]


def counted(judged: pd.DataFrame) -> dict[str, str | int]:
    """Return the verdict over all and how many cases have each, as ``run.json`` holds them."""
    return {"all": str(roll_up(judged["verdict"])), **Counter(map(str, judged["verdict"]))}


def judge_and_write(
    folder: Path,
    gates: list[Gate],
    chosen: list[Grid],
    rows: pd.DataFrame,
    curves: pd.DataFrame,
    models: list[str] | None,
    specs: Mapping[str, str],
) -> pd.DataFrame:
    """Judge and write the verdicts beside the results; return what `comparisons.judging.judge.judge` does."""
    judged = judge(gates, chosen, rows, curves, models)
    to_step_summary(write_verdicts(folder, judged, gates, specs))
    return judged


def print_verdicts(judged: pd.DataFrame, specs: Mapping[str, str]) -> None:
    """Print the matrix of gates, worst first, and the verdict over all.

    Parameters
    ----------
    judged : DataFrame
        As `comparisons.judging.judge.judge` returns it.
    specs : mapping of str to str
        The SPEC that finds each model from outside: the command that computes a case again needs it.
    """
    console = output()
    if judged.empty:
        log("no gate was evaluated")
        return
    shown = matrix(summarise(judged), specs)
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
