"""Columns of tables of verdicts, the command that computes a case again, and the files of verdicts."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.judging.card_gates import CARD
from comparisons.judging.gates import Gate
from comparisons.judging.summary import summarise
from comparisons.numerics.number_text import exact
from comparisons.output.junit import junit
from comparisons.output.latex import latex
from comparisons.output.markdown import markdown
from comparisons.output.table import CASE_LABELS, COLUMNS, Cell, Column, chosen, table_of, texts_of
from comparisons.problem import PARAMETERS
from comparisons.problem.problem import split_name
from comparisons.quantities import CURVES
from comparisons.runs.atomic_files import atomic
from comparisons.runs.folder import RunFolder
from comparisons.runs.rows import Key
from comparisons.runs.tables import write_table

__all__ = ["GATE_COLUMNS", "WORST_CASES", "command", "write_verdicts"]

#: What is stored of each gate beside its verdicts: what was required, in which unit, and on what grounds.
GATE_COLUMNS = ("id", "requirement", "metric", "basis", "grounds")


def command(row: Mapping[str, Any], specs: Mapping[str, str]) -> str:
    """Return the command that computes the candidate's side of a verdict again.

    Parameters
    ----------
    row : mapping or Series
        A row of verdicts.
    specs : mapping of str to str
        The SPEC that finds each external model: its name alone does not.

    Examples
    --------
    >>> case = {"n": 2, "k": 0, "mu": 5, "nu": None}
    >>> command(pd.Series({"candidate": "jkr", "quantity": "pull_off_force", **case}), {})
    'fscm-bench solve --model jkr --quantity pull_off_force --n 2 --k 0 --mu 5'
    """
    if row.get("problem"):
        return _command_of_file(row, specs)
    case = " ".join(f"--{name} {exact(row[name])}" for name in PARAMETERS if pd.notna(row[name]))
    if not case and not str(row.get("gate", "")).startswith(CARD):
        return "fscm-bench list gates"
    model = shlex.quote(specs.get(row["candidate"], row["candidate"]))
    if not case:
        return f"fscm-bench check-model {model}"
    verb = "curve" if row["quantity"] in CURVES else "solve"
    return f"fscm-bench {verb} --model {model} --quantity {row['quantity']} {case}"


def _command_of_file(row: Mapping[str, Any], specs: Mapping[str, str]) -> str:
    file, *varied = split_name(row["problem"])
    model = shlex.quote(specs.get(row["candidate"], row["candidate"]))
    vary = "".join(f" --vary {shlex.quote(one)}" for one in varied)
    quoted = shlex.quote(file)
    if row["quantity"] in CURVES:
        return f"fscm-bench curve --model {model} --quantity {row['quantity']} --problem {quoted}"
    if not varied:
        return f"fscm-bench solve --model {model} --quantity {row['quantity']} --problem {quoted}"
    return f"fscm-bench sweep --problem {quoted}{vary} --model {model} --quantity {row['quantity']}"


#: The worst case of each gate, as it is in LaTeX.
WORST_CASES = chosen(
    *("verdict", "gate", *CASE_LABELS),
    *("candidate", "candidate's value", "reference", "reference's value", "E(U)"),
)


def write_verdicts(
    folder: Path,
    judged: pd.DataFrame,
    gates: list[Gate],
    specs: Mapping[str, str],
    seconds: Mapping[Key, float] | None = None,
) -> str:
    """Write the verdicts as CSV, Parquet, Markdown, LaTeX and JUnit XML (with `seconds`); return the Markdown.

    The summary by gate, and what the gates required, go beside them as CSV and Parquet: a gates file may change
    later.
    """
    files = RunFolder(folder)
    stored = judged.assign(verdict=judged["verdict"].map(str))
    write_table(stored, files.verdicts)
    required = [[str(getattr(gate, name)) for name in GATE_COLUMNS] for gate in gates]
    write_table(pd.DataFrame(required, columns=list(GATE_COLUMNS), dtype=str), files.gates)
    summary = summarise(judged)
    write_table(summary.assign(verdict=summary["verdict"].map(str)), files.summary)
    requirement = {gate.id: gate.requirement for gate in gates}
    columns = (
        *chosen("verdict", "gate", "candidate", "reference", "coverage", "worst E(U)", "limits"),
        Column("command", cell=lambda row: Cell(command(row, specs))),
        COLUMNS["reason"],
        Column("requirement", cell=lambda row: Cell(requirement.get(row["gate"], ""))),
    )
    page = markdown(texts_of(columns, summary), "Verdicts")
    worst = table_of("verdicts", "Verdicts of fscm-bench, worst first, each in its worst case", WORST_CASES, summary)
    texts = {files.verdicts_markdown: page, files.verdicts_latex: latex(worst.on_paper(), worst.caption, worst.id)}
    for path, text in texts.items():
        with atomic(path) as file:
            file.write(text.encode())
    with atomic(files.junit) as file:
        file.write(junit(judged, partial(command, specs=specs), seconds))
    return page
