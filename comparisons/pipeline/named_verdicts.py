"""The verdicts of a run by the names of gate, model and case, for the plugin of pytest."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
from filelock import FileLock
from threadpoolctl import threadpool_limits

from comparisons.numerics.number_text import exact
from comparisons.output.junit import numbers_text
from comparisons.output.verdicts import command
from comparisons.pipeline.run import run
from comparisons.problem import PARAMETERS
from comparisons.runs.atomic_files import prepare_folder

_LOCK = ".pytest.lock"


def named_verdicts(
    cases: str | Path, gates: Path, models: Sequence[str], folder: Path, jobs: int = 1
) -> list[tuple[str, str, str]]:
    """Run and judge; return name and verdict of each row, and its reason, its numbers and the command that repeats it.

    Several processes may call it with one folder: the first computes, the others take its results.

    Raises
    ------
    ValueError, comparisons.model.ComputationFailed
        As `comparisons.pipeline.run.run`.
    """
    prepare_folder(folder)
    with FileLock(folder / _LOCK), threadpool_limits(1):
        judgement = run(cases, gates, list(models), folder, jobs=jobs).judgement
    assert judgement is not None
    if judgement.verdicts.empty:
        raise ValueError(f"{gates}: no gate was evaluated: no candidate of a gate is given")
    return [
        (_name(row), str(row["verdict"]), _text(row, judgement.inputs.specs))
        for _, row in judgement.verdicts.iterrows()
    ]


def _name(row: pd.Series) -> str:
    numbers = (f"{name}={exact(row[name])}" for name in PARAMETERS if pd.notna(row[name]))
    problem = row.get("problem")
    case = problem if isinstance(problem, str) and problem else " ".join(numbers)
    return f"{row['gate']}[{' '.join(filter(None, [row['candidate'], case]))}]"


def _text(row: pd.Series, specs: dict[str, str]) -> str:
    has_error = pd.notna(row["error"])
    lines = [row["reason"], numbers_text(row) if has_error else "", f"computed again by: {command(row, specs)}"]
    return "\n".join(filter(None, lines))
