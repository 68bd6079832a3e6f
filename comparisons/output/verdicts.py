"""The verdicts of a run for people: the matrix of gates, worst first, and the files beside the results."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from functools import partial
from pathlib import Path

import pandas as pd

from comparisons.curve_quantities import SHAPES
from comparisons.judging.gates import Gate
from comparisons.judging.summary import summarise
from comparisons.numerics.number_text import exact, limits_text, short
from comparisons.output.junit import junit
from comparisons.output.latex import latex
from comparisons.output.markdown import markdown
from comparisons.runs.atomic_files import atomic
from comparisons.runs.folder import RunFolder
from comparisons.runs.tables import write_table

__all__ = [
    "GATE_COLUMNS",
    "command",
    "error_text",
    "matrix",
    "parameter_text",
    "value_text",
    "worst_cases",
    "write_verdicts",
]

#: Uncertainties below this are shown as this: nobody reads sixteen digits.
_LEAST_SHOWN = 5e-10

#: What is stored of each gate beside its verdicts: what was required, in which unit, and on what grounds.
GATE_COLUMNS = ("id", "requirement", "metric", "basis", "grounds")


def command(row: pd.Series, specs: Mapping[str, str]) -> str:
    """Return the command that computes the candidate's side of a verdict again.

    Parameters
    ----------
    row : Series
        A row of verdicts.
    specs : mapping of str to str
        The SPEC that finds each model from outside: its name alone does not.

    Examples
    --------
    >>> case = {"n": 2, "k": 0, "mu": 5, "nu": None}
    >>> command(pd.Series({"candidate": "jkr", "quantity": "pull_off_force", **case}), {})
    'fscm-bench solve --model jkr --quantity pull_off_force --n 2 --k 0 --mu 5'
    """
    case = " ".join(f"--{name} {parameter_text(row[name])}" for name in ("n", "k", "mu", "nu") if pd.notna(row[name]))
    if not case:
        return "fscm-bench list gates"
    model = shlex.quote(specs.get(row["candidate"], row["candidate"]))
    asking = "curve" if row["quantity"] in SHAPES else "solve"
    return f"fscm-bench {asking} --model {model} --quantity {row['quantity']} {case}"


def parameter_text(value: float) -> str:
    """Return a parameter of a case, as short as it can be exactly: 0.4, and 2 rather than 2.0."""
    return exact(value)


def matrix(judged: pd.DataFrame, specs: Mapping[str, str]) -> pd.DataFrame:
    """Return one row of texts a gate and candidate, worst first.

    Columns: verdict, gate, candidate, reference, cases (how many, and of them those that did not apply),
    error of the worst case with its U in brackets, limits, the command that computes that case again, and the
    reason.
    """
    gates = summarise(judged)
    return pd.DataFrame(
        {
            "verdict": gates["verdict"].map(str),
            "gate": gates["gate"],
            "candidate": gates["candidate"],
            "reference": gates["reference"],
            "cases": [
                f"{a}" + (f" ({b} n/a)" if b else "") for a, b in zip(gates["cases"], gates["skipped"], strict=True)
            ],
            "worst E(U)": [error_text(row) for _, row in gates.iterrows()],
            "limits": [limits_text(*limits) for limits in zip(gates["lower"], gates["upper"], strict=True)],
            "command": [command(row, specs) for _, row in gates.iterrows()],
            "reason": gates["reason"],
        },
        dtype=object,
    )


def error_text(row: pd.Series) -> str:
    """Return E of a row of verdicts with its U in brackets; empty where it has none."""
    if pd.isna(row["error"]):
        return ""
    # An error far below one is read as a power of ten, with as many digits as U leaves it.
    error, u = float(row["error"]), float(row["uncertainty"])
    if 0.0 < max(abs(error), u) < 1e-3:
        return f"{error:.1e}({u:.0e})"
    return short(error, u) if u > 1e-5 else f"{error:.5f}"


def worst_cases(judged: pd.DataFrame) -> pd.DataFrame:
    """Return the worst case of each gate as texts, the two values with their uncertainty."""
    gates = summarise(judged)
    rows = [row for _, row in gates.iterrows()]
    return pd.DataFrame(
        {
            "verdict": gates["verdict"].map(str),
            "gate": gates["gate"],
            **{
                name: ["" if pd.isna(row[name]) else parameter_text(row[name]) for row in rows]
                for name in ("n", "k", "mu")
            },
            "candidate": [f"{row['candidate']} {value_text(row['value'], row['u_num'])}" for row in rows],
            "reference": [
                f"{row['reference']} {value_text(row['reference_value'], row['u_reference'])}" for row in rows
            ],
            "E": [error_text(row) for row in rows],
        },
        dtype=object,
    )


def value_text(value: float | None, u: float | None) -> str:
    """Return a value with its uncertainty in brackets; empty where there is none."""
    return "" if value is None or pd.isna(value) else short(value, max(float(u or 0.0), _LEAST_SHOWN))


def write_verdicts(folder: Path, judged: pd.DataFrame, gates: list[Gate], specs: Mapping[str, str]) -> str:
    """Write the verdicts as CSV, Parquet, Markdown, LaTeX and JUnit XML; return the Markdown.

    What the gates required goes beside them, as CSV and Parquet: a gates file may change later.
    """
    files = RunFolder(folder)
    stored = judged.assign(verdict=judged["verdict"].map(str))
    write_table(stored, files.verdicts)
    summary = summarise(judged)
    write_table(summary.assign(verdict=summary["verdict"].map(str)), files.summary)
    required = [[str(getattr(gate, name)) for name in GATE_COLUMNS] for gate in gates]
    write_table(pd.DataFrame(required, columns=list(GATE_COLUMNS), dtype=str), files.gates)
    shown = matrix(judged, specs)
    requirement = {gate.id: gate.requirement for gate in gates}
    page = markdown(shown.assign(requirement=[requirement.get(id, "") for id in shown["gate"]]), "Verdicts")
    texts = {
        files.verdicts_markdown: page,
        files.verdicts_latex: latex(worst_cases(judged), "Verdicts of fscm-bench, worst first, each in its worst case"),
    }
    for path, text in texts.items():
        with atomic(path) as file:
            file.write(text.encode())
    with atomic(files.junit) as file:
        file.write(junit(judged, partial(command, specs=specs)))
    return page
