"""The verdicts of a run as tables of texts, and their files beside the results."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from functools import partial
from pathlib import Path

import pandas as pd

from comparisons.judging.card_gates import CARD
from comparisons.judging.gates import Gate
from comparisons.judging.summary import COVERAGE, coverage_text, summarise
from comparisons.numerics.number_text import error_text, exact, limits_text, value_text
from comparisons.output.junit import junit
from comparisons.output.latex import latex
from comparisons.output.markdown import markdown
from comparisons.quantities import CURVES
from comparisons.runs.atomic_files import atomic
from comparisons.runs.case_columns import with_problem
from comparisons.runs.folder import RunFolder
from comparisons.runs.rows import PARAMETERS, Key, split_label
from comparisons.runs.tables import write_table

__all__ = [
    "GATE_COLUMNS",
    "command",
    "matrix",
    "worst_cases",
    "write_verdicts",
]

#: What is stored of each gate beside its verdicts: what was required, in which unit, and on what grounds.
GATE_COLUMNS = ("id", "requirement", "metric", "basis", "grounds")


def command(row: pd.Series, specs: Mapping[str, str]) -> str:
    """Return the command that computes the candidate's side of a verdict again.

    Parameters
    ----------
    row : Series
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


def _command_of_file(row: pd.Series, specs: Mapping[str, str]) -> str:
    file, *varied = split_label(row["problem"])
    model = shlex.quote(specs.get(row["candidate"], row["candidate"]))
    vary = "".join(f" --vary {shlex.quote(one)}" for one in varied)
    quoted = shlex.quote(file)
    if row["quantity"] in CURVES:
        return f"fscm-bench curve --model {model} --quantity {row['quantity']} --problem {quoted}"
    if not varied:
        return f"fscm-bench solve --model {model} --quantity {row['quantity']} --problem {quoted}"
    return f"fscm-bench sweep --problem {quoted}{vary} --model {model} --quantity {row['quantity']}"


def matrix(gates: pd.DataFrame, specs: Mapping[str, str]) -> pd.DataFrame:
    """Return one row of texts for each row of a summary (`comparisons.judging.summary.summarise`), in its order.

    Columns: verdict, gate, candidate, reference, coverage (in how many cases the candidate has a value, of how many in
    which it is evaluated), error of the worst case with its U in brackets, limits, the command that computes that case
    again, and the reason.
    """
    return pd.DataFrame(
        {
            "verdict": gates["verdict"].map(str),
            "gate": gates["gate"],
            "candidate": gates["candidate"],
            "reference": gates["reference"],
            "coverage": [coverage_text(row) for row in gates[list(COVERAGE)].to_dict("records")],
            "worst E(U)": _errors(gates),
            "limits": [limits_text(*limits) for limits in zip(gates["lower"], gates["upper"], strict=True)],
            "command": [command(row, specs) for _, row in gates.iterrows()],
            "reason": gates["reason"],
        },
        dtype=object,
    )


def _errors(gates: pd.DataFrame) -> list[str]:
    return [error_text(*pair) for pair in zip(gates["error"], gates["uncertainty"], strict=True)]


def worst_cases(gates: pd.DataFrame) -> pd.DataFrame:
    """Return the worst case of each gate of a summary as texts, the two values with their uncertainty."""
    rows = [row for _, row in gates.iterrows()]
    return pd.DataFrame(
        {
            "verdict": gates["verdict"].map(str),
            "gate": gates["gate"],
            **{name: ["" if pd.isna(row[name]) else exact(row[name]) for row in rows] for name in ("n", "k", "mu")},
            **({"problem": gates["problem"]} if with_problem(gates)["problem"].any() else {}),
            "candidate": gates["candidate"],
            "candidate's value": [value_text(row["value"], row["u_num"]) for row in rows],
            "reference": gates["reference"],
            "reference's value": [value_text(row["reference_value"], row["u_reference"]) for row in rows],
            "E(U)": _errors(gates),
        },
        dtype=object,
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
    shown = matrix(summary, specs)
    requirement = {gate.id: gate.requirement for gate in gates}
    page = markdown(shown.assign(requirement=[requirement.get(id, "") for id in shown["gate"]]), "Verdicts")
    texts = {
        files.verdicts_markdown: page,
        files.verdicts_latex: latex(
            worst_cases(summary), "Verdicts of fscm-bench, worst first, each in its worst case", "verdicts"
        ),
    }
    for path, text in texts.items():
        with atomic(path) as file:
            file.write(text.encode())
    with atomic(files.junit) as file:
        file.write(junit(judged, partial(command, specs=specs), seconds))
    return page
