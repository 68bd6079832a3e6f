"""The command that computes a case again, and the files of verdicts."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import pandas as pd

from comparisons.data.file_names import GATES, JUNIT, SUMMARY, VERDICTS, VERDICTS_MARKDOWN
from comparisons.judging.card_gates import CARD
from comparisons.judging.gates import Gate
from comparisons.judging.summary import summarise
from comparisons.numerics.number_text import exact
from comparisons.output.junit import junit
from comparisons.output.latex import latex
from comparisons.output.markdown import markdown
from comparisons.output.table import CASE, Column, Record, Table, columns
from comparisons.problem import PARAMETERS
from comparisons.problem.problem import split_name
from comparisons.quantities import CURVES
from comparisons.runs.atomic_files import atomic
from comparisons.runs.frames import write_table
from comparisons.runs.rows import Key

__all__ = ["FORMATS", "GATE_COLUMNS", "command", "write_verdicts"]

#: What is stored of each gate beside its verdicts: what was required, in which unit, and on what grounds.
GATE_COLUMNS = ("id", "requirement", "metric", "basis", "grounds")

#: The worst case of each gate, as it is in LaTeX.
_WORST_CASES = columns(
    *("verdict", "gate", *CASE, "candidate", "candidate's value", "reference", "reference's value", "E(U)")
)

#: Suffix of a file of verdicts -> its text, made of the table of the gates and of that of their worst cases.
FORMATS: dict[str, Callable[[Table, Table], str]] = {
    "md": lambda gates, worst: markdown(gates.texts, gates.caption),
    "tex": lambda gates, worst: latex(worst.texts, worst.caption, worst.id),
}


def command(row: Record, specs: Mapping[str, str]) -> str:
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
    model = specs.get(row["candidate"], row["candidate"])
    varied: list[str] = []
    if row.get("problem"):
        file, *varied = split_name(row["problem"])
        case = ["--problem", file]
    else:
        case = [word for name in PARAMETERS if pd.notna(row[name]) for word in (f"--{name}", exact(row[name]))]
    if not case:
        of_card = str(row.get("gate", "")).startswith(CARD)
        return shlex.join(["fscm-bench", "check-model", model]) if of_card else "fscm-bench list gates"
    verb = "curve" if row["quantity"] in CURVES else "sweep" if varied else "solve"
    vary = [word for text in varied for word in ("--vary", text)] if verb == "sweep" else []
    return shlex.join(["fscm-bench", verb, "--model", model, "--quantity", row["quantity"], *case, *vary])


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
    summary = summarise(judged)
    required = [[str(getattr(gate, name)) for name in GATE_COLUMNS] for gate in gates]
    write_table(judged.assign(verdict=judged["verdict"].map(str)), folder / VERDICTS)
    write_table(summary.assign(verdict=summary["verdict"].map(str)), folder / SUMMARY)
    write_table(pd.DataFrame(required, columns=list(GATE_COLUMNS), dtype=str), folder / GATES)
    requirement = {gate.id: gate.requirement for gate in gates}
    layout = [
        *columns("verdict", "gate", "candidate", "reference", "coverage", "E(U)", "limits"),
        Column("command", partial(command, specs=specs)),
        *columns("reason"),
        Column("requirement", lambda row: requirement.get(row["gate"], "")),
    ]
    by_gate = Table("verdicts", "Verdicts", layout, summary)
    worst = Table("verdicts", "Verdicts of fscm-bench, worst first, each in its worst case", _WORST_CASES, summary)
    texts = {folder / f"{VERDICTS}.{suffix}": made(by_gate, worst) for suffix, made in FORMATS.items()}
    for path, text in texts.items():
        with atomic(path) as file:
            file.write(text.encode())
    with atomic(folder / JUNIT) as file:
        file.write(junit(judged, partial(command, specs=specs), seconds))
    return texts[folder / VERDICTS_MARKDOWN]
